# The settings that all targets of the project share.

set(glint_compile_options -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion)
set(glint_link_options "")
if(GLINT_WARNINGS_AS_ERRORS)
  list(APPEND glint_compile_options -Werror)
endif()
if(GLINT_SANITIZE)
  list(APPEND glint_compile_options -fsanitize=${GLINT_SANITIZERS} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  list(APPEND glint_link_options -fsanitize=${GLINT_SANITIZERS})
endif()
if(GLINT_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    message(FATAL_ERROR "GLINT_FUZZ needs Clang: cmake --preset fuzz")
  endif()
  # All code that the fuzz targets run gets coverage counters. The targets themselves link libFuzzer.
  list(APPEND glint_compile_options -fsanitize=fuzzer-no-link)
  list(APPEND glint_link_options -fsanitize=fuzzer-no-link)
endif()

# Few cores get large units, because each reads the headers again; many cores get many units.
cmake_host_system_information(RESULT glint_cores QUERY NUMBER_OF_LOGICAL_CORES)
set(glint_unity_batch 8)
if(glint_cores LESS_EQUAL 4)
  set(glint_unity_batch 24)
endif()
set(GLINT_UNITY_BATCH ${glint_unity_batch} CACHE STRING "Most sources that GLINT_UNITY compiles at a time")

# glint_compiled_alone(TARGET FILE…): sources that can't share a translation unit with others, as they define the
# implementation of a library or include text with names of its own.
function(glint_compiled_alone target)
  set_source_files_properties(${ARGN} TARGET_DIRECTORY ${target} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# glint_configure(TARGET): sets the project's warnings and sanitizers for its own sources only.
function(glint_configure target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_compile_options(${target} PRIVATE ${glint_compile_options})
  target_link_options(${target} PRIVATE ${glint_link_options})
  get_target_property(type ${target} TYPE)
  # Headers of the standard library, JSON and CLI11 take longer to read than most sources take to compile.
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${GLINT_UNITY} UNITY_BUILD_BATCH_SIZE ${GLINT_UNITY_BATCH})
  if(GLINT_PRECOMPILE AND type STREQUAL "STATIC_LIBRARY")
    target_precompile_headers(${target} PRIVATE "${PROJECT_SOURCE_DIR}/cmake/precompiled.h")
  endif()
endfunction()
