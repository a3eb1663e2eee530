// The window's report about a pixel.
#pragma once

#include "view/picture.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace glint::view {

struct Pick {
    std::uint32_t x = 0;  // pixels of the picture
    std::uint32_t y = 0;
    std::vector<Field> fields;
    int material = -1;  // index into Scene::materials; -1: the sky
};

// Describes the surface that the pixel sees in the last sample: material, key, case and the reasons for them,
// bucket, rays, cost. Waits for the device. Errors are those of Renderer::readPlace() and
// Renderer::readOutput().
Result<Pick> pickPixel(const Request& request, Picture& picture, std::uint32_t x, std::uint32_t y,
                       double exposure);

}  // namespace glint::view
