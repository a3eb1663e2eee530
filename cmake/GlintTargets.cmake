# What every target of the project has in common.

add_library(glint_options INTERFACE)
target_compile_options(glint_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion)
if(GLINT_WARNINGS_AS_ERRORS)
  target_compile_options(glint_options INTERFACE -Werror)
endif()
if(GLINT_SANITIZE)
  target_compile_options(glint_options INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=all
                                                -fno-omit-frame-pointer)
  target_link_options(glint_options INTERFACE -fsanitize=address,undefined)
endif()
if(GLINT_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    message(FATAL_ERROR "GLINT_FUZZ needs Clang: cmake --preset fuzz")
  endif()
  # Coverage counters in everything that targets run; the targets themselves bring libFuzzer.
  target_compile_options(glint_options INTERFACE -fsanitize=fuzzer-no-link)
  target_link_options(glint_options INTERFACE -fsanitize=fuzzer-no-link)
endif()

# glint_configure(TARGET): the project's warnings and sanitizers, for its own sources only.
function(glint_configure target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:glint_options>)
endfunction()
