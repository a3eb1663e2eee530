// Pictures and layers on the host.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace glint {

// An image of RGBA in linear 32-bit float. The first row is on top.
struct LinearImage {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::array<float, 4>> pixels;
};

// The values of a layer on the host, row by row from the top. One of the two has values.
struct LayerValues {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::uint32_t components = 0;  // of a pixel
    std::vector<float> reals;      // width * height * components
    std::vector<std::uint32_t> integers;
};

}  // namespace glint
