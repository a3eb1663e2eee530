// What images hold: the least and greatest number of each channel.
#pragma once

#include "gltf/scene.h"
#include "materials/interval.h"

#include <array>

namespace glint::gltf {

// Returns the interval of each channel over all texels of all levels, in [0, 1], as the image stores them.
// Requires pixels. A filter's results, and those of levels that are made from these, are within it.
std::array<materials::ValueInterval, 4> storedContent(const Image& image);

// Returns what a shader reads of such an image. `isColor` says that red, green and blue are in sRGB. The
// bounds are wider by what drivers round, but 0 and 1 stay exact: a channel that is 0 everywhere is read as
// 0.
std::array<materials::ValueInterval, 4> contentAsRead(const std::array<materials::ValueInterval, 4>& stored,
                                                      bool isColor);

}  // namespace glint::gltf
