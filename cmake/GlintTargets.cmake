# What every target of the project has in common.

set(glint_compile_options -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion)
set(glint_link_options "")
if(GLINT_WARNINGS_AS_ERRORS)
  list(APPEND glint_compile_options -Werror)
endif()
if(GLINT_SANITIZE)
  list(APPEND glint_compile_options -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  list(APPEND glint_link_options -fsanitize=address,undefined)
endif()
if(GLINT_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    message(FATAL_ERROR "GLINT_FUZZ needs Clang: cmake --preset fuzz")
  endif()
  # Coverage counters in everything that targets run; the targets themselves bring libFuzzer.
  list(APPEND glint_compile_options -fsanitize=fuzzer-no-link)
  list(APPEND glint_link_options -fsanitize=fuzzer-no-link)
endif()

# glint_configure(TARGET): the project's warnings and sanitizers, for its own sources only.
function(glint_configure target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_compile_options(${target} PRIVATE ${glint_compile_options})
  target_link_options(${target} PRIVATE ${glint_link_options})
endfunction()
