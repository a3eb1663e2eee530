// The picture of --coverage: how each pixel came to its reflection.
#pragma once

#include "image/png.h"

#include <glint/renderer.h>

#include <vector>

namespace glint {

// Colours after Okabe and Ito, "Color Universal Design" (2008), which colour-blind people tell apart, and
// which differ in lightness: orange, found in screen space; blue, by a ray that hit; light blue, by a ray
// that left the scene; grey, no ray; black, no surface. `paths` has width * height pixels.
DisplayImage coverageMap(const std::vector<PixelPath>& paths, std::uint32_t width, std::uint32_t height);

}  // namespace glint
