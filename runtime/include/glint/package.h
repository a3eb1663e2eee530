// A compiled package, read and checked. No Vulkan device needed.
#pragma once

#include <glint/embedded_file.h>
#include <glint/package_modules.h>
#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

namespace gpu {
struct MaterialRecord;
}

// What a package knows of one of its scenes. Valid as long as the package.
struct PackageScene {
    std::string_view name;
    std::span<const gpu::MaterialRecord> materials;
    std::span<const package::PrimitiveEntry> primitives;  // sorted by (mesh, primitive)
    std::span<const package::TextureEntry> textures;
    std::span<const package::SamplerEntry> samplers;

    // The entry for a primitive of a mesh, or null if the package does not know it.
    const package::PrimitiveEntry* findPrimitive(std::uint32_t mesh, std::uint32_t primitive) const;
};

class PackageFiles;  // for the runtime's own sources

class Package {
public:
    // Reads tables.bin and every module of `folder`. The error says whether the folder is no package, of
    // another version, truncated or altered.
    static Result<Package> load(const std::filesystem::path& folder);
    // The same of files in memory, with the same checks. They are copied: none is needed afterwards. Files
    // that tables.bin does not name are ignored.
    static Result<Package> load(std::span<const package::EmbeddedFile> files);

    Package(Package&&) noexcept;
    Package& operator=(Package&&) noexcept;
    ~Package();

    bool supports(package::Strategy strategy) const;
    bool alphaTested() const;
    // Strategies, tracers and where shadow rays are: what decides which modules there are.
    package::PackageShape shape() const;
    package::HitRecordFormat hitRecord() const;
    // Whether misses read an environment map rather than a gradient.
    bool environmentMap() const;
    // Whether shaders read positions of hit triangles from acceleration structures:
    // DeviceHandles::positionFetch.
    bool positionFetch() const;
    // With Half the shaders compute in 16-bit float, too: DeviceHandles::shaderFloat16.
    package::ShadingPrecision precision() const;
    std::uint32_t caseCount() const;
    // Buckets of a visibility buffer: 0 for misses, 1 + shader ID for hits.
    std::uint32_t bucketCount() const;

    std::span<const package::CaseEntry> cases() const;
    std::span<const package::ModuleEntry> modules() const;
    // At least one.
    std::uint32_t sceneCount() const;
    // `index` < sceneCount(), in the order in which they were given to the compiler.
    PackageScene scene(std::uint32_t index) const;
    std::optional<std::uint32_t> findScene(std::string_view name) const;

    std::string_view string(package::StringRef ref) const;
    // SPIR-V words of a module. Empty if the package lacks it.
    std::span<const std::uint32_t> spirv(const package::ModuleKey& key) const;
    struct State;  // for the runtime's own sources

private:
    explicit Package(std::unique_ptr<State> state);
    static Result<Package> loadFrom(const PackageFiles& files);
    std::unique_ptr<State> state_;
};

}  // namespace glint
