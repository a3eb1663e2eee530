// Boxes in world space.
#pragma once

#include <array>

namespace glint {

// An axis-aligned box in world space. It is empty if any min is above its max.
struct Bounds {
    std::array<double, 3> min{};
    std::array<double, 3> max{};
    bool empty() const;
};

}  // namespace glint
