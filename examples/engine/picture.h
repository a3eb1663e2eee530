// Pictures in files.
#pragma once

#include "frame.h"

#include <string>

namespace engine {

// Writes a picture: as it is, in 32-bit floats, if the file's name ends in .exr, and else as a tone-mapped
// PNG. An error ends the program.
void writePicture(const Picture& picture, const std::string& file);

}  // namespace engine
