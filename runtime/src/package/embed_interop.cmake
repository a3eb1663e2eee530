# Writes the text of the interop headers in FOLDER to OUTPUT, as a C++ string. The text has each header's name, a line
# feed and its contents, in the order of names. The compiler puts the hash of the same text into packages (tool/emit).
file(GLOB headers RELATIVE "${FOLDER}" "${FOLDER}/interop/*.h")
list(SORT headers)
set(code "// Made by embed_interop.cmake from the interop headers. Do not edit.\n#include \"package/package.h\"\n\n")
string(APPEND code "namespace glint {\n\nstd::string_view interopText() {\n    return\n")
foreach(header IN LISTS headers)
  file(READ "${FOLDER}/${header}" text)
  string(APPEND code "        \"${header}\\n\"\n        R\"glint(${text})glint\"\n")
endforeach()
string(APPEND code "        ;\n}\n\n}  // namespace glint\n")
file(WRITE "${OUTPUT}" "${code}")
