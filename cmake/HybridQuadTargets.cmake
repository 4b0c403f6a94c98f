# Settings that every target of ours shares; those of other projects stay as they are.
function(hq_configure_target target)
  # Same input, same bits: no fused multiply-add that one compiler uses and another does not.
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow -ffp-contract=off)
  if(HQ_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(HQ_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer -O1 -g)
    target_link_options(${target} PRIVATE -fsanitize=address,undefined)
  endif()
endfunction()
