// The order in which a CPU driver gets the leaves of an acceleration structure.
//
// Mesa's lavapipe (lvp_acceleration_structure.c) does not search for a good tree. A node over n leaves has
// the first ceil(n / 2) of them, in the order of the input, on one side, and the others on the other side.
// The order alone decides the tree.
#pragma once

#include "motion/motion_bounds.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace glint {

// The box of a leaf as min x, y, z and -max x, y, z, so that a union is the minimum of all six. A box is void
// if a coordinate was not finite; the initial value is void too.
struct LeafBox {
    std::array<float, 6> sides;

    LeafBox();
    explicit LeafBox(const Box& box);
    void extend(const LeafBox& other);
    void extend(const std::array<float, 3>& point);
    bool isVoid() const;
    double surface() const;  // square units; 0 if void
};

// Returns an order that makes a small tree when it is halved as above. It works from the top down. Each
// node's leaves are parted after the first ceil(n / 2) of them, either along an axis or by their size. The
// key whose two sides have the least surface is taken. `order[i]` is the leaf in place i. Void leaves come
// first, because their boxes, which are no numbers, then don't get into those of the nodes above.
//
// Takes O(n log² n) time and 44 bytes a leaf. The result does not depend on `threads`, which must be at least
// 1.
std::vector<std::uint32_t> halvingOrder(std::span<const LeafBox> leaves, std::uint32_t threads);

}  // namespace glint
