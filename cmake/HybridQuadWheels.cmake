# The same bindings for several Pythons at once, over the one core library: what scripts/build_wheels builds.
#
# HQ_WHEEL_HEADERS lists folders with the headers of a CPython, each named like its version, for example
# ".../3.10;.../3.13". The target wheel_modules builds <build>/wheel_modules/_native.cpython-310-<platform>.so and so on.
# Modules leave Python's functions open, so that no interpreter is needed here, only headers.

set(HQ_WHEEL_HEADERS "" CACHE STRING "Folders with the headers of the Pythons to make wheels for, each named like its version")
set(HQ_WHEEL_MULTIARCH "x86_64-linux-gnu" CACHE STRING "How CPython names this platform in the names of modules")

function(hq_add_wheel_modules bindings)
  if(NOT HQ_WHEEL_HEADERS)
    return()
  endif()
  get_target_property(sources ${bindings} SOURCES)
  add_custom_target(wheel_modules)
  foreach(headers IN LISTS HQ_WHEEL_HEADERS)
    get_filename_component(version ${headers} NAME)
    if(NOT EXISTS ${headers}/Python.h)
      message(FATAL_ERROR "no Python.h in ${headers}")
    endif()
    string(REPLACE "." "" digits ${version})
    set(target wheel_module_${digits})
    add_library(${target} MODULE EXCLUDE_FROM_ALL ${sources})
    target_include_directories(${target} SYSTEM PRIVATE ${headers})
    target_link_libraries(${target} PRIVATE hybrid_quad_core pybind11::headers)
    target_link_options(${target} PRIVATE -Wl,-s)
    set_target_properties(${target} PROPERTIES
      PREFIX ""
      OUTPUT_NAME _native
      SUFFIX .cpython-${digits}-${HQ_WHEEL_MULTIARCH}.so
      LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/wheel_modules)
    hq_configure_target(${target})
    add_dependencies(wheel_modules ${target})
  endforeach()
endfunction()
