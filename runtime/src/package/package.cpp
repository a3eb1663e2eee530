#include "package/package.h"

#include "context/parallel.h"

#include <glint/package.h>

#include <xxhash.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <tuple>
#include <utility>

namespace glint {

namespace {

// A larger file is not a package's table: 256 MiB hold more than a million primitives and materials.
constexpr std::uint64_t kMaxTablesBytes = std::uint64_t{256} << 20;

}  // namespace

Result<Package> Package::load(const std::filesystem::path& folder) try { return loadFrom(filesOf(folder)); }
GLINT_CATCH

Result<Package> Package::load(std::span<const package::EmbeddedFile> files) try {
    return loadFrom(filesOf(files));
}
GLINT_CATCH

Result<Package> Package::loadFrom(const PackageFiles& files) {
    GLINT_TRY(auto bytes, files.read(package::kTablesFile, "package-missing", kMaxTablesBytes));
    auto state = std::make_unique<State>();
    state->tables = std::move(bytes);
    const std::string where = files.where(package::kTablesFile);
    GLINT_TRY_DO(readTables(*state, where));
    GLINT_TRY_DO(checkTables(*state, where));
    GLINT_TRY_DO(readModules(*state, files));
    return Package(std::move(state));
}

Package::Package(std::unique_ptr<State> state) : state_(std::move(state)) {}
Package::Package(Package&&) noexcept = default;
Package& Package::operator=(Package&&) noexcept = default;
Package::~Package() = default;

bool Package::supports(package::Strategy strategy) const {
    return (state_->header.strategies & strategy) != 0;
}

bool Package::alphaTested() const {
    return alpha() != package::AlphaPolicy::Opaque;
}

package::AlphaPolicy Package::alpha() const {
    return state_->header.alpha;
}

package::ShadowThrough Package::shadowThrough() const {
    return state_->header.shadowThrough;
}

package::PackageShape Package::shape() const {
    return shapeOf(*state_);
}

package::HitRecordFormat Package::hitRecord() const {
    return state_->header.hitRecord;
}

package::SampleRecordFormat Package::sampleRecord() const {
    return state_->header.sampleRecord;
}

// Paths and emissive lights need the start of a ray when its hit is shaded. GLINT_HITS_IN_SAMPLES of
// tool/emit/sources.cpp says the same.
bool Package::hitsInSamples() const {
    return sampleRecord() == package::SampleRecordFormat::Packed && passes() == package::Passes::Frame &&
           !package::hasPaths(shape()) && emission() == nullptr;
}

bool Package::textureLevels() const {
    return state_->header.textureLevels != 0;
}

bool Package::trustTextures() const {
    return state_->header.trustTextures != 0;
}

bool Package::environmentMap() const {
    return state_->header.environmentMap != 0;
}

bool Package::positionFetch() const {
    return state_->header.positionFetch != 0;
}

package::Passes Package::passes() const {
    return state_->header.passes;
}

package::HitAnswer Package::answer() const {
    return state_->header.answer;
}

const package::Bindings& Package::bindings() const {
    return state_->header.bindings;
}

package::ShadingPrecision Package::precision() const {
    return state_->header.precision;
}

std::uint32_t Package::lightSamples() const {
    return state_->header.lightSamples;
}

bool Package::skyLight() const {
    return state_->header.skyLight != 0;
}

bool Package::sizedLights() const {
    return state_->header.sizedLights != 0;
}

bool Package::diskLights() const {
    return state_->header.diskLights != 0;
}

const package::EmissionEntry* Package::emission() const {
    return state_->emission.empty() ? nullptr : state_->emission.data();
}

const package::OpacityEntry* Package::opacity() const {
    return state_->opacity.empty() ? nullptr : state_->opacity.data();
}

std::span<const package::FieldEntry> Package::fields() const {
    return state_->fields;
}

std::vector<std::string> Package::featureNames(const package::KeyWords& features) const {
    std::vector<std::string> names;
    for (const package::FeatureEntry& entry : state_->features) {
        if (features.hasAny(entry.feature)) {
            names.emplace_back(string(entry.name));
        }
    }
    return names;
}

std::uint32_t Package::caseCount() const {
    return state_->header.caseCount;
}

std::uint32_t Package::bucketCount() const {
    return 1 + state_->header.caseCount;
}

std::span<const package::CaseEntry> Package::cases() const {
    return state_->cases;
}

std::span<const package::AttributeEntry> Package::attributes() const {
    return state_->attributes;
}

std::span<const package::EffectInfo> Package::effects() const {
    return state_->effects;
}

std::span<const package::PackageLayer> Package::layers() const {
    return state_->layers;
}

package::Effect Package::effect(std::string_view name) const {
    const auto found = std::ranges::find(state_->effects, name, &package::EffectInfo::name);
    return found == state_->effects.end() ? 0 : found->effect;
}

std::span<const package::ModuleEntry> Package::modules() const {
    return state_->modules;
}

std::uint32_t Package::sceneCount() const {
    return static_cast<std::uint32_t>(state_->scenes.size());
}

PackageScene Package::scene(std::uint32_t index) const {
    const package::SceneEntry& entry = state_->scenes[index];
    return {string(entry.name), state_->materials.part(entry.firstMaterial, entry.materialCount),
            state_->primitives.subspan(entry.firstPrimitive, entry.primitiveCount),
            state_->textures.subspan(entry.firstTexture, entry.textureCount),
            state_->samplers.subspan(entry.firstSampler, entry.samplerCount)};
}

std::optional<std::uint32_t> Package::findScene(std::string_view name) const {
    for (std::uint32_t index = 0; index < sceneCount(); ++index) {
        if (string(state_->scenes[index].name) == name) {
            return index;
        }
    }
    return std::nullopt;
}

std::string_view Package::string(package::StringRef ref) const {
    const std::uint64_t end = std::uint64_t{ref.offset} + ref.length;
    if (end > state_->strings.size()) {
        return {};
    }
    return {state_->strings.data() + ref.offset, ref.length};
}

std::span<const std::uint32_t> Package::spirv(const package::ModuleKey& key) const {
    const auto entry = std::ranges::find_if(state_->modules, [&](const package::ModuleEntry& candidate) {
        return package::ModuleKey{candidate.role, candidate.index, candidate.tracer} == key;
    });
    if (entry == state_->modules.end()) {
        return {};
    }
    const auto words = state_->spirv.find(string(entry->file));
    return words == state_->spirv.end() ? std::span<const std::uint32_t>{} : words->second;
}

const package::PrimitiveEntry* PackageScene::findPrimitive(std::uint32_t mesh,
                                                           std::uint32_t primitive) const {
    const auto key = [](const package::PrimitiveEntry& entry) {
        return std::tuple(entry.mesh, entry.primitive);
    };
    const auto found = std::ranges::lower_bound(primitives, std::tuple(mesh, primitive), std::less<>{}, key);
    const bool same = found != primitives.end() && key(*found) == std::tuple(mesh, primitive);
    return same ? &*found : nullptr;
}

namespace package {

std::filesystem::path stampFile(const std::filesystem::path& folder) {
    // "room.glint/" names the same folder as "room.glint".
    std::filesystem::path file = folder.has_filename() ? folder : folder.parent_path();
    file += kStampSuffix;
    return file;
}

std::optional<std::uint64_t> readStamp(const std::filesystem::path& file) {
    std::array<char, 64> text{};
    std::ifstream stream(file, std::ios::binary);
    stream.read(text.data(), text.size());
    const char* const end = text.data() + stream.gcount();
    std::uint64_t counter = 0;
    const auto [rest, error] = std::from_chars(text.data(), end, counter);
    if (error != std::errc() || rest == end || *rest != ' ') {
        return std::nullopt;
    }
    return counter;
}

}  // namespace package

Package::Watch::Watch(const std::filesystem::path& folder)
    : folder_(folder), stamp_(package::stampFile(folder)), counter_(package::readStamp(stamp_).value_or(0)) {}

Result<std::shared_ptr<const Package>> Package::Watch::poll() try {
    const std::optional<std::uint64_t> now = package::readStamp(stamp_);
    if (!now || *now == counter_) {
        return std::shared_ptr<const Package>();
    }
    Result<Package> package = Package::load(folder_);
    if (!package && ++failures_ < kTries) {
        return std::shared_ptr<const Package>();
    }
    failures_ = 0;
    counter_ = *now;
    if (!package) {
        return package.error();
    }
    return std::make_shared<const Package>(std::move(*package));
}
GLINT_CATCH

Status checkDevice(const Package& package, const DeviceHandles& handles) {
    if (package.positionFetch() && !handles.positionFetch) {
        return makeError(
            "position-fetch", "",
            "the package's shaders read positions from acceleration structures, which the device does "
            "not allow or was not created for",
            "create it with VK_KHR_ray_tracing_position_fetch and set DeviceHandles::positionFetch, or "
            "compile without --position-fetch");
    }
    if (package.precision() == package::ShadingPrecision::Half && !handles.shaderFloat16) {
        return makeError("half-precision", "",
                         "the package's shaders compute in 16-bit float, which the device does not allow or "
                         "was not created for",
                         "create it with VkPhysicalDeviceVulkan12Features::shaderFloat16 and set "
                         "DeviceHandles::shaderFloat16, or compile with --precision 32");
    }
    return okStatus();
}

std::uint64_t recordsHash(const Package& package, const PackageScene& scene) {
    std::uint64_t hash = 0;
    const auto add = [&](const void* data, std::size_t bytes) {
        hash = XXH3_64bits_withSeed(data, bytes, hash + bytes);
    };
    const MaterialTable& table = scene.materials;
    const std::uint32_t layout[] = {table.recordBytes, table.textureOffset, table.textureCount};
    add(layout, sizeof layout);
    add(scene.primitives.data(), scene.primitives.size_bytes());
    add(scene.textures.data(), scene.textures.size_bytes());
    add(scene.samplers.data(), scene.samplers.size_bytes());
    for (const package::AttributeEntry& attribute : package.attributes()) {
        const std::string_view name = package.string(attribute.name);
        add(name.data(), name.size());
        add(&attribute.channels, sizeof attribute.channels);
    }
    return hash;
}

Status checkRecords(const Package& package, std::uint64_t hash) {
    // A scene that began without anything has no scene in the package.
    bool known = recordsHash(package, {}) == hash;
    for (std::uint32_t scene = 0; scene < package.sceneCount() && !known; ++scene) {
        known = recordsHash(package, package.scene(scene)) == hash;
    }
    return known
               ? okStatus()
               : Status(makeError("scene-package", "",
                                  "the scene's records are those of a package with other cases or materials",
                                  "use the package that the scene was made with, or that replaced it last"));
}

}  // namespace glint
