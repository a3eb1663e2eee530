// The picture of --coverage: it shows how each pixel got its reflection.
#pragma once

#include "image/png.h"

#include <glint/renderer.h>

#include <vector>

namespace glint {

// The colours are those of Okabe and Ito, "Color Universal Design" (2008). Colour-blind people can tell them
// apart, and they differ in lightness. Orange: found in screen space. Blue: a ray that hit. Light blue: a ray
// that left the scene. Grey: no ray. Black: no surface. `paths` has width * height pixels.
DisplayImage coverageMap(const std::vector<PixelPath>& paths, std::uint32_t width, std::uint32_t height);

}  // namespace glint
