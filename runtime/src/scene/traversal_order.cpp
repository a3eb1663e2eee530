#include "scene/traversal_order.h"

#include "scene/leaf_order.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <system_error>
#include <thread>

namespace glint {
namespace {

std::uint32_t threadsOfMachine() {
    return std::max(std::thread::hardware_concurrency(), 1U);
}

using Corners = std::array<std::uint32_t, 3>;

std::vector<Corners> cornersOf(const PrimitiveView& view) {
    std::vector<Corners> triangles;
    triangles.reserve(view.indices.size() / 3);
    for (std::size_t i = 0; i + 2 < view.indices.size(); i += 3) {
        triangles.push_back({view.indices[i], view.indices[i + 1], view.indices[i + 2]});
    }
    return triangles;
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
    std::vector<Corners> triangles = cornersOf(view);
    orderPiece(view, triangles, leafOrder, threads);
    // Pieces of a primitive have trees of their own, which are halved at other places than the tree of the
    // whole would be.
    for (std::size_t first = 0; first < triangles.size() && capacity < triangles.size(); first += capacity) {
        const std::size_t count = std::min<std::size_t>(triangles.size() - first, capacity);
        orderPiece(view, std::span(triangles).subspan(first, count), leafOrder, threads);
    }
    std::vector<std::uint32_t> indices;
    indices.reserve(view.indices.size());
    for (const Corners& corners : triangles) {
        indices.insert(indices.end(), corners.begin(), corners.end());
    }
    return indices;
}

// Calls `work` for 0 to count - 1, on as many threads as the machine runs at once.
template <typename Work>
void forEach(std::size_t count, const Work& work) {
    std::atomic<std::size_t> next{0};
    const auto take = [&] {
        for (std::size_t i = next++; i < count; i = next++) {
            work(i);
        }
    };
    std::vector<std::thread> helpers;
    for (std::uint32_t i = 1; i < std::min<std::size_t>(threadsOfMachine(), count); ++i) {
        try {
            helpers.emplace_back(take);
        } catch (const std::system_error&) {
            break;  // no more threads: the existing ones do all the work
        }
    }
    take();
    for (std::thread& helper : helpers) {
        helper.join();
    }
}

// Returns the box around the vertices that the triangles use, because primitives may share an array of which
// each uses a part.
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

std::vector<std::vector<std::uint32_t>> orderedTriangles(std::span<const PrimitiveView> primitives,
                                                         const BlasCapacity& capacity, LeafOrder order) {
    std::vector<std::vector<std::uint32_t>> ordered(primitives.size());
    // If there are many primitives, one thread orders each of them. If there are few, each one gets more
    // threads.
    const std::uint32_t threads =
        primitives.size() < 4 * std::size_t{threadsOfMachine()} ? threadsOfMachine() : 1;
    forEach(primitives.size(), [&](std::size_t i) {
        ordered[i] = orderPrimitive(primitives[i], capacity.triangles, order, threads);
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
