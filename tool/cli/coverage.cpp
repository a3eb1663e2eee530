#include "cli/coverage.h"

namespace glint {

namespace {

std::array<std::uint8_t, 3> colorOf(PixelPath path) {
    switch (path) {
        case PixelPath::Screen:
            return {230, 159, 0};
        case PixelPath::Hit:
            return {0, 114, 178};
        case PixelPath::Miss:
            return {86, 180, 233};
        case PixelPath::NoRay:
            return {90, 90, 90};
        case PixelPath::NoSurface:
            break;
    }
    return {0, 0, 0};
}

}  // namespace

DisplayImage coverageMap(const std::vector<PixelPath>& paths, std::uint32_t width, std::uint32_t height) {
    DisplayImage image{width, height, {}};
    image.pixels.reserve(paths.size());
    for (const PixelPath path : paths) {
        image.pixels.push_back(colorOf(path));
    }
    return image;
}

}  // namespace glint
