# Builds examples/cmake-consumer against a Glint that is not installed: against the folder in which it was
# built or, with GLINT_SOURCE, with its sources as a subdirectory. In the latter only the runtime is built,
# and the tool is EXECUTABLE, as in a build for another machine.
# Arguments: -DGLINT_BUILD=… -DWORK=… -DEXAMPLE=… -DGENERATOR=… [-DGLINT_SOURCE=… -DEXECUTABLE=…] [-DFLAGS=…]
# [-DLAUNCHER=…]
cmake_minimum_required(VERSION 3.25)
include("${CMAKE_CURRENT_LIST_DIR}/run.cmake")

set(build "${WORK}/build")
file(REMOVE_RECURSE "${WORK}")
file(COPY "${EXAMPLE}/" DESTINATION "${WORK}/source/example")
if(GLINT_SOURCE)
  file(WRITE "${WORK}/source/CMakeLists.txt"
       "cmake_minimum_required(VERSION 3.25)\nproject(game LANGUAGES CXX)\n"
       "add_subdirectory(\"${GLINT_SOURCE}\" glint)\nadd_subdirectory(example)\n")
  set(source "${WORK}/source")
  set(glint -DGLINT_BUILD_COMPILER=OFF -DGLINT_UNITY=ON "-DGLINT_EXECUTABLE=${EXECUTABLE}")
  set(program "${build}/example/cubes")
else()
  set(source "${WORK}/source/example")
  set(glint "-DGlint_DIR=${GLINT_BUILD}")
  set(program "${build}/cubes")
endif()

run(${CMAKE_COMMAND} -S "${source}" -B "${build}" -G "${GENERATOR}" ${glint} "-DCMAKE_CXX_FLAGS=${FLAGS}"
    "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}")
# By day the runtime is not compiled once more: its targets are looked up, and the other test runs the program.
if(GLINT_SOURCE AND NOT DEFINED ENV{GLINT_NIGHTLY})
  run(${CMAKE_COMMAND} --build "${build}" --target help)
  foreach(target cubes libglint_runtime.a libglint_package.a)
    if(NOT output MATCHES "${target}")
      message(FATAL_ERROR "no target ${target}\n${output}")
    endif()
  endforeach()
  return()
endif()
run(${CMAKE_COMMAND} --build "${build}")
if(NOT output MATCHES "Compiling the materials of cubes")
  message(FATAL_ERROR "the materials were not compiled\n${output}")
endif()
run("${program}")
if(NOT output MATCHES "4 shaders, 5 buckets")
  message(FATAL_ERROR "the program says\n${output}")
endif()
run(${CMAKE_COMMAND} --build "${build}")
if(output MATCHES "Building|Linking|Compiling")
  message(FATAL_ERROR "the second build does something\n${output}")
endif()
