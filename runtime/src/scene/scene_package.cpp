// ScenePackage: what the upload has taken of a package, and another package in its place.
#include "data/materials.h"
#include "data/opacity_split.h"
#include "data/scene_checks.h"
#include "package/package.h"
#include "scene/scene_store.h"

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

std::string placeOfEntry(const package::PrimitiveEntry& entry) {
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

// Checks that the attributes that the package's key reads were uploaded.
Status checkAttributes(const GpuPrimitive& uploaded, const Package& package,
                       const package::PrimitiveEntry& entry) {
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
            return otherScene(placeOfEntry(entry),
                              std::string("the package's key reads ") + name + ", which were not uploaded");
        }
    }
    return okStatus();
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
            return otherScene(placeOfEntry(before), "the package does not know this primitive");
        }
        if (before.geometryFlags != after.geometryFlags) {
            return otherScene(placeOfEntry(before),
                              "the primitive's material is now tested for alpha, double-sided, a light or "
                              "passed by light where it was not, or the other way round");
        }
        if (now.emission && before.materialIndex != after.materialIndex) {
            return otherScene(placeOfEntry(before),
                              "the primitive has another material, and triangles are lights");
        }
    }
    Status status = okStatus();
    scene.store->meshes.forEach([&](MeshHandle /*handle*/, const StoredMesh& mesh) {
        for (const StoredPrimitive& primitive : mesh.primitives) {
            if (status) {
                status = checkAttributes(primitive.device, package, known.primitives[primitive.entryIndex]);
            }
        }
    });
    return status;
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

// The host's values of materials, as views.
std::vector<MaterialView> hostMaterialsOf(const GpuScene::State& scene) {
    std::vector<MaterialView> views;
    for (const ChangingMaterial& material : scene.changing) {
        views.push_back({material.material, material.record});
    }
    return views;
}

// Triangles that no ray tests stay so, whichever package draws the scene.
Status checkDecided(const GpuScene::State& scene, const Package& package, const PackageScene& known) {
    const ScenePackage& now = scene.package;
    std::vector<std::uint8_t> records(known.materials.bytes.begin(), known.materials.bytes.end());
    if (now.decided.empty() || !replaceMaterials(hostMaterialsOf(scene), known.materials, records)) {
        return okStatus();  // other checks report such materials
    }
    for (const ScenePackage::Decided& decided : now.decided) {
        const package::PrimitiveEntry& entry = known.primitives[decided.entry];
        if (package.opacity() == nullptr ||
            alphaInputs(*package.opacity(), tableWith(known.materials, records), entry) != decided.inputs) {
            return otherScene(placeOfEntry(entry),
                              "the alpha of the primitive's material is another, and the upload has proved "
                              "which of its triangles need no test");
        }
    }
    return okStatus();
}

// Writes the fields of geometry records that a package decides.
void writeEntries(SceneStore& store, const PackageScene& known) {
    store.meshes.forEach([&](MeshHandle /*handle*/, StoredMesh& mesh) {
        for (StoredPrimitive& primitive : mesh.primitives) {
            primitive.entry = known.primitives[primitive.entryIndex];
        }
        for (const std::uint32_t instance : mesh.instances) {
            forEachGeometry(
                mesh, store.instanceSlots.at(instance),
                [&](const TriangleRange&, const StoredPrimitive& primitive, std::uint32_t geometry) {
                    const package::PrimitiveEntry& entry = primitive.entry;
                    auto record = store.geometries.read<gpu::GeometryRecord>(geometry);
                    const auto keyOf = [](const auto& from) {
                        return std::tie(from.shaderId, from.materialIndex, from.featureLobes,
                                        from.featureInputs);
                    };
                    if (keyOf(record) != keyOf(entry)) {
                        record.shaderId = entry.shaderId;
                        record.materialIndex = entry.materialIndex;
                        record.featureLobes = entry.featureLobes;
                        record.featureInputs = entry.featureInputs;
                        store.geometries.write(geometry, record);
                    }
                });
        }
    });
}

}  // namespace

ScenePackage describePackage(const Package& package, const SceneView& scene) {
    const PackageScene known = package.scene(scene.packageScene);
    ScenePackage described;
    described.scene = known.name;
    described.entries.assign(known.primitives.begin(), known.primitives.end());
    described.textures.assign(known.textures.begin(), known.textures.end());
    for (const package::TextureEntry& texture : known.textures) {
        const ImageView& image = scene.images[texture.image];
        described.texels.push_back({static_cast<float>(image.width), static_cast<float>(image.height)});
    }
    described.samplers.assign(known.samplers.begin(), known.samplers.end());
    described.attributes = attributesOf(package);
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
    for (const ChangingMaterial& material : scene.changing) {
        if (material.material >= known.materials.size() ||
            material.record.size() != known.materials.recordBytes) {
            return otherScene("material " + std::to_string(material.material),
                              "the host has given values of this material, whose record has another layout");
        }
    }
    return *index;
}

std::vector<std::uint32_t> shaderIdsIn(const GpuScene::State& scene, const PackageScene& known) {
    const SceneStore& store = *scene.store;
    std::vector<std::uint32_t> ids(store.geometries.count());
    store.meshes.forEach([&](MeshHandle /*handle*/, const StoredMesh& mesh) {
        for (const std::uint32_t instance : mesh.instances) {
            forEachGeometry(
                mesh, store.instanceSlots.at(instance),
                [&](const TriangleRange&, const StoredPrimitive& primitive, std::uint32_t geometry) {
                    ids[geometry] = known.primitives[primitive.entryIndex].shaderId;
                });
        }
    });
    return ids;
}

Result<RetiredLot> recordReplacement(GpuScene::State& scene, const Package& package, std::uint32_t index,
                                     VkCommandBuffer commands) {
    const PackageScene known = package.scene(index);
    const ScenePackage& now = scene.package;
    SceneStore& store = *scene.store;
    std::vector<std::uint8_t> materials = materialsWithSizes(scene.context, known, now.texels);
    GLINT_TRY(auto changing, replaceMaterials(hostMaterialsOf(scene), known.materials, materials));
    const RecordStore materialsBefore = store.materials;
    const RecordStore geometriesBefore = store.geometries;
    if (known.materials.recordBytes != store.materials.stride()) {
        store.materials.reset(known.materials.recordBytes);
    }
    store.materials.replaceBytes(materials);
    writeEntries(store, known);
    RetiredLot leftovers;
    if (Status status = recordChanges(store, commands, store.lastFrame, {}, &leftovers); !status) {
        store.materials = materialsBefore;
        store.geometries = geometriesBefore;
        PackageScene before = known;
        before.primitives = now.entries;
        writeEntries(store, before);
        return status.error();
    }
    leftovers.keep(scene.sharedPool);
    scene.shaderIds = shaderIdsIn(scene, known);
    scene.package.entries.assign(known.primitives.begin(), known.primitives.end());
    scene.package.records = recordsHash(package, known);
    scene.materialLayout = known.materials.part(0, 0);
    scene.changing = std::move(changing);
    return leftovers;
}

}  // namespace glint
