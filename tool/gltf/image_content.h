// What shading reads of the numbers that an image stores.
#pragma once

#include "gltf/scene.h"
#include "materials/interval.h"

#include <array>

namespace glint::gltf {

// Returns what a shader reads of such an image. `isColor` says that red, green and blue are in sRGB. The
// bounds are wider by what drivers round, but 0 and 1 stay exact: a channel that is 0 everywhere is read as
// 0.
std::array<materials::ValueInterval, 4> contentAsRead(const std::array<materials::ValueInterval, 4>& stored,
                                                      bool isColor);

// Returns the number that a code stands for, where it is colour in sRGB or not.
double numberAsRead(double stored, bool isColor);

}  // namespace glint::gltf
