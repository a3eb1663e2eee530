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

# Writes the scene, the pack of materials and the host of the package "own". The sky's radiance is `sky`, and is in a file that
# the host's includes.
set(own "${WORK}/own")
function(write_sky sky)
  file(WRITE "${own}/host/game/sky_radiance.glsl" "const vec3 kSkyRadiance = vec3(${sky});\n")
endfunction()
function(write_own)
  file(READ "${WORK}/scenes/cubes.gltf" scene)
  string(REPLACE "\"name\": \"Velvet\"" "\"name\": \"Velvet\", \"extras\": { \"wet\": 0.5 }" wet_scene "${scene}")
  if(wet_scene STREQUAL scene)
    message(FATAL_ERROR "the scene has no Velvet")
  endif()
  file(WRITE "${WORK}/scenes/own.gltf" "${wet_scene}")
  write_sky(0.25)
  file(WRITE "${own}/host/sky.glsl"
       "#include \"host/resources.glsl\"\n#include \"game/sky_radiance.glsl\"\n"
       "vec3 hostSky(vec3 direction) { return kSkyRadiance; }\n"
       "vec3 hostSkyAround(vec3 direction, float roughness) { return kSkyRadiance; }\n"
       "vec3 hostSkyIrradianceOverPi(vec3 normal) { return kSkyRadiance; }\n")
  file(WRITE "${own}/pack/wet.json"
       "{ \"name\": \"wet\", \"object\": \"extras\", \"stage\": \"surface\", \"glsl\": { \"surface\": \"wet.glsl\" },\n"
       "  \"parameters\": [{ \"name\": \"wetness\", \"at\": \"wet\", \"type\": \"float\", \"default\": 0, \"range\": [0, 1] }],\n"
       "  \"neutral\": [{ \"when\": \"wetness == 0\", \"because\": \"it is dry\" }] }\n")
  file(WRITE "${own}/pack/wet.glsl"
       "#include \"hit/surface_values.glsl\"\n"
       "void wetSurface(Hit hit, Features features, inout SurfaceValues values) {\n"
       "    values.roughness *= 1.0 - GLINT_MATERIAL_WETNESS(hit);\n}\n")
endfunction()

# Builds again, and expects that only the package "own" is made, and that its shader is another one or not.
macro(expect_own_alone change)
  file(SHA256 "${build}/glint/own/uber.spv" before)
  run(${CMAKE_COMMAND} --build "${build}")
  file(SHA256 "${build}/glint/own/uber.spv" after)
  if(NOT output MATCHES "materials of own" OR output MATCHES "materials of (both|cubes)" OR before STREQUAL after)
    message(FATAL_ERROR "${change}: not the package that it is for, or the same shader\n${output}")
  endif()
  wait_for_tick("${WORK}")
endmacro()

set(prefix "${WORK}/prefix")
set(build "${WORK}/build")
file(REMOVE_RECURSE "${WORK}")
file(COPY "${SCENES}/" DESTINATION "${WORK}/scenes")
file(COPY_FILE "${WORK}/scenes/cubes.gltf" "${WORK}/scenes/copy.gltf")

write_own()
run(${CMAKE_COMMAND} --install "${GLINT_BUILD}" --prefix "${prefix}")
run("${prefix}/bin/glint" --version)
run(${CMAKE_COMMAND} -S "${CONSUMER}" -B "${build}" -G "${GENERATOR}" "-DCMAKE_PREFIX_PATH=${prefix}"
    "-DCMAKE_CXX_FLAGS=${FLAGS}" "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}" "-DSCENES=${WORK}/scenes" "-DOWN=${own}")
run(${CMAKE_COMMAND} --build "${build}")
run("${build}/uses_runtime" "${WORK}/no-such-package")
run("${build}/uses_compiler")

# An engine asks for the runtime, and has nothing that the compiler's libraries link. Its materials need the command alone.
file(WRITE "${WORK}/engine/CMakeLists.txt"
     "cmake_minimum_required(VERSION 3.25)\nproject(engine LANGUAGES CXX)\n"
     "find_package(Glint REQUIRED COMPONENTS \${COMPONENTS})\n"
     "message(STATUS \"compiler: \${Glint_compiler_FOUND}\")\n"
     "add_executable(uses_runtime \"${CONSUMER}/uses_runtime.cpp\")\n"
     "target_link_libraries(uses_runtime PRIVATE Glint::runtime)\n"
     "glint_add_materials(TARGET uses_runtime SCENES \"${WORK}/scenes/cubes.gltf\")\n")
set(compiler_links glslang SPIRV-Tools SPIRV-Tools-opt PkgConfig)
set(gltf_links fmt draco meshoptimizer)

# Configures the engine with these components, without the packages of `lacking`: `output` must have the text.
macro(expect_components components text)
  set(without "")
  foreach(package ${compiler_links} ${gltf_links})
    set(is_lacking OFF)
    if(package IN_LIST lacking)
      set(is_lacking ON)
    endif()
    list(APPEND without -DCMAKE_DISABLE_FIND_PACKAGE_${package}=${is_lacking})
  endforeach()
  execute_process(COMMAND ${CMAKE_COMMAND} -S "${WORK}/engine" -B "${WORK}/engine_build" -G "${GENERATOR}"
                          "-DCMAKE_PREFIX_PATH=${prefix}" "-DCMAKE_CXX_FLAGS=${FLAGS}"
                          "-DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}" ${without} "-DCOMPONENTS=${components}"
                  OUTPUT_VARIABLE output ERROR_VARIABLE output)
  string(REGEX REPLACE "[ \n]+" " " output "${output}")
  expect_output("${text}")
endmacro()
set(lacking ${compiler_links} ${gltf_links})
expect_components("shader" "Glint has no component shader. It has: package, runtime, gltf, compiler, session, measure, glint.")
expect_components("runtime;compiler" "The component compiler needs fmt, which was not found.")
expect_components("" "The component gltf needs fmt, which was not found.")
expect_components("runtime;OPTIONAL_COMPONENTS;compiler" "compiler: OFF")
expect_components("package;glint" "Configuring done")
set(lacking ${compiler_links})
expect_components("gltf" "Configuring done")
set(lacking PkgConfig)
expect_components("session" "The component session needs OpenEXR, which was not found.")
expect_components("compiler" "compiler: ON")
set(lacking "")
expect_components("session;measure" "Configuring done")
set(lacking ${compiler_links} ${gltf_links})
expect_components("runtime" "Configuring done")
run(${CMAKE_COMMAND} --build "${WORK}/engine_build")
run("${build}/uses_gltf" "${WORK}/scenes/cubes.gltf")
expect_output("4 meshes, 4 materials")
run("${build}/uses_session" "${WORK}/scenes/cubes.gltf")
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

# So do the files of a host, those that they include, and those of a pack.
file(READ "${build}/glint/own/manifest.json" manifest)
string(JSON hosts GET "${manifest}" host)
string(JSON packs GET "${manifest}" packs)
if(NOT hosts MATCHES "sky.glsl" OR NOT packs MATCHES "wet")
  message(FATAL_ERROR "the manifest names the host's files ${hosts} and the packs ${packs}")
endif()
write_sky(0.75)
expect_own_alone("a file that the host includes")
file(READ "${own}/host/sky.glsl" text)
string(REPLACE "float roughness) { return" "float roughness) { return 0.5 *" text "${text}")
file(WRITE "${own}/host/sky.glsl" "${text}")
expect_own_alone("a file of the host")
file(READ "${own}/pack/wet.glsl" text)
string(REPLACE "1.0 -" "1.0 - 0.5 *" text "${text}")
file(WRITE "${own}/pack/wet.glsl" "${text}")
expect_own_alone("a pack")

# A file that is new in the host's folder replaces Glint's own.
file(WRITE "${own}/host/random.glsl"
     "float hostRandom(uint target, uint dimension) { return 0.5; }\n"
     "vec2 hostRandomPair(uint target, uint pair) { return vec2(0.5); }\n")
expect_own_alone("a new file of the host")
file(READ "${build}/glint/own/manifest.json" manifest)
string(JSON hosts GET "${manifest}" host)
if(NOT hosts MATCHES "random.glsl")
  message(FATAL_ERROR "the host's new file is not in the package: ${hosts}")
endif()
