// Makes orders of leaves to compare the driver's own order with. They have the form of halvingOrder().
#pragma once

#include "data/traversal_order.h"

#include <cstdint>
#include <span>
#include <vector>

namespace glint::traversal {

// Keeps the order of the input.
std::vector<std::uint32_t> inputOrder(std::span<const LeafBox> leaves, std::uint32_t threads);
// Sorts by the Morton code of the centre, with 21 bits for each axis of the box of all centres.
std::vector<std::uint32_t> mortonOrder(std::span<const LeafBox> leaves, std::uint32_t threads);
// Returns the leaves, from left to right, of a tree by the surface area heuristic with 16 bins for each axis
// (Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", 2007).
std::vector<std::uint32_t> sahOrder(std::span<const LeafBox> leaves, std::uint32_t threads);

}  // namespace glint::traversal
