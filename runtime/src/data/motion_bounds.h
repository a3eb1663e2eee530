// Boxes around moving meshes, and what follows from them for acceleration structures.
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

// The rules for when an acceleration structure that moved is refitted and when it is built anew.
// docs/movement.md has the measurements.

enum class BuildAction : std::uint8_t { Keep, Refit, Build };

// A refit keeps the tree of the last build, which grouped the triangles that were near each other at that
// time. Boxes don't show every way in which such a tree gets bad, so a build happens at least this often. Its
// cost is spread over as many frames.
inline constexpr std::uint32_t kMaxRefits = 32;

// Nodes of a mesh that has grown overlap more, and the time of rays grows with their surface. The limit is
// the ratio of the surface of the mesh's box to that at the build. Below it, refits are assumed to cost rays
// less time than a build takes.
inline constexpr double kMaxGrowth = 2.0;

// The changes of a BLAS since its last build.
struct BlasHistory {
    std::uint32_t refits = 0;
    double surface = 0.0;  // surface of the box at the build

    // `deformed` says whether the vertices have changed since the last call.
    BuildAction next(bool deformed, double surfaceNow) const;
    void apply(BuildAction action, double surfaceNow);
};

// Returns whether a box has moved, since a build of the TLAS, by more than its length at that time. Until
// then no node above the instance has grown by more than the instance's own size.
bool hasLeft(const Box& built, const Box& now);

}  // namespace glint
