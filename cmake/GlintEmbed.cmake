# glint_embed(TARGET OUTPUT file.cpp HEADER path.h FUNCTION name ROOTS dir… PATTERNS glob…): compiles text
# files into TARGET. At run time they are found by their path below a root through FUNCTION(), named with its
# namespaces, which HEADER declares as std::span<const BuiltinFile> FUNCTION(). Changed, added and removed
# files cause a rebuild.
#
# The same file is the generator: cmake -DOUTPUT=… -DLIST=… -DHEADER=… -DFUNCTION=… -P GlintEmbed.cmake, where
# each line of LIST is "name|path".

if(CMAKE_SCRIPT_MODE_FILE)
  file(STRINGS "${LIST}" entries ENCODING UTF-8)
  set(code "// Made by cmake/GlintEmbed.cmake from the files that it names. Do not edit.\n")
  string(APPEND code "#include \"${HEADER}\"\n\n")
  string(APPEND code "std::span<const glint::base::BuiltinFile> ${FUNCTION}() {\n")
  # A literal with its length: counting the characters exceeds the steps that Clang allows a constant expression.
  string(APPEND code "    using namespace std::string_view_literals;\n")
  string(APPEND code "    static constexpr glint::base::BuiltinFile kFiles[] = {\n")
  foreach(entry IN LISTS entries)
    string(REGEX MATCH "^([^|]+)\\|(.+)$" matched "${entry}")
    set(name "${CMAKE_MATCH_1}")
    set(path "${CMAKE_MATCH_2}")
    file(READ "${path}" text)
    if(text MATCHES "\\)glint\"")
      message(FATAL_ERROR "${path} holds the delimiter that embedding needs")
    endif()
    string(APPEND code "        {\"${name}\"sv, R\"glint(${text})glint\"sv},\n")
  endforeach()
  string(APPEND code "    };\n    return kFiles;\n}\n")
  file(WRITE "${OUTPUT}" "${code}")
  return()
endif()

set(GLINT_EMBED_SCRIPT "${CMAKE_CURRENT_LIST_FILE}")

function(glint_embed target)
  cmake_parse_arguments(arg "" "OUTPUT;HEADER;FUNCTION" "ROOTS;PATTERNS" ${ARGN})
  set(lines "")
  set(inputs "")
  foreach(root IN LISTS arg_ROOTS)
    set(globs ${arg_PATTERNS})
    list(TRANSFORM globs PREPEND "${root}/")
    file(GLOB_RECURSE found RELATIVE "${root}" CONFIGURE_DEPENDS ${globs})
    foreach(name IN LISTS found)
      string(APPEND lines "${name}|${root}/${name}\n")
      list(APPEND inputs "${root}/${name}")
    endforeach()
  endforeach()
  if(NOT lines)
    message(FATAL_ERROR "glint_embed: no file matches ${arg_PATTERNS} below ${arg_ROOTS}")
  endif()
  file(CONFIGURE OUTPUT "${arg_OUTPUT}.list" CONTENT "${lines}" @ONLY)
  add_custom_command(
    OUTPUT "${arg_OUTPUT}"
    COMMAND "${CMAKE_COMMAND}" "-DOUTPUT=${arg_OUTPUT}" "-DLIST=${arg_OUTPUT}.list" "-DHEADER=${arg_HEADER}"
            "-DFUNCTION=${arg_FUNCTION}" -P "${GLINT_EMBED_SCRIPT}"
    DEPENDS ${inputs} "${arg_OUTPUT}.list" "${GLINT_EMBED_SCRIPT}"
    COMMENT "Embedding the files of ${arg_FUNCTION}()"
    VERBATIM)
  # The target may be defined in another folder, where this rule is not visible. So it depends on a target of
  # this folder.
  add_custom_target(${target}_embedded DEPENDS "${arg_OUTPUT}")
  add_dependencies(${target} ${target}_embedded)
  set_source_files_properties("${arg_OUTPUT}" TARGET_DIRECTORY ${target} PROPERTIES GENERATED TRUE)
  target_sources(${target} PRIVATE "${arg_OUTPUT}")
  set_target_properties(${target} PROPERTIES GLINT_EMBEDDED_LIST "${arg_OUTPUT}.list")
  # Programs can bring files of their own, as the test of docs/strategies.md does.
  glint_compiled_alone(${target} "${arg_OUTPUT}")
endfunction()
