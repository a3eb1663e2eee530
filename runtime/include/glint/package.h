// A compiled package, read and checked. It needs no Vulkan device. A package does not change, so any number
// of threads may use it at once. load() and poll() wait for files. A Package::Watch is used by one thread at
// a time.
#pragma once

#include <glint/package_shape.h>
#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::package {

struct PackageLayer;  // glint/layers.h
// For the runtime's own sources and Glint's tools.
struct EmissionEntry;
struct FieldEntry;
struct ModuleEntry;
struct ModuleKey;
struct OpacityEntry;
struct PackageShape;

}  // namespace glint::package

namespace glint {

// Records of materials, one after the other, in the layout that the package's shaders read. Each ends with
// its textures.
struct MaterialTable {
    std::span<const std::uint8_t> bytes;
    std::uint32_t recordBytes = 0;
    std::uint32_t textureOffset = 0;  // of the first gpu::TextureRecord in a record, bytes
    std::uint32_t textureCount = 0;   // in each record

    std::size_t size() const {
        return recordBytes == 0 ? 0 : bytes.size() / recordBytes;
    }
    // Requires first + count <= size().
    MaterialTable part(std::size_t first, std::size_t count) const {
        return {bytes.subspan(first * recordBytes, count * recordBytes), recordBytes, textureOffset,
                textureCount};
    }
};

// The tables of one of a package's scenes. The spans are valid as long as the package.
struct PackageScene {
    std::string_view name;
    MaterialTable materials;
    std::span<const package::PrimitiveEntry> primitives;  // sorted by (mesh, primitive)
    std::span<const package::TextureEntry> textures;
    std::span<const package::SamplerEntry> samplers;

    // Returns the entry for a primitive of a mesh, or null if the package does not know the primitive.
    const package::PrimitiveEntry* findPrimitive(std::uint32_t mesh, std::uint32_t primitive) const;
};

class PackageFiles;  // for the runtime's own sources

class Package {
public:
    // Reads tables.bin and every module of `folder`. The error says whether the folder has no package, or one
    // of another version, or one that is truncated or altered.
    static Result<Package> load(const std::filesystem::path& folder);
    // Reads a package from files in memory, with the same checks. The files are copied, so they need not
    // outlive the call. Files that tables.bin does not name are ignored.
    static Result<Package> load(std::span<const package::EmbeddedFile> files);

    Package(Package&&) noexcept;
    Package& operator=(Package&&) noexcept;
    ~Package();

    // Returns whether the package has the modules of a strategy.
    bool supports(package::Strategy strategy) const;
    // Returns whether masked geometry must be built non-opaque, so that rays run alpha tests.
    bool alphaTested() const;
    // Returns how rays treat the alpha of materials.
    package::AlphaPolicy alpha() const;
    // Returns how the light of punctual lights passes through alpha and glass. It is Alpha unless the scenes
    // need another mode.
    package::ShadowThrough shadowThrough() const;
    // Returns the strategies, the tracers, the placement of shadow rays and whatever else decides which
    // modules the package has.
    package::PackageShape shape() const;
    package::HitRecordFormat hitRecord() const;
    package::SampleRecordFormat sampleRecord() const;
    // Returns whether the record of a sample also holds the hit of its ray, so that there are no records of
    // hits.
    bool hitsInSamples() const;
    // Returns whether misses read an environment map rather than a gradient.
    bool environmentMap() const;
    // Returns whether shaders record which levels of textures they read (Renderer::Counters::textureLevels).
    bool textureLevels() const;
    // Returns whether shaders rely on the contents of the scenes' textures, so that no other image may
    // replace them.
    bool trustTextures() const;
    // Returns whether shaders read the positions of hit triangles from acceleration structures. The device
    // then needs DeviceHandles::positionFetch.
    bool positionFetch() const;
    // Returns whether the package draws frames, for Renderer, or has the steps that RaySteps records.
    package::Passes passes() const;
    package::HitAnswer answer() const;
    // Returns where shaders find the host's descriptors and push constants.
    const package::Bindings& bindings() const;
    // With ShadingPrecision::Half shaders also compute in 16-bit float. The device then needs
    // DeviceHandles::shaderFloat16.
    package::ShadingPrecision precision() const;
    // Returns how many lights a surface chooses by the scene's hierarchy; 0 if it takes all.
    std::uint32_t lightSamples() const;
    // Returns whether surfaces sample the sky as a light. An environment map then needs
    // Environment::Options::sampled.
    bool skyLight() const;
    // Returns whether rays of lobes find area lights (LightView::size), as samples of these lights do.
    bool sizedLights() const;
    // Returns whether lights may be disks (LightView::Type::Disk).
    bool diskLights() const;
    // Returns where records of materials keep their emission, or null in packages without emissive lights.
    const package::EmissionEntry* emission() const;
    // Returns where records of materials keep alpha. It is null for packages that do not test alpha, and for
    // those that test it by code that is not Glint's own.
    const package::OpacityEntry* opacity() const;
    // Returns the names of features of materials, in the order of bits, for messages about keys. Bits without
    // a name are left out.
    std::vector<std::string> featureNames(const package::KeyWords& features) const;
    // Returns the fields and the textures of the records of materials, by ascending offsets.
    std::span<const package::FieldEntry> fields() const;
    // Returns the number of shader IDs, retired ones included.
    std::uint32_t caseCount() const;
    // Returns the number of buckets of a visibility buffer: bucket 0 holds misses, bucket 1 + shader ID holds
    // hits.
    std::uint32_t bucketCount() const;

    // These spans are valid as long as the package. Cases are indexed by shader ID.
    std::span<const package::CaseEntry> cases() const;
    std::span<const package::ModuleEntry> modules() const;
    // The attributes of vertices that shaders read beside those of glTF's core, in the order of their values.
    std::span<const package::AttributeEntry> attributes() const;
    // The effects that the package has, by ascending bits. Their names are valid as long as the package.
    std::span<const package::EffectInfo> effects() const;
    // The layers that frames of the package have beside the picture, by the index of their images.
    std::span<const package::PackageLayer> layers() const;
    // Returns the bit of the effect of that name, or 0 if the package lacks it.
    package::Effect effect(std::string_view name) const;
    // Returns the number of scenes, which is at least 1.
    std::uint32_t sceneCount() const;
    // Scenes are in the order in which the compiler got them. `index` must be below sceneCount().
    PackageScene scene(std::uint32_t index) const;
    // Returns the index of the scene with this name, or no value if there is none.
    std::optional<std::uint32_t> findScene(std::string_view name) const;

    // Returns a text of the package. It is empty if `ref` is outside of the package's strings.
    std::string_view string(package::StringRef ref) const;
    // Returns the SPIR-V words of a module. The span is empty if the package lacks the module.
    std::span<const std::uint32_t> spirv(const package::ModuleKey& key) const;
    class Watch;  // finds out that `glint compile --watch` has written a new package

    // For the runtime's own sources.
    struct State;
    const State& state() const {
        return *state_;
    }

private:
    explicit Package(std::unique_ptr<State> state);
    static Result<Package> loadFrom(const PackageFiles& files);
    std::unique_ptr<State> state_;
};

// --- Detects that `glint compile --watch` has written a new package ---

namespace package {

// The stamp of a package is a file beside its folder: "room.glint.stamp" of "room.glint". It has one line: a
// decimal counter, a space and the hash of tables.bin as 16 hexadecimal digits. The compiler increments the
// counter after a package with other contents is in place, and replaces the file by a rename.
inline constexpr std::string_view kStampSuffix = ".stamp";

// Returns the stamp's file of a package's folder.
std::filesystem::path stampFile(const std::filesystem::path& folder);

// Returns the counter of the stamp in `file`, or no value if there is none.
std::optional<std::uint64_t> readStamp(const std::filesystem::path& file);

}  // namespace package

// Watches one package. It needs no Vulkan device and starts no thread.
class Package::Watch {
public:
    // Begins with the package that the folder has now: poll() returns the next one.
    explicit Watch(const std::filesystem::path& folder);

    // Returns the package if it was written since the last call, else null. Without a new package this opens
    // and reads one small file, which takes some microseconds; with one it loads the package, in the time of
    // Package::load(). Packages that were written in between are skipped.
    //
    // If the folder is just being replaced once more, loading fails; then this returns null and tries again
    // in the next calls. After kTries calls with the same stamp it returns the error, once. Errors: those of
    // Package::load().
    Result<std::shared_ptr<const Package>> poll();

    // Returns the counter of the last package that poll() returned, or of the start.
    std::uint64_t counter() const {
        return counter_;
    }

    static constexpr int kTries = 10;

private:
    std::filesystem::path folder_;
    std::filesystem::path stamp_;
    std::uint64_t counter_ = 0;
    int failures_ = 0;
};

}  // namespace glint
