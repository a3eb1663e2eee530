// Triangles that emit light, as lights: which they are, where, and how bright.
#pragma once

#include "motion/motion_bounds.h"
#include "scene/geometry.h"
#include "scene/light_tree.h"
#include "scene/scene_materials.h"

#include <glint/package.h>
#include <glint/scene_view.h>

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

namespace glint {

class Emitters {
public:
    Emitters() = default;
    // `ordered` are the indices of uploadPrimitives(), and `materials` the records on the device.
    Emitters(const Package& package, const PackageScene& known, const SceneView& scene,
             const SceneLayout& layout, const DeformedAddresses& deformed,
             std::span<const std::vector<std::uint32_t>> ordered, std::span<const std::uint8_t> materials);

    // The triangles of a geometry follow each other.
    std::vector<gpu::EmitterRecord> records;
    std::vector<std::uint32_t> firsts;  // of each geometry: its first record, or gpu::kNoEmitter

    // Returns the bounds of each at a pose. Triangles of instances that change their shape have the
    // instance's box. Hidden ones are dark.
    std::vector<EmitterBounds> boundsAt(std::span<const InstanceView> instances) const;
    // Takes the values of materials that have changed.
    void takeMaterials(std::span<const ChangingMaterial> changing);
    // Stores where the tree has each triangle; without a tree, only whether it shines.
    void setLeaves(const LightTree& tree);
    void setLeaves(std::span<const EmitterBounds> bounds);

private:
    // Triangles of one geometry record.
    struct Part {
        std::uint32_t instance = 0;
        std::uint32_t material = 0;
        std::uint32_t first = 0;  // record
        std::uint32_t count = 0;
        bool twoSided = false;
        const MotionBounds* shapes = nullptr;  // of the instance's mesh if it changes its shape
    };
    // A triangle in its mesh's space, with the mean of the texels that it shows.
    struct Triangle {
        std::array<std::array<float, 3>, 3> corners{};
        float texels = 1.0F;
    };

    void addPart(const package::PrimitiveEntry& entry, std::uint32_t instance, std::uint32_t geometry,
                 const MotionBounds* shapes);

    std::vector<Part> parts_;
    std::vector<Triangle> triangles_;  // as `records`
    std::vector<double> luminances_;   // of each material, without its texture; cd/m²
    package::EmissionEntry emission_{};
    std::map<std::uint32_t, std::unique_ptr<MotionBounds>> shapes_;  // by mesh
};

}  // namespace glint
