// Which program this is, to the byte.
#pragma once

#include <string>

namespace glint {

// Another text for every build of the program, and of the shared libraries that it runs with: their build
// IDs, or where one has none the path, size and time stamp of its file.
std::string programIdentity();

}  // namespace glint
