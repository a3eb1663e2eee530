# Installs into an empty prefix, and builds programs against the installed files.
# Arguments: -DGLINT_BUILD=… -DWORK=… -DCONSUMER=… -DSCENES=… -DGENERATOR=… [-DFLAGS=…] [-DLAUNCHER=…]
cmake_minimum_required(VERSION 3.25)
include("${CMAKE_CURRENT_LIST_DIR}/run.cmake")

# expect_output(TEXT): the last program must have printed it.
macro(expect_output text)
  string(FIND "${output}" "${text}" found)
  if(found EQUAL -1)
    message(FATAL_ERROR "not \"${text}\" but\n${output}")
  endif()
endmacro()

set(prefix "${WORK}/prefix")
set(build "${WORK}/build")
file(REMOVE_RECURSE "${WORK}")
file(COPY "${SCENES}/" DESTINATION "${WORK}/scenes")
file(COPY_FILE "${WORK}/scenes/cubes.gltf" "${WORK}/scenes/copy.gltf")

run(${CMAKE_COMMAND} --install "${GLINT_BUILD}" --prefix "${prefix}")
run("${prefix}/bin/glint" --version)
run(${CMAKE_COMMAND} -S "${CONSUMER}" -B "${build}" -G "${GENERATOR}" "-DCMAKE_PREFIX_PATH=${prefix}"
    "-DCMAKE_CXX_FLAGS=${FLAGS}" "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}" "-DSCENES=${WORK}/scenes")
run(${CMAKE_COMMAND} --build "${build}")
run("${build}/uses_runtime" "${WORK}/no-such-package")
run("${build}/uses_compiler")
run("${build}/uses_gltf" "${WORK}/scenes/cubes.gltf")
expect_output("4 meshes, 4 materials")
run("${build}/uses_scene_view" "${WORK}/scenes/cubes.gltf")
expect_output("4 instances, 48 triangles, 1 images")
run("${build}/uses_measure")
expect_output(" settings, ")
run("${build}/tables/uses_tables")

# The first build made the lock, so the second has no reason to run the tool.
if(NOT EXISTS "${build}/cubes.lock")
  message(FATAL_ERROR "there is no lock")
endif()
run(${CMAKE_COMMAND} --build "${build}")
if(output MATCHES "Compiling the materials")
  message(FATAL_ERROR "the second build compiles materials\n${output}")
endif()

# A lock that is removed or changed counts as a changed input.
file(REMOVE "${build}/cubes.lock")
run(${CMAKE_COMMAND} --build "${build}")
if(NOT EXISTS "${build}/cubes.lock" OR output MATCHES "materials of both")
  message(FATAL_ERROR "the lock was not made again, or more than its package\n${output}")
endif()
