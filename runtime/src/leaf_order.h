// In which order a CPU driver gets the leaves of an acceleration structure.
//
// Mesa's lavapipe (lvp_acceleration_structure.c) does not look for a tree: a node over n leaves has the first
// ceil(n / 2) of them, in the order of the input, on one side, and the others on the other. The order alone
// makes the tree.
#pragma once

#include "motion_bounds.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace glint {

// The box of a leaf: min x, y, z and -max x, y, z, so that a union is the minimum of all six.
// Void, which is the initial value, where a coordinate was not finite.
struct LeafBox {
    std::array<float, 6> sides;

    LeafBox();
    explicit LeafBox(const Box& box);
    void extend(const LeafBox& other);
    void extend(const std::array<float, 3>& point);
    bool isVoid() const;
    double surface() const;  // square units; 0 where void
};

// The order that makes a small tree when it is halved as above: from the top down, each node's leaves are
// parted at that place along the axis, or by the size of the leaves, with which both sides have the least
// surface. `order[i]` is the leaf that comes in place i. Leaves that are void come first: from there their
// boxes, which are no numbers, don't get into those of the nodes above.
//
// Takes O(n log² n) time and 44 bytes a leaf; the result does not depend on `threads`, which is at least 1.
std::vector<std::uint32_t> halvingOrder(std::span<const LeafBox> leaves, std::uint32_t threads);

}  // namespace glint
