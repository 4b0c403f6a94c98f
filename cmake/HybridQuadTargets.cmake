# Settings that every target of ours shares; those of other projects stay as they are.
function(hq_configure_target target)
  # Same input, same bits: no fused multiply-add that one compiler uses and another does not.
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -ffp-contract=off)
  if(HQ_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(HQ_SANITIZE)
    # Null and misaligned pointers are AddressSanitizer's to find; checks of every reference cost a third of the time to compile.
    target_compile_options(${target} PRIVATE -fsanitize=address,undefined -fno-sanitize=null,alignment -fno-sanitize-recover=all
                           -fno-omit-frame-pointer -O1 -g)
    target_link_options(${target} PRIVATE -fsanitize=address,undefined)
  endif()
  if(HQ_SANITIZE_THREADS)
    target_compile_options(${target} PRIVATE -fsanitize=thread -fno-omit-frame-pointer -O1 -g)
    target_link_options(${target} PRIVATE -fsanitize=thread)
  endif()
  if(HQ_BUILD_FUZZERS)
    target_compile_options(${target} PRIVATE -fsanitize=fuzzer-no-link)
  endif()
endfunction()
