// The shaders that a package has for keys of materials.
#pragma once

#include <glint/package.h>
#include <glint/result.h>
#include <glint/scene.h>

#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

namespace glint {

// The fields of a geometry record that follow from its material's key.
struct Shading {
    std::uint64_t features = 0;
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
    Result<Shading> find(const MaterialKey& key, const std::string& where) const;
    // Checks that the attributes include those that shaders of the key's features read. Error
    // "scene-edit-key".
    Status checkAttributes(const MaterialKey& key, const std::string& where) const;

    // The shader IDs of the shader binding table of a strategy: those of the cases, then one for all others.
    std::vector<std::uint32_t> shaderIds() const;
    std::string namesOf(std::uint64_t features) const;
    const Package& package() const {
        return *package_;
    }

private:
    Status checkKnown(const MaterialKey& key, const std::string& where) const;
    // Checks that shaders compute the emission of a light with this key.
    Status checkEmitter(const MaterialKey& key, const std::string& where) const;

    std::shared_ptr<const Package> package_;
    bool fallback_;
    std::unordered_map<std::uint64_t, std::uint32_t> shaderOfKey_;  // of the package's primitives
    std::uint64_t known_ = 0;                                       // features of some primitive
    std::uint64_t always_ = ~0ULL;  // features of every primitive, which no shader asks for
    std::uint32_t flags_ = 0;       // geometry flags of some primitive
};

}  // namespace glint
