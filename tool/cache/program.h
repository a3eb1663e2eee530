// Identifies this program exactly.
#pragma once

#include <string>

namespace glint::compiler {

// Returns a text that differs between builds of the program and of the shared libraries that it runs with. It
// consists of their build IDs; for a file without one, of its path, size and time stamp.
std::string programIdentity();

}  // namespace glint::compiler
