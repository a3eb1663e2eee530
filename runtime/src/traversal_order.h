// Triangles and instances in an order that suits a CPU driver (leaf_order.h says why).
#pragma once

#include "context_state.h"
#include "geometry.h"
#include "motion_bounds.h"

#include <glint/scene_view.h>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace glint {

// How a scene is ordered on this device; null: not at all. Drivers of GPUs look for a good tree themselves.
LeafOrder leafOrderFor(const Context::State& context, TraversalOrder wanted);

// What one BLAS holds where triangles are ordered: one geometry. A driver that keeps the geometries of a BLAS
// in sequence would mix parts of neighbours in its nodes; instances, of which each then has one, can be
// ordered by where they are.
BlasCapacity orderedCapacity(BlasCapacity capacity);

// The indices of each primitive, in its order of triangles; corners stay in theirs. `capacity` is that of
// orderedCapacity(): the pieces that primitives above it are cut into are ordered one by one. Takes 56 bytes
// a triangle while a primitive is ordered, 12 of which stay.
std::vector<std::vector<std::uint32_t>> orderedTriangles(std::span<const PrimitiveView> primitives,
                                                         const BlasCapacity& capacity, LeafOrder order);

// Knows where the instances of a top level are in any pose of the scene.
class InstanceOrder {
public:
    // Keeps nothing of what it is given. `primitives`: those of the scene.
    InstanceOrder(std::span<const PrimitiveView> primitives, std::span<const MeshPart> parts,
                  LeafOrder order);

    // The order of `placed` at a pose: place i is for placed[result[i]].
    std::vector<std::uint32_t> at(std::span<const InstanceView> instances,
                                  std::span<const PartInstance> placed) const;

private:
    LeafOrder order_;
    std::vector<Box> boxes_;                               // by part, in its mesh's space; as the file has it
    std::vector<std::unique_ptr<MotionBounds>> deformed_;  // by part: null unless an instance deforms it
};

// values[order[0]], values[order[1]] and so on.
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
