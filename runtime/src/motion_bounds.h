// Boxes around what moves, without looking at vertices again.
#pragma once

#include <glint/scene_view.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace glint {

// Axis-aligned; empty where a min is above its max.
struct Box {
    std::array<double, 3> min{};
    std::array<double, 3> max{};

    static Box nothing();
    void extend(const Box& other);
    bool isEmpty() const;
    double surface() const;                // square metres; 0 where empty
    double diagonal() const;               // metres; 0 where empty
    std::array<double, 3> centre() const;  // of a box that is not empty
};

// The box of a box's corners under three rows of four.
Box transformed(const Box& box, const std::array<float, 12>& rows);

// What bounds a mesh in every pose of an instance: a box for each joint around the vertices that follow it,
// and the ranges of the morph targets' differences. A weighted mean of transforms takes a point into the hull
// of the points that each alone makes of it.
class MotionBounds {
public:
    // `primitives`: those of the mesh, and no others.
    explicit MotionBounds(std::span<const PrimitiveView> primitives);

    // In world space. Not less than the mesh at that pose; equal to its box where nothing deforms and nothing
    // turns.
    Box at(const InstanceView& instance) const;

private:
    struct JointBox {
        std::uint32_t joint;
        Box box;
    };
    struct Part {
        Box rest = Box::nothing();
        std::vector<JointBox> joints;  // empty: it follows no skin
        std::vector<Box> targets;      // ranges of differences
    };
    std::vector<Part> parts_;
};

}  // namespace glint
