# glint_commit(TARGET): compiles the commit of the sources into TARGET, as sourceCommit() of
# glint/measure/machine.h. Every build checks the commit, but only a new commit compiles anything.
#
# The same file is the script that checks: cmake -DSOURCE=… -DOUTPUT=… -P GlintCommit.cmake.

if(CMAKE_SCRIPT_MODE_FILE)
  cmake_minimum_required(VERSION 3.25)
  execute_process(
    COMMAND git -C "${SOURCE}" describe --always --dirty --abbrev=12 --exclude=*
    OUTPUT_VARIABLE commit
    RESULT_VARIABLE failed
    OUTPUT_STRIP_TRAILING_WHITESPACE
    ERROR_QUIET)
  if(failed OR NOT commit MATCHES "^[0-9a-f]+(-dirty)?$")
    set(commit "unknown")
  endif()
  file(CONFIGURE OUTPUT "${OUTPUT}" @ONLY CONTENT
       "#include <glint/measure/machine.h>\n\nstd::string_view glint::measure::sourceCommit() {\n    return \"@commit@\";\n}\n")
  return()
endif()

set(GLINT_COMMIT_SCRIPT "${CMAKE_CURRENT_LIST_FILE}")

function(glint_commit target)
  set(output "${CMAKE_CURRENT_BINARY_DIR}/commit.cpp")
  add_custom_target(
    ${target}_commit
    COMMAND "${CMAKE_COMMAND}" "-DSOURCE=${PROJECT_SOURCE_DIR}" "-DOUTPUT=${output}" -P "${GLINT_COMMIT_SCRIPT}"
    BYPRODUCTS "${output}"
    COMMENT "Looking at the commit"
    VERBATIM)
  add_dependencies(${target} ${target}_commit)
  target_sources(${target} PRIVATE "${output}")
  set_source_files_properties("${output}" PROPERTIES GENERATED TRUE)
endfunction()
