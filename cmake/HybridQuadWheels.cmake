# The same bindings for several Pythons at once, over the one core library: what scripts/build_wheels builds.
#
# HQ_WHEEL_HEADERS lists folders with the headers of a CPython, each named like its version, for example
# ".../3.10;.../3.13". The target wheel_modules builds <build>/wheel_modules/_native.cpython-310-<platform>.so and so on.
# Modules leave Python's functions open, so that no interpreter is needed here, only headers; on Windows, where that can't be,
# libs/python310.lib beside the headers says which library has them.

set(HQ_WHEEL_HEADERS "" CACHE STRING "Folders with the headers of the Pythons to make wheels for, each named like its version")

# How CPython names modules of a Python, given without its dot ("310"), on the target's system.
function(hq_wheel_suffix digits result)
  if(WIN32)
    set(${result} .cp${digits}-win_amd64.pyd PARENT_SCOPE)
  elseif(APPLE)
    set(${result} .cpython-${digits}-darwin.so PARENT_SCOPE)
  else()
    set(${result} .cpython-${digits}-x86_64-linux-gnu.so PARENT_SCOPE)
  endif()
endfunction()

function(hq_add_wheel_modules)
  set(kind MODULE)
  if(APPLE)
    set(kind SHARED)  # Zig's linker makes no bundles; Python loads both
  endif()
  list(TRANSFORM ARGN PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/ OUTPUT_VARIABLE sources)
  add_custom_target(wheel_modules)
  foreach(headers IN LISTS HQ_WHEEL_HEADERS)
    get_filename_component(version ${headers} NAME)
    if(NOT EXISTS ${headers}/Python.h)
      message(FATAL_ERROR "no Python.h in ${headers}")
    endif()
    string(REPLACE "." "" digits ${version})
    hq_wheel_suffix(${digits} suffix)
    set(target wheel_module_${digits})
    add_library(${target} ${kind} EXCLUDE_FROM_ALL ${sources})
    target_include_directories(${target} SYSTEM PRIVATE ${headers})
    target_link_libraries(${target} PRIVATE hybrid_quad_core pybind11::headers)
    if(WIN32)
      target_link_libraries(${target} PRIVATE ${headers}/libs/python${digits}.lib)
    elseif(APPLE)
      target_link_options(${target} PRIVATE -Wl,-undefined,dynamic_lookup)
    endif()
    target_link_options(${target} PRIVATE -s)
    set_target_properties(${target} PROPERTIES
      PREFIX ""
      OUTPUT_NAME _native
      SUFFIX ${suffix}
      LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/wheel_modules)
    hq_configure_target(${target})
    add_dependencies(wheel_modules ${target})
  endforeach()
endfunction()
