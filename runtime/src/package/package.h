// A package in memory, and the checks that make it trustworthy.
#pragma once

#include "context/context.h"
#include "interop/scene.h"

#include <glint/context.h>
#include <glint/internal/package_modules.h>
#include <glint/layers.h>
#include <glint/package.h>
#include <glint/result.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

// The hint of errors that only a new package can fix.
inline constexpr const char* kRecompile = "compile the package again with `glint compile`";

struct Package::State {
    std::vector<std::uint8_t> tables;  // the bytes of the file; the spans below point into them
    package::PackageHeader header{};
    std::span<const package::ModuleEntry> modules;
    MaterialTable materials;
    std::span<const package::PrimitiveEntry> primitives;
    std::span<const package::TextureEntry> textures;
    std::span<const package::SamplerEntry> samplers;
    std::span<const char> strings;
    std::span<const package::CaseEntry> cases;
    std::span<const package::SceneEntry> scenes;
    std::span<const package::AttributeEntry> attributes;
    std::span<const package::EffectEntry> effectEntries;
    std::vector<package::EffectInfo> effects;  // the same, with their names
    std::span<const package::LayerInfo::Entry> layerEntries;
    std::vector<package::PackageLayer> layers;         // the same, with their rows and names
    std::span<const package::EmissionEntry> emission;  // empty without emissive lights
    std::span<const package::OpacityEntry> opacity;    // empty where alpha is not tested by Glint's own code
    std::span<const package::FeatureEntry> features;
    // The feature that has each role; empty for roles of parameters and textures.
    std::array<package::KeyWords, static_cast<std::size_t>(package::Role::Count)> featureOfRole{};
    std::span<const package::FieldEntry> fields;
    // Keyed by file name. Entries that name the same file share its words.
    std::map<std::string, std::vector<std::uint32_t>, std::less<>> spirv;
    // A hash of each module, by the address of its words. 128 bits, so that two modules never have the same
    // by chance. Made here, because a frame should not wait for it when a package is replaced.
    std::map<const std::uint32_t*, std::array<std::uint64_t, 2>> hashes;

    // Returns whether a key has the feature with that role; false for Role::None.
    bool hasFeature(const package::KeyWords& key, package::Role role) const {
        return key.hasAny(featureOfRole[static_cast<std::size_t>(role)]);
    }
};

// Returns the shape that the header and the cases describe.
package::PackageShape shapeOf(const Package::State& state);

// Reads the header, the section table and the spans from state.tables. `where` is the file's name. Errors:
// "package-foreign" (not a package), "package-version", "package-truncated", "package-altered".
Status readTables(Package::State& state, const std::string& where);

// Checks every index, reference and promise of the tables, and fills state.effects. Error "package-altered"
// names the fault.
Status checkTables(Package::State& state, const std::string& where);

// The source of a package's files.
class PackageFiles {
public:
    // Returns the name that messages use for a file.
    std::function<std::string(const std::string& name)> where;
    // Returns a whole file. If the file is longer than maxBytes, returns its first maxBytes + 1 bytes.
    // Errors: `missingId` if there is no such file, "package-read", "package-file-name".
    std::function<Result<std::vector<std::uint8_t>>(const std::string& name, const char* missingId,
                                                    std::uint64_t maxBytes)>
        read;
};

// Files below a folder. No name and no link may lead out of it.
PackageFiles filesOf(const std::filesystem::path& folder);
// Files in memory, which must outlive the result. If two have the same name, the first one counts.
PackageFiles filesOf(std::span<const package::EmbeddedFile> files);

// Reads the modules that the tables name into state.spirv.
// Errors: "package-module-missing", "package-module-altered", and those of PackageFiles::read().
Status readModules(Package::State& state, const PackageFiles& files);

// Returns the offset of a texture of a record, from the start of the table. Requires material < table.size()
// and slot < table.textureCount.
inline std::size_t placeOfTexture(const MaterialTable& table, std::size_t material, std::uint32_t slot) {
    return material * table.recordBytes + table.textureOffset + slot * sizeof(gpu::TextureRecord);
}

inline gpu::TextureRecord textureAt(const MaterialTable& table, std::size_t material, std::uint32_t slot) {
    gpu::TextureRecord record{};
    std::memcpy(&record, &table.bytes[placeOfTexture(table, material, slot)], sizeof record);
    return record;
}

// Returns a table of other records in the same layout.
inline MaterialTable tableWith(const MaterialTable& layout, std::span<const std::uint8_t> records) {
    return {records, layout.recordBytes, layout.textureOffset, layout.textureCount};
}

// Errors "position-fetch" and "half-precision": the device was created without what all shaders of the
// package need. Modules with other needs are checked where pipelines are made of them.
Status checkDevice(const Package& package, const DeviceHandles& handles);

// Returns a hash of what a scene's records on the device and the shaders of its package must agree about: the
// keys and numbers of primitives, textures and samplers, and the layout of materials and attributes.
std::uint64_t recordsHash(const Package& package, const PackageScene& scene);
// The flags of a geometry record that its primitive's entry has.
inline constexpr std::uint32_t kEntryFlags = gpu::kGeometryAlphaTested | gpu::kGeometryDoubleSided |
                                             gpu::kGeometryMasked | gpu::kGeometryBlended |
                                             gpu::kGeometryEmitter | gpu::kGeometryPassesLight;

// Error "scene-package": no scene of the package has records with that hash.
Status checkRecords(const Package& package, std::uint64_t hash);

// Returns the interop headers of the build, one after the other.
std::string_view interopText();

// Returns the PackageHeader::interopHash of packages whose shaders share these layouts.
std::uint32_t interopHash();

}  // namespace glint
