# Builds and runs the program that a page prints, against the build folder. What it prints must match EXPECTED.
# Arguments: -DGLINT_BUILD=… -DWORK=… -DPAGE=… -DPROGRAM=… -DEXPECTED=… -DGENERATOR=… [-DSCENE=…] [-DFLAGS=…] [-DLAUNCHER=…]
cmake_minimum_required(VERSION 3.25)
include("${CMAKE_CURRENT_LIST_DIR}/run.cmake")

file(REMOVE_RECURSE "${WORK}")
file(READ "${PAGE}" page)

# Writes the first block of a language to a file.
function(write_block language target)
  set(begin "```${language}\n")
  string(FIND "${page}" "${begin}" place)
  string(LENGTH "${begin}" length)
  math(EXPR place "${place} + ${length}")
  string(SUBSTRING "${page}" ${place} -1 rest)
  string(FIND "${rest}" "\n```" end)
  string(SUBSTRING "${rest}" 0 ${end} text)
  file(WRITE "${WORK}/${target}" "${text}\n")
endfunction()
write_block(cmake CMakeLists.txt)
write_block(cpp main.cpp)
if(SCENE)
  file(COPY_FILE "${SCENE}" "${WORK}/room.gltf")
endif()

run(${CMAKE_COMMAND} -S "${WORK}" -B "${WORK}/build" -G "${GENERATOR}" "-DGlint_DIR=${GLINT_BUILD}"
    "-DCMAKE_CXX_FLAGS=${FLAGS}" "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}")
run(${CMAKE_COMMAND} --build "${WORK}/build")
run(${CMAKE_COMMAND} -E chdir "${WORK}" "${WORK}/build/${PROGRAM}")
if(NOT output MATCHES "${EXPECTED}")
  message(FATAL_ERROR "the program says\n${output}")
endif()
message("${output}")
file(STRINGS "${WORK}/main.cpp" lines)
list(LENGTH lines count)
if(count GREATER 150)
  message(FATAL_ERROR "the program has ${count} lines")
endif()
