// The order in which a CPU driver gets the leaves of an acceleration structure.
//
// Mesa's lavapipe (lvp_acceleration_structure.c) does not search for a good tree. A node over n leaves has
// the first ceil(n / 2) of them, in the order of the input, on one side, and the others on the other side.
// The order alone decides the tree.
#pragma once

#include "context/context.h"
#include "data/geometry.h"
#include "data/motion_bounds.h"

#include <glint/scene_view.h>

#include <array>
#include <cstdint>
#include <map>
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

// Returns how a scene is ordered on this device, or null if it keeps its order. Drivers of GPUs search for a
// good tree themselves.
LeafOrder leafOrderFor(const Context::State& context, SceneView::TraversalOrder wanted);

// Returns the capacity of one BLAS if triangles are ordered: one geometry. A driver that keeps the geometries
// of a BLAS in sequence would mix parts of neighbours in its nodes. With one geometry each, instances can be
// ordered by their positions.
BlasCapacity orderedCapacity(BlasCapacity capacity);

// Returns the indices of each primitive in the order of its triangles; the corners of a triangle keep their
// order. `capacity` is that of orderedCapacity(). A primitive above it is cut into pieces that are ordered
// one by one. In a primitive with a split, each kind of triangles in `sorted` is ordered by itself. Takes 56
// bytes a triangle while a primitive is ordered, and keeps 12 of them.
std::vector<std::vector<std::uint32_t>> orderedTriangles(
    std::span<const PrimitiveView> primitives, const BlasCapacity& capacity, LeafOrder order,
    std::span<const std::vector<std::uint32_t>> sorted = {},
    const std::map<std::uint32_t, OpacitySplit>& splits = {});

// Returns the box around the vertices that the triangles use, because primitives may share an array and use
// different parts of it. It is empty if a coordinate is not finite.
Box boxOf(const PrimitiveView& view, std::span<const std::uint32_t> indices);

// Returns values[order[0]], values[order[1]] and so on.
template <typename T>
std::vector<T> permuted(std::span<const T> values, std::span<const std::uint32_t> order) {
    std::vector<T> result;
    result.reserve(order.size());
    for (const std::uint32_t i : order) {
        result.push_back(values[i]);
    }
    return result;
}

}  // namespace glint
