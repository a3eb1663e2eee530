// The shaders that a package has for keys of materials.
#pragma once

#include <glint/package.h>
#include <glint/result.h>
#include <glint/scene.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace glint {

// The fields of a geometry record that follow from its material's key.
struct Shading {
    package::KeyWords features;
    std::uint32_t geometryFlags = 0;
    std::uint32_t shaderId = 0;
    bool missing = false;  // no case has the key: the fallback shades it

    bool operator==(const Shading&) const = default;
};

// The keys that a package has shaders for.
class CaseTable {
public:
    explicit CaseTable(std::shared_ptr<const Package> package);

    // Finds the shader of a key. `where` is the material, for messages. A key of the package's own scenes has
    // the shader that they have. For others it is the case that has all of the key's features and takes the
    // fewest others into account. Errors: "scene-edit-feature", "scene-edit-case".
    Result<Shading> find(const SceneEditor::MaterialKey& whole, const std::string& where) const;
    // Checks that the attributes include those that shaders of the key's features read. Error
    // "scene-edit-key".
    Status checkAttributes(const SceneEditor::MaterialKey& key, const std::string& where) const;

    // The shader IDs of the shader binding table of a strategy: those of the cases, then one for all others.
    std::vector<std::uint32_t> shaderIds() const;
    std::string namesOf(const package::KeyWords& features) const;
    const Package& package() const {
        return *package_;
    }

private:
    // Returns the part of the key that the package's rays ask for.
    SceneEditor::MaterialKey asked(SceneEditor::MaterialKey key) const;
    Status checkKnown(const SceneEditor::MaterialKey& key, const std::string& where) const;
    // Checks that shaders compute the emission of a light with this key.
    Status checkEmitter(const SceneEditor::MaterialKey& key, const std::string& where) const;

    std::shared_ptr<const Package> package_;
    bool fallback_;
    struct Less {
        bool operator()(const package::KeyWords& a, const package::KeyWords& b) const;
    };
    std::map<package::KeyWords, std::uint32_t, Less> shaderOfKey_;  // of the package's primitives
    package::KeyWords known_;                                       // shared features of some primitive
    // What primitives of a model have, by its word in keys.
    struct KnownModel {
        package::KeyWords::Own own;
        std::uint32_t flags = 0;  // of geometries
    };
    std::map<std::uint32_t, KnownModel> knownModels_;
    // Shared features of every primitive, which no shader asks for.
    package::KeyWords always_{~0U, ~0U};
    std::uint32_t flags_ = 0;  // geometry flags of some primitive
};

}  // namespace glint
