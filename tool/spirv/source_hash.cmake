# Usage: cmake -DROOT=… -DFOLDERS=… -DOUTPUT=file.h -P source_hash.cmake. Writes a header with one hash of the C++
# files of folders below the root.
set(patterns "")
foreach(folder IN LISTS FOLDERS)
  list(APPEND patterns "${ROOT}/${folder}/*.h" "${ROOT}/${folder}/*.cpp")
endforeach()
file(GLOB_RECURSE files RELATIVE "${ROOT}" ${patterns})
list(SORT files)
set(all "")
foreach(name IN LISTS files)
  file(SHA256 "${ROOT}/${name}" hash)
  string(APPEND all "${name} ${hash}\n")
endforeach()
string(SHA256 hash "${all}")
string(CONCAT header "// Made by tool/spirv/source_hash.cmake. Do not edit.\n#pragma once\n\nnamespace glint {\n\n"
              "inline constexpr const char* kSpirvSourceHash = \"${hash}\";\n\n}  // namespace glint\n")
file(CONFIGURE OUTPUT "${OUTPUT}" CONTENT "${header}" @ONLY)
