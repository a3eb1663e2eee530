# glint_add_materials(TARGET target SCENES file… [NAME name] [STRATEGY list] [TRACER list] [MERGE policy] [MAX_SHADERS n]
#                     [ALPHA policy] [MATERIALS folder…] [HOST folder] [LOCK file] [EMBED] [OUTPUT_DIRECTORY dir] [OPTIONS option…])
#
# Compiles the materials of glTF scenes into a package before TARGET, and again whenever a scene, a file that it reads, the
# lock, a pack of materials, the host or the tool changes. docs/integration.md describes each argument and what TARGET gets.

# Functions keep the policies that are set where they are defined.
cmake_policy(PUSH)
cmake_policy(VERSION 3.25)

# Finds the tool: GLINT_EXECUTABLE if it is set, as in a build for another machine; otherwise the tool of the
# project or of the package.
function(_glint_find_tool result)
  if(GLINT_EXECUTABLE)
    set(${result} "${GLINT_EXECUTABLE}" PARENT_SCOPE)
  elseif(TARGET Glint::glint)
    set(${result} Glint::glint PARENT_SCOPE)
  else()
    message(FATAL_ERROR "glint_add_materials: this Glint was built without the glint command; set GLINT_EXECUTABLE to one")
  endif()
endfunction()

function(_glint_check_target target)
  if(NOT TARGET "${target}")
    message(FATAL_ERROR "glint_add_materials: TARGET ${target} is no target; add it before its materials")
  endif()
  get_target_property(aliased ${target} ALIASED_TARGET)
  get_target_property(imported ${target} IMPORTED)
  get_target_property(type ${target} TYPE)
  if(aliased OR imported OR NOT type MATCHES "^(EXECUTABLE|(STATIC|SHARED|MODULE|OBJECT)_LIBRARY)$")
    message(FATAL_ERROR "glint_add_materials: TARGET ${target} must be an executable or a library that this project compiles")
  endif()
endfunction()

# Makes the paths of input files absolute. Relative paths are relative to the caller's source folder.
function(_glint_resolve_inputs result)
  set(paths "")
  foreach(path IN LISTS ARGN)
    cmake_path(ABSOLUTE_PATH path BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}" NORMALIZE)
    list(APPEND paths "${path}")
  endforeach()
  set(${result} "${paths}" PARENT_SCOPE)
endfunction()

# Checks a name, which is used for files and, in upper case, for a macro. Two packages of one folder must not
# share it.
function(_glint_check_name name folder)
  if(NOT name MATCHES "^[A-Za-z][A-Za-z0-9_]*$")
    message(FATAL_ERROR "glint_add_materials: NAME ${name} must be letters, digits and underscores, a letter first")
  endif()
  get_property(taken GLOBAL PROPERTY GLINT_PACKAGE_FOLDERS)
  if("${folder}" IN_LIST taken)
    message(FATAL_ERROR "glint_add_materials: ${folder} is the folder of another package; give this one a NAME of its own")
  endif()
  set_property(GLOBAL APPEND PROPERTY GLINT_PACKAGE_FOLDERS "${folder}")
endfunction()

function(glint_add_materials)
  set(passed STRATEGY TRACER MERGE MAX_SHADERS ALPHA EFFECTS)
  cmake_parse_arguments(PARSE_ARGV 0 arg "EMBED" "TARGET;NAME;MERGE;MAX_SHADERS;ALPHA;HOST;LOCK;OUTPUT_DIRECTORY"
                        "SCENES;STRATEGY;TRACER;EFFECTS;MATERIALS;OPTIONS")
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "glint_add_materials: unknown argument ${arg_UNPARSED_ARGUMENTS}")
  endif()
  if(arg_KEYWORDS_MISSING_VALUES)
    message(FATAL_ERROR "glint_add_materials: no value after ${arg_KEYWORDS_MISSING_VALUES}")
  endif()
  foreach(needed TARGET SCENES)
    if(NOT arg_${needed})
      message(FATAL_ERROR "glint_add_materials: ${needed} is missing")
    endif()
  endforeach()
  _glint_check_target(${arg_TARGET})
  _glint_find_tool(tool)
  _glint_resolve_inputs(scenes ${arg_SCENES})
  _glint_resolve_inputs(lock ${arg_LOCK})
  if(NOT arg_NAME)
    list(GET scenes 0 first)
    cmake_path(GET first STEM LAST_ONLY arg_NAME)
    string(REGEX REPLACE "[^A-Za-z0-9]+" "_" arg_NAME "${arg_NAME}")
  endif()
  if(NOT arg_OUTPUT_DIRECTORY)
    set(arg_OUTPUT_DIRECTORY glint)
  endif()
  cmake_path(ABSOLUTE_PATH arg_OUTPUT_DIRECTORY BASE_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}" NORMALIZE)
  set(base "${arg_OUTPUT_DIRECTORY}/${arg_NAME}")
  _glint_check_name("${arg_NAME}" "${base}")
  string(TOUPPER "GLINT_PACKAGE_${arg_NAME}" macro)

  # Builds the command line.
  set(options "")
  foreach(keyword IN LISTS passed)
    if(arg_${keyword})
      string(TOLOWER "--${keyword}" option)
      string(REPLACE "_" "-" option "${option}")
      list(JOIN arg_${keyword} "," value)
      list(APPEND options "${option}" "${value}")
    endif()
  endforeach()
  if(lock)
    list(APPEND options --lock "${lock}")
  endif()
  # The depfile knows the files that a pack has now; the glob finds new ones.
  _glint_resolve_inputs(packs ${arg_MATERIALS})
  set(pack_files "")
  foreach(pack IN LISTS packs)
    list(APPEND options --materials "${pack}")
    file(GLOB files CONFIGURE_DEPENDS "${pack}/*.json" "${pack}/*.glsl" "${pack}/*/*.json" "${pack}/*/*.glsl")
    list(APPEND pack_files ${files})
  endforeach()
  if(arg_HOST)
    _glint_resolve_inputs(host "${arg_HOST}")
    list(APPEND options --host "${host}")
    file(GLOB_RECURSE files CONFIGURE_DEPENDS "${host}/*.glsl" "${host}/*.h")
    list(APPEND pack_files ${files})
  endif()
  set(products "${base}/glint_tables.h" "${base}/manifest.json" "${base}/tables.bin")
  if(arg_EMBED)
    set(source "${base}_package.cpp")
    list(APPEND options --embed "${source}")
    list(APPEND products "${source}" "${base}_package.h")
  endif()

  # The stamp has the time at which the last run began, so that a file that is edited while the tool runs is newer.
  # Files that did not change keep their time, so nothing that reads them is built again. A rule of their own has them
  # as products: Ninja before 1.12 takes a rule for as new as the newest of its outputs.
  # A step with a lock may write that file, which it has read, so its stamp has the time at which it ended.
  set(stamp "${base}.stamp")
  set(written "${base}.written")
  if(lock)
    set(finish "${CMAKE_COMMAND}" -E touch "${stamp}")
  else()
    set(finish "${CMAKE_COMMAND}" -E rename "${base}.begun" "${stamp}")
  endif()
  add_custom_command(
    OUTPUT "${stamp}"
    COMMAND "${CMAKE_COMMAND}" -E make_directory "${arg_OUTPUT_DIRECTORY}"
    COMMAND "${CMAKE_COMMAND}" -E touch "${base}.begun"
    COMMAND "${tool}" compile ${scenes} -o "${base}" ${options} ${arg_OPTIONS} --depfile "${base}.d" --depfile-target
            "${stamp}"
    COMMAND ${finish}
    DEPENDS ${scenes} ${pack_files} "${tool}"
    DEPFILE "${base}.d"
    WORKING_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}"
    COMMENT "Compiling the materials of ${arg_NAME}"
    VERBATIM)
  add_custom_command(
    OUTPUT "${written}"
    BYPRODUCTS ${products}
    COMMAND "${CMAKE_COMMAND}" -E touch "${written}"
    DEPENDS "${stamp}"
    COMMENT ""
    VERBATIM)
  # The target may be defined in another folder, where this rule is not visible. So it depends on a target of
  # this folder.
  add_custom_target(${arg_TARGET}_${arg_NAME}_materials DEPENDS "${written}")
  add_dependencies(${arg_TARGET} ${arg_TARGET}_${arg_NAME}_materials)

  target_include_directories(${arg_TARGET} PRIVATE "${arg_OUTPUT_DIRECTORY}")
  target_compile_definitions(${arg_TARGET} PRIVATE "${macro}=\"${base}\"")
  set_target_properties(${arg_TARGET} PROPERTIES ${macro} "${base}")
  if(arg_EMBED)
    set_source_files_properties("${source}" TARGET_DIRECTORY ${arg_TARGET} PROPERTIES GENERATED TRUE)
    target_sources(${arg_TARGET} PRIVATE "${source}")
    target_link_libraries(${arg_TARGET} PRIVATE Glint::runtime)
  endif()
endfunction()

cmake_policy(POP)
