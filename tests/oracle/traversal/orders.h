// Orders of leaves that the driver's own is compared with, in the form of halvingOrder().
#pragma once

#include "leaf_order.h"

#include <cstdint>
#include <span>
#include <vector>

namespace glint::traversal {

// As they come.
std::vector<std::uint32_t> inputOrder(std::span<const LeafBox> leaves, std::uint32_t threads);
// By the Morton code of the centre, 21 bits an axis of the box of all centres.
std::vector<std::uint32_t> mortonOrder(std::span<const LeafBox> leaves, std::uint32_t threads);
// The leaves, from left to right, of a tree by the surface area heuristic with 16 bins an axis (Wald, "On
// fast Construction of SAH-based Bounding Volume Hierarchies", 2007).
std::vector<std::uint32_t> sahOrder(std::span<const LeafBox> leaves, std::uint32_t threads);

}  // namespace glint::traversal
