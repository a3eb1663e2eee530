// The scenes of one package, seen as one list of materials and one of primitives: cases are shared by all.
#pragma once

#include "gltf/scene.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace glint {

class SceneList {
public:
    // At least one; they must outlive the list and stay as they are.
    explicit SceneList(std::span<const Scene> scenes);
    SceneList(const SceneList&) = delete;
    SceneList& operator=(const SceneList&) = delete;

    // `count` elements of a list, from `first` on.
    struct Range {
        std::size_t first = 0;
        std::size_t count = 0;
    };
    // A material by its scene and its index there.
    struct Place {
        std::size_t scene = 0;
        int index = 0;
    };

    std::span<const Scene> scenes() const {
        return scenes_;
    }
    // Of the file, without folder and extension; of two alike the second is "name_2".
    const std::string& name(std::size_t scene) const {
        return names_[scene];
    }
    // Paths of the files, for messages.
    std::string path() const;
    // Names of the files without their folders.
    std::string fileNames() const;

    // Scene by scene, as planning sees them: planningMaterials().
    std::span<const Material> materials() const {
        return materials_;
    }
    // Scene by scene; PrimitiveInputs::material is an index into materials(), mesh and primitive are the
    // scene's.
    std::span<const PrimitiveInputs> primitives() const {
        return primitives_;
    }
    Range materialsOf(std::size_t scene) const {
        return materialRanges_[scene];
    }
    Range primitivesOf(std::size_t scene) const {
        return primitiveRanges_[scene];
    }
    // Of an index into materials().
    Place place(int material) const;
    // Of an index into materials(): the glTF name, else "material N"; "(default)" for the material of
    // primitives that have none.
    std::string materialName(int material) const;
    // KHR_materials_variants: the first that a scene was read with; empty: none.
    std::string variant() const;

private:
    std::span<const Scene> scenes_;
    std::vector<std::string> names_;
    std::span<const Material> materials_;
    std::vector<Material> joined_;  // what materials_ points at, unless one scene has it all
    std::vector<PrimitiveInputs> primitives_;
    std::vector<Range> materialRanges_;
    std::vector<Range> primitiveRanges_;
};

}  // namespace glint
