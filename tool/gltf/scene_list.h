// Presents the scenes of one package as one list of materials and one list of primitives. All scenes share
// the cases.
#pragma once

#include "gltf/scene.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace glint::gltf {

class SceneList {
public:
    // There must be at least one scene. The scenes must outlive the list and must not change.
    explicit SceneList(std::span<const Scene> scenes);
    SceneList(const SceneList&) = delete;
    SceneList& operator=(const SceneList&) = delete;

    // `count` elements of a list, starting at `first`.
    struct Range {
        std::size_t first = 0;
        std::size_t count = 0;
    };
    // Locates a material: its scene, and its index there.
    struct Place {
        std::size_t scene = 0;
        int index = 0;
    };

    std::span<const Scene> scenes() const {
        return scenes_;
    }
    // Returns the name of the file without folder and extension. If two are equal, the second is "name_2".
    const std::string& name(std::size_t scene) const {
        return names_[scene];
    }
    // Returns the paths of the files, for messages.
    std::string path() const;
    // Returns the names of the files without their folders.
    std::string fileNames() const;

    // Lists the materials scene by scene, as planningMaterials() returns them.
    std::span<const materials::Material> materials() const {
        return materials_;
    }
    // Lists the primitives scene by scene. PrimitiveInputs::material is an index into materials(); mesh and
    // primitive are numbers within the scene.
    std::span<const materials::PrimitiveInputs> primitives() const {
        return primitives_;
    }
    Range materialsOf(std::size_t scene) const {
        return materialRanges_[scene];
    }
    Range primitivesOf(std::size_t scene) const {
        return primitiveRanges_[scene];
    }
    // `material` is an index into materials().
    Place place(int material) const;
    // `material` is an index into materials(). Returns the glTF name, or "material N" if there is none, or
    // "(default)" for the material of primitives without one.
    std::string materialName(int material) const;
    // Returns the first variant (KHR_materials_variants) that a scene was read with, or an empty text if
    // there is none.
    std::string variant() const;

private:
    std::span<const Scene> scenes_;
    std::vector<std::string> names_;
    std::span<const materials::Material> materials_;
    std::vector<materials::Material> joined_;  // materials_ points here unless there is only one scene
    std::vector<materials::PrimitiveInputs> primitives_;
    std::vector<Range> materialRanges_;
    std::vector<Range> primitiveRanges_;
};

}  // namespace glint::gltf
