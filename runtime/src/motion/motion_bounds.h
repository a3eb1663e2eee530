// Boxes around moving meshes, computed without reading the vertices again.
#pragma once

#include <glint/scene_view.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace glint {

// An axis-aligned box. It is empty if a min is above its max.
struct Box {
    std::array<double, 3> min{};
    std::array<double, 3> max{};

    static Box nothing();
    void extend(const Box& other);
    bool isEmpty() const;
    double surface() const;                // square metres; 0 if empty
    double diagonal() const;               // metres; 0 if empty
    std::array<double, 3> centre() const;  // requires a box that is not empty
};

// Returns the box around a box's corners, transformed by three rows of four.
Box transformed(const Box& box, const std::array<float, 12>& rows);

// Bounds a mesh in every pose of an instance. It has a box for each joint around the vertices that follow the
// joint, and the ranges of the morph targets' differences. This works because a weighted mean of transforms
// takes a point into the hull of the points that the single transforms make of it.
class MotionBounds {
public:
    // `primitives` must be those of the mesh and no others.
    explicit MotionBounds(std::span<const PrimitiveView> primitives);

    // Returns a box in world space that contains the mesh at that pose. It is the mesh's exact box if nothing
    // deforms or turns the mesh.
    Box at(const InstanceView& instance) const;

private:
    struct JointBox {
        std::uint32_t joint;
        Box box;
    };
    struct Part {
        Box rest = Box::nothing();
        std::vector<JointBox> joints;  // empty if the mesh follows no skin
        std::vector<Box> targets;      // ranges of the targets' differences
    };
    std::vector<Part> parts_;
};

}  // namespace glint
