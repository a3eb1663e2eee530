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
#include <vector>

namespace glint {
namespace {

Diagnostic otherScene(std::string where, std::string what) {
    return makeError(
        "scene-package", std::move(where), std::move(what),
        "upload the scene anew with this package, or compile it from the same scene and with the "
        "same attributes and textures");
}

// The structures of a scene that is not edited have the alpha and the sides of materials, and its lists of
// emitters their light. To make these anew would take vertices, which such a scene does not keep.
Diagnostic needsEditable(std::string where, std::string what) {
    return makeError(
        "scene-package", std::move(where), std::move(what),
        "upload the scene with SceneView::editable, so that it keeps what such a change needs, or "
        "upload it anew with this package");
}

std::string placeOfEntry(const package::PrimitiveEntry& entry) {
    return phrase("mesh ", entry.mesh, ", primitive ", entry.primitive);
}

template <typename T>
bool sameBytes(std::span<const T> a, std::span<const T> b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size_bytes()) == 0);
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

std::vector<ScenePackage::Emission> emissionsOf(const Package& package, const PackageScene& known) {
    const MaterialTable& materials = known.materials;
    const RecordFields fields = recordFields(package, known);
    std::vector<ScenePackage::Emission> emissions;
    const package::EmissionEntry* const entry = package.emission();
    for (std::size_t i = 0; entry != nullptr && i < materials.size(); ++i) {
        ScenePackage::Emission emission;
        const std::uint8_t* const record = &materials.bytes[i * materials.recordBytes];
        const std::uint32_t model = fields.modelOf(static_cast<std::uint32_t>(i));
        if (fields.hasAt(entry->factor, model)) {
            std::memcpy(emission.factor.data(), record + entry->factor, sizeof emission.factor);
        }
        if (fields.hasAt(entry->strength, model)) {
            std::memcpy(&emission.strength, record + entry->strength, sizeof emission.strength);
        }
        if (entry->texture != package::EmissionEntry::kNone &&
            fields.hasAt(placeOfTexture(materials, 0, entry->texture), model)) {
            emission.texture = textureAt(materials, i, entry->texture).textureIndex;
        }
        emissions.push_back(emission);
    }
    return emissions;
}

// Takes what follows from the package alone.
void takeTables(const Package& package, const PackageScene& known, ScenePackage& described) {
    described.entries.assign(known.primitives.begin(), known.primitives.end());
    described.fields = recordFields(package, known);
    described.emission.reset();
    if (package.emission() != nullptr) {
        described.emission = *package.emission();
    }
    described.emissions = emissionsOf(package, known);
}

// Checks that the attributes that the package's key reads were uploaded.
Status checkAttributes(const GpuPrimitive& uploaded, const Package& package,
                       const package::PrimitiveEntry& entry) {
    const bool readsDeclared = std::ranges::any_of(
        package.attributes(), [&](const auto& attribute) { return entry.key.hasAny(attribute.feature); });
    const auto reads = [&](package::Role role) { return package.state().hasFeature(entry.key, role); };
    const struct {
        const char* name;
        bool needed;
        VkDeviceAddress address;
    } attributes[] = {{"normals", reads(package::Role::Normals), uploaded.normals},
                      {"tangents", reads(package::Role::Tangents), uploaded.tangents},
                      {"texCoords0", reads(package::Role::TexCoord0), uploaded.texCoords0},
                      {"texCoords1", reads(package::Role::TexCoord1), uploaded.texCoords1},
                      {"colors", reads(package::Role::VertexColor), uploaded.colors},
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
        return otherScene(now.scene, phrase("the package has ", known.primitives.size(),
                                            " primitives, the uploaded scene ", now.entries.size()));
    }
    for (std::size_t i = 0; i < now.entries.size(); ++i) {
        const package::PrimitiveEntry& before = now.entries[i];
        const package::PrimitiveEntry& after = known.primitives[i];
        if (std::tie(before.mesh, before.primitive) != std::tie(after.mesh, after.primitive)) {
            return otherScene(placeOfEntry(before), "the package does not know this primitive");
        }
        // The records and the TLAS of a scene that is edited have all else.
        if (scene.store->editable) {
            continue;
        }
        if (before.geometryFlags != after.geometryFlags) {
            return needsEditable(placeOfEntry(before),
                                 "the primitive's material is now tested for alpha, double-sided, a light or "
                                 "passed by light where it was not, or the other way round");
        }
        if (now.emission && before.materialIndex != after.materialIndex) {
            return needsEditable(placeOfEntry(before),
                                 "the primitive has another material, and triangles are lights");
        }
    }
    Status status = okStatus();
    scene.store->meshes.forEach([&](MeshHandle /*handle*/, const StoredMesh& mesh) {
        for (const StoredPrimitive& primitive : mesh.primitives) {
            if (status && primitive.entryIndex != StoredPrimitive::kNoEntry) {
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

Status checkEmission(const GpuScene::State& scene, const Package& package, const PackageScene& known) {
    const ScenePackage& now = scene.package;
    const package::EmissionEntry* const emission = package.emission();
    if (scene.store->editable) {
        return okStatus();
    }
    if (now.emission.has_value() != (emission != nullptr)) {
        return needsEditable(now.scene, "one of the packages takes emissive triangles as lights");
    }
    if (emission != nullptr &&
        (!isReadAlike(*now.emission, *emission) || now.emissions != emissionsOf(package, known))) {
        return needsEditable(now.scene, "a material's emission changed, and emissive triangles are lights");
    }
    return okStatus();
}

// Writes the values that the host has given into records of the package. Returns these materials. Error
// "scene-package".
Result<std::vector<ChangingMaterial>> keepHostValues(const GpuScene::State& scene, const Package& package,
                                                     const PackageScene& known,
                                                     std::span<std::uint8_t> records) {
    const RecordFields fields = recordFields(package, known);
    std::vector<std::vector<std::uint8_t>> values;
    std::vector<MaterialView> views;
    for (const ChangingMaterial& material : scene.changing) {
        if (material.material >= known.materials.size()) {
            return otherScene("material " + std::to_string(material.material),
                              "the host has given values of this material, which the package lacks");
        }
        const std::span<const std::uint8_t> given = known.materials.part(material.material, 1).bytes;
        std::vector<std::uint8_t>& record = values.emplace_back(given.begin(), given.end());
        carryFields(scene.package.fields, scene.package.fields.modelOf(material.material), material.record,
                    fields, fields.modelOf(material.material), record);
        views.push_back({material.material, record});
    }
    return replaceMaterials(views, known.materials, records);
}

// Triangles that no ray tests stay so, whichever package draws the scene.
Status checkDecided(const GpuScene::State& scene, const Package& package, const PackageScene& known) {
    const ScenePackage& now = scene.package;
    std::vector<std::uint8_t> records(known.materials.bytes.begin(), known.materials.bytes.end());
    GLINT_TRY([[maybe_unused]] const auto kept, keepHostValues(scene, package, known, records));
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

// Writes the geometry records that differ from what the package says.
void writeEntries(SceneStore& store) {
    const auto isSame = [](const gpu::GeometryRecord& record, const package::PrimitiveEntry& entry) {
        return record.shaderId == entry.shaderId && record.materialIndex == entry.materialIndex &&
               keyOf(record) == entry.key;
    };
    store.instanceSlots.forEach([&](InstanceHandle handle, const StoredInstance& instance) {
        const StoredMesh& mesh = *store.meshes.find(instance.mesh);
        bool changes = instance.form != nullptr;  // the package may ask for another
        forEachGeometry(
            mesh, instance,
            [&](const TriangleRange& range, const StoredPrimitive& /*primitive*/, std::uint32_t geometry) {
                const package::PrimitiveEntry entry = entryOf(store, instance, range.primitive);
                auto record = store.geometries.read<gpu::GeometryRecord>(geometry);
                if (store.editable) {
                    const bool isSeenAlike = (record.flags & kEntryFlags) == entry.geometryFlags;
                    changes = changes || !isSeenAlike || !isSame(record, entry);
                } else if (!isSame(record, entry)) {
                    takeEntry(entry, record);
                    store.geometries.write(geometry, record);
                }
            });
        if (changes) {
            writeGeometries(store, handle, instance);
        }
    });
}

PackageScene sceneOf(const Package& package, std::uint32_t index) {
    return index == kNoPackageScene ? PackageScene{} : package.scene(index);
}

// The scene's content by another package. Exchanging it twice changes nothing.
struct OtherPackage {
    ScenePackage package;
    std::uint64_t records = 0;
    std::vector<std::uint32_t> shaderIds;
    MaterialTable layout;  // without records
    std::vector<ChangingMaterial> changing{};
    std::optional<package::EmissionEntry> emission{};
    std::optional<EditedTables> edited{};    // of a scene that is edited
    std::optional<RecordStore> materials{};  // of a sealed one
};

void exchange(SceneStore& store, OtherPackage& other) {
    GpuScene::State& scene = store.scene;
    std::swap(scene.package, other.package);
    std::swap(scene.records, other.records);
    std::swap(scene.shaderIds, other.shaderIds);
    std::swap(scene.materialLayout, other.layout);
    std::swap(scene.changing, other.changing);
    std::swap(store.emission, other.emission);
    if (!store.emission && other.emission) {
        forgetEmitters(store);
    }
    if (other.edited) {
        exchangeTables(store, *other.edited);
        store.decidedMaterials.clear();
        store.emittersDirty = store.emittersDirty || store.emission.has_value();
    } else {
        std::swap<RecordStore>(store.materials, *other.materials);
        store.meshes.forEach([&](MeshHandle /*handle*/, StoredMesh& mesh) {
            for (StoredPrimitive& primitive : mesh.primitives) {
                primitive.entry = scene.package.entries[primitive.entryIndex];
            }
        });
    }
    writeEntries(store);
}

std::vector<std::uint32_t> shaderIdsIn(const SceneStore& store, const PackageScene& known) {
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

Result<OtherPackage> otherPackage(const GpuScene::State& scene, const std::shared_ptr<const Package>& package,
                                  std::uint32_t index) {
    const SceneStore& store = *scene.store;
    const PackageScene known = sceneOf(*package, index);
    OtherPackage other{
        scene.package, recordsHash(*package, known), {}, package->scene(0).materials.part(0, 0)};
    takeTables(*package, known, other.package);
    std::vector<std::uint8_t> materials = materialsWithSizes(scene.context, known, scene.package.texels);
    GLINT_TRY(other.changing, keepHostValues(scene, *package, known, materials));
    if (package->emission() != nullptr) {
        other.emission = *package->emission();
    }
    if (store.editable) {
        GLINT_TRY(other.edited, editedTables(store, package, known));
        other.shaderIds = other.edited->cases.shaderIds();
        return other;
    }
    other.shaderIds = shaderIdsIn(store, known);
    other.materials = store.materials;
    if (other.layout.recordBytes != other.materials->stride()) {
        other.materials->reset(other.layout.recordBytes);
    }
    other.materials->replaceBytes(materials);
    return other;
}

}  // namespace

ScenePackage describePackage(const Package& package, const PackageScene& known, const SceneView& scene) {
    ScenePackage described;
    described.isEmpty = scene.packageScene == kNoPackageScene;
    described.scene = known.name;
    described.textures.assign(known.textures.begin(), known.textures.end());
    for (const package::TextureEntry& texture : known.textures) {
        const ImageView& image = scene.images[texture.image];
        described.texels.push_back({static_cast<float>(image.width), static_cast<float>(image.height)});
    }
    described.samplers.assign(known.samplers.begin(), known.samplers.end());
    described.attributes = attributesOf(package);
    described.positionFetch = package.positionFetch();
    takeTables(package, known, described);
    return described;
}

Result<PackageFit> GpuScene::State::fit(const std::shared_ptr<const Package>& other) const {
    const ScenePackage& now = package;
    const std::optional<std::uint32_t> index =
        now.isEmpty ? std::optional(kNoPackageScene) : other->findScene(now.scene);
    if (!index) {
        return otherScene(now.scene, "the package has no scene of this name");
    }
    if (other->positionFetch() && !now.positionFetch) {
        return makeError(
            "position-fetch", "",
            "the package's shaders read positions from acceleration structures, which were built "
            "without them",
            "upload the scene anew, or compile without --position-fetch");
    }
    GLINT_TRY_DO(checkDevice(*other, context.handles));
    const PackageScene known = sceneOf(*other, *index);
    if (!store->editable &&
        (!sameBytes(known.textures, std::span<const package::TextureEntry>(now.textures)) ||
         !sameBytes(known.samplers, std::span<const package::SamplerEntry>(now.samplers)))) {
        return otherScene(now.scene, "the package reads other textures or samplers");
    }
    if (attributesOf(*other) != now.attributes) {
        return otherScene(now.scene, "the package's packs read other attributes of vertices");
    }
    std::vector<LightView> shining;
    for (const LightHandle light : store->lightOrder) {
        shining.push_back(store->lightSlots.at(light.index));
    }
    GLINT_TRY_DO(checkDisks(other->diskLights(), shining));
    GLINT_TRY_DO(checkPrimitives(*this, *other, known));
    GLINT_TRY_DO(checkEmission(*this, *other, known));
    GLINT_TRY_DO(checkDecided(*this, *other, known));
    GLINT_TRY(auto content, otherPackage(*this, other, *index));
    PackageFit fit{*index, content.records, std::move(content.shaderIds)};
    if (content.edited) {
        fit.missing = std::move(content.edited->report.missing);
    }
    return fit;
}

Result<RetiredLot> GpuScene::State::recordReplacement(const std::shared_ptr<const Package>& other,
                                                      std::uint32_t index, VkCommandBuffer commands) {
    if (store->editable) {
        for (const package::SamplerEntry& sampler : sceneOf(*other, index).samplers) {
            GLINT_TRY_DO(ensureSampler(*store, sampler));
        }
    }
    GLINT_TRY(auto content, otherPackage(*this, other, index));
    exchange(*store, content);
    RetiredLot leftovers;
    if (Status status = recordChanges(*store, commands, store->lastFrame, {}, &leftovers); !status) {
        exchange(*store, content);
        return status.error();
    }
    return leftovers;
}

}  // namespace glint
