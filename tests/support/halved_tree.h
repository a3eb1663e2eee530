// Computes the tree of a driver that halves its leaves in their given order, as Mesa's lavapipe does. It
// shows without a device how good an order is.
#pragma once

#include "data/traversal_order.h"

#include <cstdint>
#include <span>
#include <vector>

namespace glint::test {

struct HalvedNode {
    LeafBox box;
    double surfaces = 0.0;  // of this node and all below it, including leaves
};

// Returns the node over order[first] to order[first + count - 1]. As in lvp_build_internal_node(), the first
// half has the odd leaf.
inline HalvedNode halvedNode(std::span<const LeafBox> leaves, std::span<const std::uint32_t> order,
                             std::size_t first, std::size_t count) {
    if (count == 1) {
        const LeafBox& leaf = leaves[order[first]];
        return {leaf, leaf.surface()};
    }
    const std::size_t left = (count + 1) / 2;
    HalvedNode node = halvedNode(leaves, order, first, left);
    const HalvedNode right = halvedNode(leaves, order, first + left, count - left);
    node.box.extend(right.box);
    node.surfaces += right.surfaces + node.box.surface();
    return node;
}

// Returns how many nodes and leaves a ray that meets the root meets on average, by the surface area heuristic
// (MacDonald and Booth, "Heuristics for Ray Tracing Using Space Subdivision", 1990): the surface of all nodes
// divided by that of the root.
inline double halvedTreeCost(std::span<const LeafBox> leaves, std::span<const std::uint32_t> order) {
    const HalvedNode root = halvedNode(leaves, order, 0, order.size());
    return root.surfaces / root.box.surface();
}

}  // namespace glint::test
