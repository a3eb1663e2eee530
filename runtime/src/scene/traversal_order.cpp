#include "scene/traversal_order.h"

#include "context/parallel.h"
#include "scene/leaf_order.h"

#include <algorithm>
#include <array>

namespace glint {
namespace {

using Corners = std::array<std::uint32_t, 3>;

std::vector<Corners> cornersOf(std::span<const std::uint32_t> indices) {
    std::vector<Corners> triangles;
    triangles.reserve(indices.size() / 3);
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
    }
    return triangles;
}

std::vector<std::uint32_t> indicesOf(std::span<const Corners> triangles) {
    std::vector<std::uint32_t> indices;
    indices.reserve(3 * triangles.size());
    for (const Corners& corners : triangles) {
        indices.insert(indices.end(), corners.begin(), corners.end());
    }
    return indices;
}

void orderPiece(const PrimitiveView& view, std::span<Corners> triangles, LeafOrder leafOrder,
                std::uint32_t threads) {
    std::vector<LeafBox> boxes(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        for (const std::uint32_t corner : triangles[i]) {
            boxes[i].extend(view.positions[corner]);
        }
    }
    const std::vector<std::uint32_t> order = leafOrder(boxes, threads);
    std::ranges::copy(permuted<Corners>(triangles, order), triangles.begin());
}

std::vector<std::uint32_t> orderPrimitive(const PrimitiveView& view, std::uint64_t capacity,
                                          LeafOrder leafOrder, std::uint32_t threads) {
    std::vector<Corners> triangles = cornersOf(view.indices);
    orderPiece(view, triangles, leafOrder, threads);
    // Pieces of a primitive have trees of their own, which are halved at other places than the tree of the
    // whole would be.
    for (std::size_t first = 0; first < triangles.size() && capacity < triangles.size(); first += capacity) {
        const std::size_t count = std::min<std::size_t>(triangles.size() - first, capacity);
        orderPiece(view, std::span(triangles).subspan(first, count), leafOrder, threads);
    }
    return indicesOf(triangles);
}

// Orders the tested triangles and the opaque ones. The others are in no structure.
std::vector<std::uint32_t> orderSplit(const PrimitiveView& view, std::span<const std::uint32_t> sorted,
                                      const OpacitySplit& split, LeafOrder leafOrder, std::uint32_t threads) {
    std::vector<Corners> triangles = cornersOf(sorted);
    orderPiece(view, std::span(triangles).first(split.tested), leafOrder, threads);
    orderPiece(view, std::span(triangles).subspan(split.tested, split.opaque), leafOrder, threads);
    return indicesOf(triangles);
}

// Returns the box around the vertices that the triangles use, because primitives may share an array and use
// different parts of it.
Box boxOf(const PrimitiveView& view) {
    LeafBox box;
    for (const std::uint32_t corner : view.indices) {
        box.extend(view.positions[corner]);
    }
    if (box.isVoid()) {
        return Box::nothing();
    }
    return {{box.sides[0], box.sides[1], box.sides[2]}, {-box.sides[3], -box.sides[4], -box.sides[5]}};
}

}  // namespace

LeafOrder leafOrderFor(const Context::State& context, TraversalOrder wanted) {
    const bool isCpu = context.limits.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    if (wanted == TraversalOrder::Input || (wanted == TraversalOrder::Auto && !isCpu)) {
        return nullptr;
    }
    return context.leafOrder != nullptr ? context.leafOrder : halvingOrder;
}

BlasCapacity orderedCapacity(BlasCapacity capacity) {
    return {capacity.triangles, 1};
}

std::vector<std::vector<std::uint32_t>> orderedTriangles(
    std::span<const PrimitiveView> primitives, const BlasCapacity& capacity, LeafOrder order,
    std::span<const std::vector<std::uint32_t>> sorted, const std::map<std::uint32_t, OpacitySplit>& splits) {
    std::vector<std::vector<std::uint32_t>> ordered(primitives.size());
    // If there are many primitives, one thread orders each of them. If there are few, each one gets more
    // threads.
    const std::uint32_t threads =
        primitives.size() < 4 * std::size_t{threadsOfMachine()} ? threadsOfMachine() : 1;
    forEach(primitives.size(), [&](std::size_t i) {
        const auto split = splits.find(static_cast<std::uint32_t>(i));
        ordered[i] = split == splits.end()
                         ? orderPrimitive(primitives[i], capacity.triangles, order, threads)
                         : orderSplit(primitives[i], sorted[i], split->second, order, threads);
    });
    return ordered;
}

InstanceOrder::InstanceOrder(std::span<const PrimitiveView> primitives, std::span<const MeshPart> parts,
                             LeafOrder order)
    : order_(order), deformed_(parts.size()) {
    std::vector<Box> boxes(primitives.size());
    forEach(primitives.size(), [&](std::size_t i) { boxes[i] = boxOf(primitives[i]); });
    for (std::size_t part = 0; part < parts.size(); ++part) {
        Box box = Box::nothing();
        for (const TriangleRange& range : parts[part].ranges) {
            box.extend(boxes[range.primitive]);
        }
        boxes_.push_back(box);
        if (parts[part].instance) {
            const std::uint32_t first = parts[part].ranges.front().primitive;
            const std::uint32_t last = parts[part].ranges.back().primitive;
            deformed_[part] = std::make_unique<MotionBounds>(primitives.subspan(first, last - first + 1));
        }
    }
}

std::vector<std::uint32_t> InstanceOrder::at(std::span<const InstanceView> instances,
                                             std::span<const PartInstance> placed) const {
    std::vector<LeafBox> boxes;
    boxes.reserve(placed.size());
    for (const PartInstance& place : placed) {
        const InstanceView& instance = instances[place.instance];
        boxes.emplace_back(deformed_[place.part] ? deformed_[place.part]->at(instance)
                                                 : transformed(boxes_[place.part], instance.objectToWorld));
    }
    return order_(boxes, threadsOfMachine());
}

}  // namespace glint
