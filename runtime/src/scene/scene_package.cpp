#include "scene/scene_package.h"

#include "context/commands.h"
#include "context/upload.h"
#include "data/materials.h"
#include "data/opacity_split.h"
#include "data/scene_checks.h"
#include "package/package.h"
#include "scene/gpu_scene_state.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <tuple>
#include <utility>

namespace glint {
namespace {

Diagnostic otherScene(std::string where, std::string what) {
    return makeError(
        "scene-package", std::move(where), std::move(what),
        "upload the scene anew with this package, or compile it from the same scene and with the "
        "same attributes and textures");
}

std::string placeOf(const package::PrimitiveEntry& entry) {
    return "mesh " + std::to_string(entry.mesh) + ", primitive " + std::to_string(entry.primitive);
}

template <typename T>
bool sameBytes(std::span<const T> a, std::span<const T> b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

std::vector<ScenePackage::Attribute> attributesOf(const Package& package) {
    std::vector<ScenePackage::Attribute> attributes;
    for (const package::AttributeEntry& entry : package.attributes()) {
        ScenePackage::Attribute attribute{std::string(package.string(entry.name)), entry.channels, {}};
        std::copy_n(entry.fallback, attribute.fallback.size(), attribute.fallback.begin());
        attributes.push_back(std::move(attribute));
    }
    return attributes;
}

std::vector<ScenePackage::Emission> emissionsOf(const Package& package, const MaterialTable& materials) {
    std::vector<ScenePackage::Emission> emissions;
    const package::EmissionEntry* const entry = package.emission();
    for (std::size_t i = 0; entry != nullptr && i < materials.size(); ++i) {
        ScenePackage::Emission emission;
        const std::uint8_t* const record = &materials.bytes[i * materials.recordBytes];
        if (entry->factor != package::EmissionEntry::kNone) {
            std::memcpy(emission.factor.data(), record + entry->factor, sizeof emission.factor);
        }
        if (entry->strength != package::EmissionEntry::kNone) {
            std::memcpy(&emission.strength, record + entry->strength, sizeof emission.strength);
        }
        if (entry->texture != package::EmissionEntry::kNone) {
            emission.texture = textureAt(materials, i, entry->texture).textureIndex;
        }
        emissions.push_back(emission);
    }
    return emissions;
}

// Compares the inputs from which the importer's vertices, the textures and the acceleration structures were
// made.
Status checkPrimitives(const GpuScene::State& scene, const Package& package, const PackageScene& known) {
    const ScenePackage& now = scene.package;
    if (known.primitives.size() != now.entries.size()) {
        return otherScene(now.scene, "the package has " + std::to_string(known.primitives.size()) +
                                         " primitives, the uploaded scene " +
                                         std::to_string(now.entries.size()));
    }
    for (std::size_t i = 0; i < now.entries.size(); ++i) {
        const package::PrimitiveEntry& before = now.entries[i];
        const package::PrimitiveEntry& after = known.primitives[i];
        if (std::tie(before.mesh, before.primitive) != std::tie(after.mesh, after.primitive)) {
            return otherScene(placeOf(before), "the package does not know this primitive");
        }
        if (before.geometryFlags != after.geometryFlags) {
            return otherScene(placeOf(before),
                              "the primitive's material is now tested for alpha, double-sided, a light or "
                              "passed by light where it was not, or the other way round");
        }
        if (now.emission && before.materialIndex != after.materialIndex) {
            return otherScene(placeOf(before),
                              "the primitive has another material, and triangles are lights");
        }
    }
    for (std::size_t i = 0; i < scene.primitives.size(); ++i) {
        const GpuPrimitive& uploaded = scene.primitives[i];
        const package::PrimitiveEntry& entry = known.primitives[now.entryOfUploaded[i]];
        const std::uint64_t key = std::uint64_t{entry.featureInputs} << 32U | entry.featureLobes;
        const bool readsDeclared = std::ranges::any_of(
            package.attributes(), [&](const auto& attribute) { return (attribute.feature & key) != 0; });
        const struct {
            const char* name;
            bool needed;
            VkDeviceAddress address;
        } attributes[] = {{"normals", (entry.featureInputs & kInputNormals) != 0, uploaded.normals},
                          {"tangents", (entry.featureInputs & kInputTangents) != 0, uploaded.tangents},
                          {"texCoords0", (entry.featureInputs & kInputTexCoord0) != 0, uploaded.texCoords0},
                          {"texCoords1", (entry.featureInputs & kInputTexCoord1) != 0, uploaded.texCoords1},
                          {"colors", (entry.featureInputs & kInputVertexColor) != 0, uploaded.colors},
                          {"attributes of packs", readsDeclared, uploaded.attributes}};
        for (const auto& [name, needed, address] : attributes) {
            if (needed && address == 0 && uploaded.triangleCount > 0) {
                return otherScene(placeOf(entry), std::string("the package's key reads ") + name +
                                                      ", which were not uploaded");
            }
        }
    }
    return okStatus();
}

// Returns whether both find the emission at the same places of records. The features that follow are for
// edits alone.
bool isReadAlike(const package::EmissionEntry& a, const package::EmissionEntry& b) {
    return std::memcmp(&a, &b, offsetof(package::EmissionEntry, read)) == 0;
}

Status checkEmission(const ScenePackage& now, const Package& package, const PackageScene& known) {
    const package::EmissionEntry* const emission = package.emission();
    if (now.emission.has_value() != (emission != nullptr)) {
        return otherScene(now.scene, "one of the packages takes emissive triangles as lights");
    }
    if (emission != nullptr &&
        (!isReadAlike(*now.emission, *emission) || now.emissions != emissionsOf(package, known.materials))) {
        return otherScene(now.scene, "a material's emission changed, and emissive triangles are lights");
    }
    if (package.lightSamples() > 0 && !now.lightTree) {
        return otherScene(now.scene, "the package chooses lights by a hierarchy, which was not built");
    }
    return okStatus();
}

// The bytes that change in the scene's records, before they are copied.
struct Changes {
    std::vector<std::uint8_t> materials;
    std::vector<ChangingMaterial> hostMaterials;
    std::vector<VkBufferCopy> geometries;  // from the end of the materials on
    std::vector<std::uint8_t> keys;
};

// The first members of a GeometryRecord, which are those that a package decides.
constexpr std::size_t kKeyBytes = offsetof(gpu::GeometryRecord, instanceIndex);
static_assert(offsetof(gpu::GeometryRecord, shaderId) == 0 && kKeyBytes == 4 * sizeof(std::uint32_t));

std::array<std::uint32_t, 4> keyOf(const package::PrimitiveEntry& entry) {
    return {entry.shaderId, entry.materialIndex, entry.featureLobes, entry.featureInputs};
}

std::span<const ChangingMaterial> hostMaterialsOf(const GpuScene::State& scene) {
    return scene.motion != nullptr ? scene.changing : scene.package.hostMaterials;
}

// Triangles that no ray tests stay so, whichever package draws the scene.
Status checkDecided(const GpuScene::State& scene, const Package& package, const PackageScene& known) {
    const ScenePackage& now = scene.package;
    std::vector<std::uint8_t> records(known.materials.bytes.begin(), known.materials.bytes.end());
    std::vector<MaterialView> views;
    for (const ChangingMaterial& material : hostMaterialsOf(scene)) {
        views.push_back({material.material, material.record});
    }
    if (now.decided.empty() || !replaceMaterials(views, known.materials, records)) {
        return okStatus();  // other checks report such materials
    }
    for (const ScenePackage::Decided& decided : now.decided) {
        const package::PrimitiveEntry& entry = known.primitives[decided.entry];
        if (package.opacity() == nullptr ||
            alphaInputs(*package.opacity(), tableWith(known.materials, records), entry) != decided.inputs) {
            return otherScene(placeOf(entry),
                              "the alpha of the primitive's material is another, and the upload has proved "
                              "which of its triangles need no test");
        }
    }
    return okStatus();
}

Result<Changes> changesOf(const GpuScene::State& scene, const PackageScene& known) {
    const ScenePackage& now = scene.package;
    Changes changes;
    changes.materials = materialsWithSizes(scene.context, known, now.texels);
    std::vector<MaterialView> views;
    for (const ChangingMaterial& material : hostMaterialsOf(scene)) {
        views.push_back({material.material, material.record});
    }
    GLINT_TRY(changes.hostMaterials, replaceMaterials(views, known.materials, changes.materials));
    for (std::size_t i = 0; i < now.entryOf.size(); ++i) {
        const auto key = keyOf(known.primitives[now.entryOf[i]]);
        if (key == keyOf(now.entries[now.entryOf[i]])) {
            continue;
        }
        changes.geometries.push_back({changes.keys.size(), i * sizeof(gpu::GeometryRecord), kKeyBytes});
        const auto* const bytes = reinterpret_cast<const std::uint8_t*>(key.data());
        changes.keys.insert(changes.keys.end(), bytes, bytes + kKeyBytes);
    }
    // Offsets of copies to storage need no alignment beyond four bytes, which records have.
    for (VkBufferCopy& copy : changes.geometries) {
        copy.srcOffset += changes.materials.size();
    }
    return changes;
}

}  // namespace

ScenePackage describePackage(const Package& package, const SceneView& scene, const SceneLayout& layout,
                             std::span<const ChangingMaterial> hostMaterials) {
    const PackageScene known = package.scene(scene.packageScene);
    ScenePackage described;
    described.scene = known.name;
    described.entries.assign(known.primitives.begin(), known.primitives.end());
    for (const PrimitiveView& view : scene.primitives) {
        const package::PrimitiveEntry* const entry = known.findPrimitive(view.mesh, view.primitive);
        described.entryOfUploaded.push_back(static_cast<std::uint32_t>(entry - known.primitives.data()));
    }
    for (const std::uint32_t primitive : layout.primitives) {
        described.entryOf.push_back(described.entryOfUploaded[primitive]);
    }
    described.textures.assign(known.textures.begin(), known.textures.end());
    for (const package::TextureEntry& texture : known.textures) {
        const ImageView& image = scene.images[texture.image];
        described.texels.push_back({static_cast<float>(image.width), static_cast<float>(image.height)});
    }
    described.samplers.assign(known.samplers.begin(), known.samplers.end());
    described.attributes = attributesOf(package);
    described.hostMaterials.assign(hostMaterials.begin(), hostMaterials.end());
    described.positionFetch = package.positionFetch();
    described.lightTree = package.lightSamples() > 0;
    if (package.emission() != nullptr) {
        described.emission = *package.emission();
        described.emissions = emissionsOf(package, known.materials);
    }
    return described;
}

Result<std::uint32_t> findScene(const GpuScene::State& scene, const Package& package) {
    const ScenePackage& now = scene.package;
    if (scene.editor != nullptr) {
        return otherScene(now.scene,
                          "the scene was uploaded to be edited, and its editor keeps the package's tables");
    }
    const std::optional<std::uint32_t> index = package.findScene(now.scene);
    if (!index) {
        return otherScene(now.scene, "the package has no scene of this name");
    }
    if (package.positionFetch() && !now.positionFetch) {
        return makeError(
            "position-fetch", "",
            "the package's shaders read positions from acceleration structures, which were built "
            "without them",
            "upload the scene anew, or compile without --position-fetch");
    }
    GLINT_TRY_DO(checkDevice(package, scene.context.handles));
    const PackageScene known = package.scene(*index);
    if (!sameBytes(known.textures, std::span<const package::TextureEntry>(now.textures)) ||
        !sameBytes(known.samplers, std::span<const package::SamplerEntry>(now.samplers))) {
        return otherScene(now.scene, "the package reads other textures or samplers");
    }
    if (attributesOf(package) != now.attributes) {
        return otherScene(now.scene, "the package's packs read other attributes of vertices");
    }
    GLINT_TRY_DO(checkPrimitives(scene, package, known));
    GLINT_TRY_DO(checkEmission(now, package, known));
    GLINT_TRY_DO(checkDecided(scene, package, known));
    for (const ChangingMaterial& material : hostMaterialsOf(scene)) {
        if (material.material >= known.materials.size() ||
            material.record.size() != known.materials.recordBytes) {
            return otherScene("material " + std::to_string(material.material),
                              "the host has given values of this material, whose record has another layout");
        }
    }
    return *index;
}

std::vector<std::uint32_t> shaderIdsIn(const GpuScene::State& scene, const PackageScene& known) {
    std::vector<std::uint32_t> ids;
    for (const std::uint32_t entry : scene.package.entryOf) {
        ids.push_back(known.primitives[entry].shaderId);
    }
    return ids;
}

Result<SceneLeftovers> recordReplacement(GpuScene::State& scene, const Package& package, std::uint32_t index,
                                         VkCommandBuffer commands) {
    const PackageScene known = package.scene(index);
    GLINT_TRY(auto changes, changesOf(scene, known));
    SceneLeftovers leftovers;
    const auto staged = std::make_shared<MemoryPool>(scene.context);
    leftovers.pools.push_back(staged);
    const VkDeviceSize materialBytes = changes.materials.size();
    GLINT_TRY(auto staging, createBuffer(scene.context, *staged, materialBytes + changes.keys.size(),
                                         VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryUse::Upload));
    std::memcpy(staging.mapped, changes.materials.data(), materialBytes);
    std::memcpy(staging.mapped + materialBytes, changes.keys.data(), changes.keys.size());
    if (scene.materials.bytes != std::max<VkDeviceSize>(materialBytes, 1)) {
        auto pool = std::make_shared<MemoryPool>(scene.context);
        GLINT_TRY(auto materials,
                  createBuffer(scene.context, *pool, materialBytes,
                               VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT));
        leftovers.buffers.push_back(std::exchange(scene.materials, std::move(materials)));
        leftovers.pools.push_back(std::exchange(scene.package.pool, std::move(pool)));
    }
    const DeviceTable& vk = scene.context.vk;
    recordDependency(scene.context, commands, kAllToAll);
    if (materialBytes > 0) {
        const VkBufferCopy whole{0, 0, materialBytes};
        vk.CmdCopyBuffer(commands, staging.handle.get(), scene.materials.handle.get(), 1, &whole);
    }
    if (!changes.geometries.empty()) {
        vk.CmdCopyBuffer(commands, staging.handle.get(), scene.geometries.handle.get(),
                         static_cast<std::uint32_t>(changes.geometries.size()), changes.geometries.data());
    }
    recordDependency(scene.context, commands, kAllToAll);
    leftovers.buffers.push_back(std::move(staging));

    scene.shaderIds = shaderIdsIn(scene, known);
    scene.package.entries.assign(known.primitives.begin(), known.primitives.end());
    scene.package.records = recordsHash(package, known);
    scene.materialLayout = known.materials.part(0, 0);
    (scene.motion != nullptr ? scene.changing : scene.package.hostMaterials) =
        std::move(changes.hostMaterials);
    return leftovers;
}

}  // namespace glint
