# Wrong arguments of glint_add_materials() must give errors that say what is wrong. Arguments: -DWORK=…
# -DMODULE=…/GlintMaterials.cmake
cmake_minimum_required(VERSION 3.25)

# refused(MESSAGE ARGUMENTS…): expects that a project with these arguments does not configure, and that the
# message says why.
function(refused message)
  list(JOIN ARGN " " arguments)
  file(REMOVE_RECURSE "${WORK}")
  file(WRITE "${WORK}/main.cpp" "int main() {}\n")
  file(WRITE "${WORK}/CMakeLists.txt"
       "cmake_minimum_required(VERSION 3.25)\nproject(wrong LANGUAGES NONE)\ninclude(\"${MODULE}\")\n"
       "add_library(game OBJECT IMPORTED)\nadd_custom_target(step)\n"
       "${before}glint_add_materials(${arguments})\n")
  execute_process(COMMAND ${CMAKE_COMMAND} -S "${WORK}" -B "${WORK}/build" -G "${GENERATOR}" RESULT_VARIABLE result
                  OUTPUT_VARIABLE output ERROR_VARIABLE output)
  string(REGEX REPLACE "[ \n]+" " " output "${output}")
  string(FIND "${output}" "${message}" found)
  if(result EQUAL 0 OR found EQUAL -1)
    message(FATAL_ERROR "glint_add_materials(${arguments}): exit ${result}, not \"${message}\"\n${output}")
  endif()
endfunction()

refused("TARGET is missing" SCENES a.gltf)
refused("SCENES is missing" TARGET game)
refused("no value after SCENES" TARGET game SCENES)
refused("no value after MERGE" TARGET game SCENES a.gltf MERGE EMBED)
refused("unknown argument STRATEGIES" STRATEGIES uber TARGET game SCENES a.gltf)
refused("TARGET gmae is no target" TARGET gmae SCENES a.gltf)
refused("must be an executable or a library" TARGET game SCENES a.gltf)
refused("must be an executable or a library" TARGET step SCENES a.gltf)

set(before "add_library(lib OBJECT main.cpp)\nset_target_properties(lib PROPERTIES LINKER_LANGUAGE CXX)\n")
refused("set GLINT_EXECUTABLE" TARGET lib SCENES a.gltf)
string(APPEND before "set(GLINT_EXECUTABLE glint)\n")
refused("NAME 2nd must be letters" TARGET lib SCENES a.gltf NAME 2nd)
string(APPEND before "glint_add_materials(TARGET lib SCENES a.gltf)\n")
refused("give this one a NAME of its own" TARGET lib SCENES other/a.gltf)
