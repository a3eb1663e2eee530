// Another package of a scene that is edited: its tables for what was uploaded, and for what edits have made.
#include "data/materials.h"
#include "package/package.h"
#include "scene/scene_store.h"

#include <algorithm>
#include <utility>

namespace glint {
namespace {

constexpr const char* kCompileFor =
    "compile the package for the scene as it is now, or upload the scene anew";

Diagnostic otherContent(std::string where, std::string what) {
    return makeError("scene-package", std::move(where), std::move(what), kCompileFor);
}

// The features of one package in the keys of another, by their names.
class FeatureMap {
public:
    FeatureMap(const Package& from, const Package& to) : from_(from), to_(to) {}

    // Error "scene-edit-feature".
    Result<package::KeyWords> find(const package::KeyWords& features, const std::string& where) const {
        package::KeyWords found;
        std::string unknown;
        for (const package::FeatureEntry& feature : from_.state().features) {
            if (!features.hasAny(feature.feature)) {
                continue;
            }
            const std::string_view name = from_.string(feature.name);
            const auto& known = to_.state().features;
            const auto same = std::ranges::find_if(
                known, [&](const package::FeatureEntry& other) { return to_.string(other.name) == name; });
            if (same == known.end()) {
                unknown += (unknown.empty() ? "" : ", ") + std::string(name);
                continue;
            }
            found |= same->feature;
        }
        if (!unknown.empty()) {
            return makeError("scene-edit-feature", where,
                             "the package does not know these features: " + unknown,
                             "compile the package with the packs of the one before");
        }
        return found;
    }

private:
    const Package& from_;
    const Package& to_;
};

class TableMaker {
public:
    TableMaker(const SceneStore& store, const std::shared_ptr<const Package>& package,
               const PackageScene& known)
        : store_(store),
          package_(*package),
          known_(known),
          layout_(package->scene(0).materials.part(0, 0)),
          fields_(recordFields(*package, known)),
          features_(store.cases->package(), *package),
          tables_{CaseTable(package),
                  store.materialSlots,
                  {},
                  store.firstMaterials,
                  recordsLike(store),
                  {},
                  {},
                  {}} {}

    Result<EditedTables> make() {
        if (package_.trustTextures() && store_.otherTexels) {
            return makeError("texture-trusted", "",
                             "an edit has replaced a texture, and the package relies on what textures hold",
                             "compile it with --no-trust-textures, or with --fallback");
        }
        GLINT_TRY_DO(findTextures());
        addMaterials();
        GLINT_TRY_DO(fillMaterials());
        addKeys();
        moveMeshes();
        countTextures();
        GLINT_TRY_DO(checkShading());
        return std::move(tables_);
    }

private:
    // A store of records of the new size, with the old ones if that is the same.
    RecordStore recordsLike(const SceneStore& store) const {
        if (layout_.recordBytes == store.materials.stride()) {
            return store.materials;
        }
        RecordStore records(layout_.recordBytes);
        records.firstCapacity = store.materials.firstCapacity;
        return records;
    }

    // Finds the package's textures among those that were uploaded, and checks that there is room for its
    // samplers.
    Status findTextures() {
        const std::vector<package::TextureEntry>& uploaded = store_.scene.package.textures;
        for (const package::TextureEntry& entry : known_.textures) {
            const auto place = std::ranges::find_if(uploaded, [&](const package::TextureEntry& other) {
                return other.image == entry.image && other.srgb == entry.srgb &&
                       other.dimension == entry.dimension;
            });
            if (place == uploaded.end()) {
                return otherContent(placeOf("image", entry.image),
                                    "the package reads it as a texture that was not uploaded");
            }
            tables_.firstTextures.push_back(
                store_.uploadedTextures[static_cast<std::size_t>(place - uploaded.begin())]);
        }
        std::size_t samplers = store_.samplers.size();
        for (const package::SamplerEntry& entry : known_.samplers) {
            samplers += findSampler(store_, entry) == store_.samplers.size() ? 1 : 0;
        }
        return samplers <= store_.scene.samplerRoom ? okStatus() : Status(noRoomForSampler(store_));
    }

    // The package may have more materials than the one before, and give primitives some that edits have
    // removed.
    void addMaterials() {
        while (tables_.firstMaterials.size() < known_.materials.size()) {
            tables_.firstMaterials.push_back(tables_.materialSlots.add({}));
        }
        store_.meshes.forEach([&](MeshHandle /*handle*/, const StoredMesh& mesh) {
            for (const StoredPrimitive& primitive : mesh.primitives) {
                const std::optional<std::uint32_t> number = materialOfPackage(primitive);
                if (number && tables_.materialSlots.find(tables_.firstMaterials[*number]) == nullptr) {
                    tables_.firstMaterials[*number] = tables_.materialSlots.add({});
                }
            }
        });
    }

    // Returns the number of the primitive's material in the package, unless an edit has given it another one.
    std::optional<std::uint32_t> materialOfPackage(const StoredPrimitive& primitive) const {
        if (primitive.entryIndex == StoredPrimitive::kNoEntry) {
            return std::nullopt;
        }
        const std::uint32_t before = store_.scene.package.entries[primitive.entryIndex].materialIndex;
        return primitive.material == store_.firstMaterials[before]
                   ? std::optional(known_.primitives[primitive.entryIndex].materialIndex)
                   : std::nullopt;
    }

    Status fillMaterials() {
        std::map<std::uint32_t, std::uint32_t> numbers;  // in the package, by index
        for (std::uint32_t i = 0; i < known_.materials.size(); ++i) {
            const MaterialHandle handle = tables_.firstMaterials[i];
            if (tables_.materialSlots.find(handle) != nullptr) {
                numbers.emplace(handle.index, i);
            }
        }
        Status status = okStatus();
        tables_.materialSlots.forEach([&](MaterialHandle handle, StoredMaterial& material) {
            const auto number = numbers.find(handle.index);
            if (!status) {
                return;
            }
            status = number == numbers.end() || material.isOwn
                         ? carryMaterial(handle.index, material)
                         : takeMaterial(handle.index, number->second, material);
        });
        return status;
    }

    // The fields that the old record has too. The models are those of the material in each package.
    void carry(std::uint32_t index, std::uint32_t before, std::uint32_t after,
               std::span<std::uint8_t> record) const {
        if (store_.materialSlots.has(index)) {
            carryFields(store_.scene.package.fields, before, store_.materials.at(index), fields_, after,
                        record);
        }
    }

    // An edit has added or replaced the material: it stays as it is.
    Status carryMaterial(std::uint32_t index, StoredMaterial& material) {
        const std::string where = placeOf("material", index);
        const auto modelOf = [&] { return material.keys.empty() ? 0 : material.keys.front().features.model; };
        const std::uint32_t modelBefore = modelOf();
        for (SceneEditor::MaterialKey& key : material.keys) {
            GLINT_TRY(key.features, features_.find(key.features, where));
            GLINT_TRY(key.hitFeatures, features_.find(key.hitFeatures, where));
            GLINT_TRY_DO(tables_.cases.checkAttributes(key, where));
        }
        std::vector<SceneEditor::TextureUse> uses;
        for (SceneEditor::TextureUse use : material.textures) {
            if (const std::optional<std::uint32_t> slot = slotOf(use.slot, modelBefore, modelOf())) {
                use.slot = *slot;
                uses.push_back(use);
            }
        }
        material.textures = std::move(uses);
        std::vector<std::uint8_t> record(layout_.recordBytes);
        carry(index, modelBefore, modelOf(), record);
        settleTextures(store_, layout_, material.textures, record);
        write(index, record);
        return okStatus();
    }

    // The material is the package's, apart from the values that it has been given.
    Status takeMaterial(std::uint32_t index, std::uint32_t number, StoredMaterial& material) {
        material.textures = usesOf(known_, tables_.firstTextures, number);
        for (const SceneEditor::TextureUse& use : material.textures) {
            if (store_.textures.find(use.texture) == nullptr) {
                return otherContent(placeOf("material", index), "an edit has removed a texture of it");
            }
        }
        const std::span<const std::uint8_t> given = known_.materials.part(number, 1).bytes;
        std::vector<std::uint8_t> record(given.begin(), given.end());
        if (material.hasOwnValues) {
            std::vector<std::uint8_t> values = record;
            carry(index, store_.scene.package.fields.modelOf(number), fields_.modelOf(number), values);
            takeValues(values, layout_, record);
        }
        settleTextures(store_, layout_, material.textures, record);
        write(index, record);
        material.keys.clear();
        return okStatus();
    }

    void write(std::uint32_t index, std::span<const std::uint8_t> record) {
        RecordStore& records = tables_.materials;
        if (index >= records.count() || !std::ranges::equal(records.at(index), record)) {
            records.writeBytes(index, record);
        }
    }

    // Returns the place in the new records of a texture of the old ones, if they have it.
    std::optional<std::uint32_t> slotOf(std::uint32_t slot, std::uint32_t modelBefore,
                                        std::uint32_t model) const {
        const MaterialTable& before = store_.scene.materialLayout;
        const auto offset =
            static_cast<std::uint32_t>(before.textureOffset + slot * sizeof(gpu::TextureRecord));
        const std::vector<RecordField>& fields = store_.scene.package.fields.list;
        const auto old = std::ranges::find_if(fields, [&](const RecordField& field) {
            return field.offset == offset && field.model == modelBefore;
        });
        const RecordField* const field = old == fields.end() ? nullptr : fields_.find(old->name, model);
        if (field == nullptr || field->offset < layout_.textureOffset) {
            return std::nullopt;
        }
        return static_cast<std::uint32_t>((field->offset - layout_.textureOffset) /
                                          sizeof(gpu::TextureRecord));
    }

    // Materials of the package have the keys of its primitives.
    void addKeys() {
        for (const auto& [entry, attributes] : store_.firstAttributes) {
            const MaterialHandle handle = tables_.firstMaterials[known_.primitives[entry].materialIndex];
            StoredMaterial* const material = tables_.materialSlots.find(handle);
            if (material != nullptr && !material->isOwn) {
                addKey(*material, known_.primitives[entry], attributes);
            }
        }
    }

    // Gives primitives the material that the package says.
    void moveMeshes() {
        store_.meshes.forEach([&](MeshHandle handle, const StoredMesh& mesh) {
            std::vector<MaterialHandle> materials;
            for (const StoredPrimitive& primitive : mesh.primitives) {
                const std::optional<std::uint32_t> number = materialOfPackage(primitive);
                materials.push_back(number ? tables_.firstMaterials[*number] : primitive.material);
                countUse(tables_.materialSlots, primitive.material, &StoredMaterial::meshes, handle.index,
                         false);
                countUse(tables_.materialSlots, materials.back(), &StoredMaterial::meshes, handle.index,
                         true);
            }
            if (!mesh.primitives.empty()) {
                tables_.meshMaterials.emplace(handle.index, std::move(materials));
            }
        });
    }

    void countTextures() {
        tables_.textureUsers.resize(store_.textures.end());
        tables_.materialSlots.forEach([&](MaterialHandle handle, const StoredMaterial& material) {
            for (const SceneEditor::TextureUse& use : material.textures) {
                countUse(tables_.textureUsers[use.texture.index], handle.index, true);
            }
        });
    }

    Status checkUse(MaterialHandle handle, AttributeMask attributes) {
        const StoredMaterial& material = *tables_.materialSlots.find(handle);
        GLINT_TRY(const auto shading,
                  shadingBy(tables_.cases, material.keys, attributes, placeOf("material", handle.index)));
        addTo(tables_.report, tables_.cases, handle, shading);
        return okStatus();
    }

    // Checks that there is a shader for everything that may be seen.
    Status checkShading() {
        Status status = okStatus();
        store_.meshes.forEach([&](MeshHandle handle, const StoredMesh& mesh) {
            for (std::size_t i = 0; i < mesh.primitives.size() && status; ++i) {
                status = checkUse(tables_.meshMaterials.at(handle.index)[i], mesh.primitives[i].attributes);
            }
        });
        store_.instanceSlots.forEach([&](InstanceHandle /*handle*/, const StoredInstance& instance) {
            for (std::size_t i = 0; i < instance.materials.size() && status; ++i) {
                if (instance.materials[i].generation != 0) {
                    const StoredMesh& mesh = *store_.meshes.find(instance.mesh);
                    status = checkUse(instance.materials[i], mesh.primitives[i].attributes);
                }
            }
        });
        return status;
    }

    const SceneStore& store_;
    const Package& package_;
    const PackageScene& known_;
    MaterialTable layout_;
    RecordFields fields_;
    FeatureMap features_;
    EditedTables tables_;
};

}  // namespace

void addKey(StoredMaterial& material, const package::PrimitiveEntry& entry, AttributeMask attributes) {
    if (std::ranges::find(material.keys, attributes, &SceneEditor::MaterialKey::attributes) ==
        material.keys.end()) {
        material.keys.push_back({attributes, entry.key, entry.key, entry.geometryFlags});
    }
}

Result<EditedTables> editedTables(const SceneStore& store, const std::shared_ptr<const Package>& package,
                                  const PackageScene& known) {
    return TableMaker(store, package, known).make();
}

void exchangeTables(SceneStore& store, EditedTables& tables) {
    std::swap(*store.cases, tables.cases);
    std::swap(store.materialSlots, tables.materialSlots);
    std::swap(store.firstTextures, tables.firstTextures);
    std::swap(store.firstMaterials, tables.firstMaterials);
    std::swap<RecordStore>(store.materials, tables.materials);
    for (auto& [mesh, materials] : tables.meshMaterials) {
        for (std::size_t i = 0; i < materials.size(); ++i) {
            std::swap(store.meshes.at(mesh).primitives[i].material, materials[i]);
        }
    }
    store.textures.forEach([&](TextureHandle handle, StoredTexture& texture) {
        std::swap(texture.materials, tables.textureUsers[handle.index]);
    });
}

}  // namespace glint
