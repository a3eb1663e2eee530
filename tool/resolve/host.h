// The shaders that modules are made of: those that are compiled into the tool, and those of a host.
#pragma once

#include "base/files.h"

#include <glint/result.h>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace glint::compiler {

// Returns the files of shaders/, then those of templates/, each sorted by name. They have static storage.
std::span<const base::BuiltinFile> builtinFiles();

// The host: the functions through which shading reads geometry, materials, textures, lights and sky. Glint's
// own are in shaders/host; a folder of the user's may have others in their place.

// Returns the files of a host's folder, sorted: those of the folder, which stand in for files of shaders/host
// with the same names, and the .glsl and .h files of folders in it, which they may include. No folder gives
// no file. Errors: "host-folder" if it can't be listed or replaces nothing, "host-unknown" for a file that
// stands in for none.
Result<std::vector<std::filesystem::path>> hostFiles(const std::string& folder);

// Returns the names of the files of shaders/host that the folder replaces: "geometry.glsl". Has the errors of
// hostFiles().
Result<std::vector<std::string>> replacedHostFiles(const std::string& folder);

// Returns whether a message's place is in a file of the host's folder.
bool isHostPlace(const std::string& where, const std::string& folder);

}  // namespace glint::compiler
