# Builds examples/cmake-consumer against an installed Glint, and checks what each change rebuilds and what it
# does not.
# Arguments: -DGLINT_BUILD=… -DWORK=… -DEXAMPLE=… -DGENERATOR=… -DOTHER_TEXTURE=… [-DFLAGS=…] [-DLAUNCHER=…]
cmake_minimum_required(VERSION 3.25)
include("${CMAKE_CURRENT_LIST_DIR}/run.cmake")

set(prefix "${WORK}/prefix")
set(source "${WORK}/source")
set(build "${WORK}/build")
set(package "${build}/glint/cubes")
set(scene "${source}/scene/cubes.gltf")
file(REMOVE_RECURSE "${WORK}")
file(COPY "${EXAMPLE}/" DESTINATION "${source}")

set(config "")
set(program "${build}/cubes")
if(GENERATOR MATCHES "Multi-Config")
  set(config --config Debug)
  set(program "${build}/Debug/cubes")
endif()

# Builds and sets: `output`, what the build printed; `changed`, the package's files that are new or have
# another time; `gone`, those that no longer exist; `compiled`, the sources that a compiler read.
macro(build)
  take_times(before)
  run(${CMAKE_COMMAND} --build "${build}" ${config})
  take_times(after)
  compare_times()
  string(REGEX MATCHALL "Building CXX object [^\n]*" compiled "${output}")
  string(REGEX REPLACE "Building CXX object [^;]*/([a-z_]+\\.cpp)\\.o" "\\1" compiled "${compiled}")
  list(SORT compiled)
  wait_for_tick("${WORK}")
endmacro()

# Sets `result` to the package's files, and `result_FILE` to the time of each.
macro(take_times result)
  file(GLOB ${result} RELATIVE "${package}" "${package}/*")
  foreach(file IN LISTS ${result})
    file(TIMESTAMP "${package}/${file}" ${result}_${file} "%s.%f")
  endforeach()
endmacro()

macro(compare_times)
  set(changed ${after})
  foreach(file IN LISTS after)
    if(file IN_LIST before AND before_${file} STREQUAL after_${file})
      list(REMOVE_ITEM changed "${file}")
    endif()
  endforeach()
  set(gone ${before})
  if(after)
    list(REMOVE_ITEM gone ${after})
  endif()
endmacro()

macro(expect_materials)
  if(NOT output MATCHES "Compiling the materials of cubes")
    message(FATAL_ERROR "${step}: the materials were not compiled again\n${output}")
  endif()
endmacro()

macro(expect_no_work)
  if(changed OR gone OR output MATCHES "Building|Linking|Compiling")
    message(FATAL_ERROR "${step}: ${changed} ${gone}\n${output}")
  endif()
  if(GENERATOR MATCHES "Ninja" AND NOT output MATCHES "ninja: no work to do")
    message(FATAL_ERROR "${step}: ninja had something to do\n${output}")
  endif()
endmacro()

# expect(changed a b) and so on: expects exactly these.
macro(expect what)
  if(NOT "${${what}}" STREQUAL "${ARGN}")
    message(FATAL_ERROR "${step}: ${what} \"${${what}}\", not \"${ARGN}\"\n${output}")
  endif()
endmacro()

function(edit_scene from to)
  file(READ "${scene}" text)
  string(REPLACE "${from}" "${to}" edited "${text}")
  if(edited STREQUAL text)
    message(FATAL_ERROR "${scene} has no ${from}")
  endif()
  file(WRITE "${scene}" "${edited}")
endfunction()

macro(configure)
  run(${CMAKE_COMMAND} -S "${source}" -B "${build}" -G "${GENERATOR}" "-DCMAKE_PREFIX_PATH=${prefix}"
      "-DCMAKE_CXX_FLAGS=${FLAGS}" "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}" ${ARGN})
endmacro()

run(${CMAKE_COMMAND} --install "${GLINT_BUILD}" --prefix "${prefix}")

set(step "first build")
configure()
build()
expect_materials()
expect(compiled cubes.cpp cubes_package.cpp main.cpp picture.cpp)
run("${program}" "${WORK}/cubes.ppm")
if(NOT output MATCHES "4 shaders, 5 buckets.*material Velvet: shader 1 Sheen_Normals")
  message(FATAL_ERROR "the program says\n${output}")
endif()

set(step "configured again")
configure()
build()
expect_no_work()

set(step "an unrelated file")
file(WRITE "${source}/scene/notes.txt" "not read by anything")
build()
expect_no_work()

set(step "another time of the tool")
file(TOUCH "${prefix}/bin/glint")
build()
expect_materials()
expect(changed)
expect(compiled)

set(step "after another time of the tool")
build()
expect_no_work()

# Only the list of files that were read changes, unless a condition of a feature depends on the pixels.
set(step "another texture")
file(COPY_FILE "${OTHER_TEXTURE}" "${source}/scene/tiles.png")
file(TOUCH "${source}/scene/tiles.png")
build()
expect_materials()
expect(changed manifest.json)
expect(compiled)

set(step "another value")
edit_scene("\"roughnessFactor\": 0.15" "\"roughnessFactor\": 0.2")
build()
expect_materials()
expect(changed manifest.json tables.bin)
expect(compiled cubes_package.cpp)

set(step "another feature")
edit_scene("\"extensions\": { \"KHR_materials_sheen\"" "\"extensions\": { \"KHR_materials_clearcoat\": { \"clearcoatFactor\": 1 }, \"KHR_materials_sheen\"")
build()
expect_materials()
expect(changed first_1_ClearcoatSheen_Normals.spv glint_tables.h manifest.json shade_1_ClearcoatSheen_Normals.spv
       tables.bin)
expect(gone first_1_Sheen_Normals.spv shade_1_Sheen_Normals.spv)
expect(compiled cubes_package.cpp main.cpp)
run("${program}")
if(NOT output MATCHES "4 shaders, 5 buckets.*material Velvet: shader 1 ClearcoatSheen_Normals")
  message(FATAL_ERROR "the program says\n${output}")
endif()

set(step "a broken scene")
file(COPY_FILE "${scene}" "${scene}.good")
edit_scene("\"buffers\"" "\"buffer\"")
take_times(before)
execute_process(COMMAND ${CMAKE_COMMAND} --build "${build}" ${config} RESULT_VARIABLE result OUTPUT_VARIABLE output
                ERROR_VARIABLE output)
wait_for_tick("${WORK}")
take_times(after)
compare_times()
if(result EQUAL 0 OR NOT output MATCHES "cubes.gltf[^\n]*error:")
  message(FATAL_ERROR "${step}: exit ${result}\n${output}")
endif()
expect(changed)
expect(gone)

set(step "mended")
file(RENAME "${scene}.good" "${scene}")
file(TOUCH "${scene}")
build()
expect_materials()
expect(changed)
expect(compiled)

set(step "at the end")
build()
expect_no_work()

# This tool edits the scene when glint has read it, but before the rule ends.
set(step "edited while it is compiled")
file(READ "${scene}" text)
string(REPLACE "\"roughnessFactor\": 0.2" "\"roughnessFactor\": 0.25" text "${text}")
file(WRITE "${WORK}/next.gltf" "${text}")
file(WRITE "${WORK}/editing_tool" "#!/bin/sh
'${prefix}/bin/glint' \"$@\" || exit
if [ -e '${WORK}/next.gltf' ]; then
    sleep 0.1
    cat '${WORK}/next.gltf' >'${scene}'
    rm '${WORK}/next.gltf'
fi
")
file(CHMOD "${WORK}/editing_tool" PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
configure("-DGLINT_EXECUTABLE=${WORK}/editing_tool")
build()
expect_materials()
build()
expect_materials()
expect(changed manifest.json tables.bin)
build()
expect_no_work()

if(GENERATOR MATCHES "Multi-Config")
  set(step "another configuration")
  set(config --config Release)
  build()
  expect(changed)
  expect(compiled cubes.cpp cubes_package.cpp main.cpp picture.cpp)
  build()
  expect_no_work()
endif()
