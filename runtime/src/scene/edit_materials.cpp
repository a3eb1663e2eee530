// SceneEditor: textures and materials.
#include "context/parallel.h"
#include "data/materials.h"
#include "data/scene_checks.h"
#include "package/package.h"
#include "scene/scene_store.h"
#include "scene/texture_stream.h"

#include <algorithm>
#include <cstring>
#include <set>
#include <span>
#include <utility>

namespace glint {
namespace {

bool isSame(const package::SamplerEntry& a, const package::SamplerEntry& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

bool isKnown(const package::SamplerEntry& entry) {
    return entry.wrapU <= 2 && entry.wrapV <= 2 && entry.magnification <= 1 && entry.minification <= 1 &&
           entry.mip <= 1 && entry.mipmapped <= 1;
}

Diagnostic badValue(const std::string& where, std::string message, const char* hint) {
    return makeError("scene-edit-value", where, std::move(message), hint);
}

Status checkUse(const SceneStore& store, const SceneEditor::TextureUse& use, const std::string& where) {
    if (store.textures.find(use.texture) == nullptr) {
        return unknownHandle("texture");
    }
    if (use.slot >= store.scene.materialLayout.textureCount || use.texCoord > 1 || !isKnown(use.sampler)) {
        return badValue(where,
                        "a texture has a slot that records lack, a UV set above 1 or an unknown sampler",
                        "use the slots of the package's records");
    }
    return okStatus();
}

// Checks that textures have the dimensions of their slots in records of the key's model.
Status checkDimensions(const SceneStore& store, std::span<const SceneEditor::TextureUse> uses,
                       const SceneEditor::MaterialKey& key, const std::string& where) {
    for (const SceneEditor::TextureUse& use : uses) {
        const std::size_t place = placeOfTexture(store.scene.materialLayout, 0, use.slot);
        const RecordField* const field = store.scene.package.fields.findAt(place, key.features.model);
        if (field != nullptr) {
            GLINT_TRY_DO(checkDimension(store.textures.find(use.texture)->dimension,
                                        static_cast<package::TextureEntry::Dimension>(field->type), where));
        }
    }
    return okStatus();
}

// Checks a source on its own, without the scene.
Status checkSource(const SceneStore& store, const SceneEditor::MaterialSource& source,
                   const std::string& where) {
    if (source.record.size() != store.scene.materialLayout.recordBytes) {
        return badValue(where,
                        phrase("the record has ", source.record.size(), " bytes, those of the package have ",
                               store.scene.materialLayout.recordBytes),
                        "make the record in the package's layout");
    }
    for (std::size_t i = 0; i < source.textures.size(); ++i) {
        const SceneEditor::TextureUse& use = source.textures[i];
        GLINT_TRY_DO(checkUse(store, use, where));
        const auto earlier = std::span(source.textures).first(i);
        if (std::ranges::find(earlier, use.slot, &SceneEditor::TextureUse::slot) != earlier.end()) {
            return badValue(where, "two textures have the slot " + std::to_string(use.slot),
                            "give each slot at most one texture");
        }
    }
    for (const SceneEditor::MaterialKey& key : source.keys) {
        GLINT_TRY_DO(store.cases->checkAttributes(key, where));
        GLINT_TRY_DO(checkDimensions(store, source.textures, key, where));
    }
    return okStatus();
}

Result<std::vector<std::uint8_t>> makeRecord(SceneStore& store, const SceneEditor::MaterialSource& source) {
    for (const SceneEditor::TextureUse& use : source.textures) {
        GLINT_TRY_DO(ensureSampler(store, use.sampler));
    }
    std::vector<std::uint8_t> record(source.record.begin(), source.record.end());
    settleTextures(store, store.scene.materialLayout, source.textures, record);
    return record;
}

void countUses(SceneStore& store, std::uint32_t material, std::span<const SceneEditor::TextureUse> uses,
               bool adds) {
    for (const SceneEditor::TextureUse& use : uses) {
        countUse(store.textures.find(use.texture)->materials, material, adds);
    }
}

// Makes an image and queues its copies.
Result<DeviceImage> makeImage(SceneStore& store, const ImageView& image, bool srgb, std::uint32_t texture) {
    GpuScene::State& scene = store.scene;
    const std::string where = placeOf("texture", texture);
    GLINT_TRY_DO(checkImage(image, srgb, where, imageLimits(scene.context)));
    const std::size_t before = store.uploader->waiting();
    Result<DeviceImage> made = uploadSceneTexture(scene, *store.uploader, texture, image, srgb);
    if (!made && store.upload == nullptr) {
        store.uploader->forgetAfter(before);
    }
    return made;
}

// The attributes of the primitives that the material is on.
std::vector<AttributeMask> attributesWith(const SceneStore& store, MaterialHandle material) {
    std::vector<AttributeMask> found;
    const auto add = [&](AttributeMask attributes) {
        if (std::ranges::find(found, attributes) == found.end()) {
            found.push_back(attributes);
        }
    };
    const StoredMaterial& entry = *store.materialSlots.find(material);
    for (const auto& [index, uses] : entry.meshes) {
        for (const StoredPrimitive& primitive : store.meshes.at(index).primitives) {
            if (primitive.material == material) {
                add(primitive.attributes);
            }
        }
    }
    for (const auto& [index, uses] : entry.instances) {
        const StoredInstance& instance = store.instanceSlots.at(index);
        for (std::size_t i = 0; i < instance.materials.size(); ++i) {
            if (instance.materials[i] == material) {
                add(store.meshes.find(instance.mesh)->primitives[i].attributes);
            }
        }
    }
    return found;
}

const SceneEditor::MaterialKey* keyFor(std::span<const SceneEditor::MaterialKey> keys,
                                       AttributeMask attributes) {
    const auto found = std::ranges::find(keys, attributes, &SceneEditor::MaterialKey::attributes);
    return found == keys.end() ? nullptr : &*found;
}

}  // namespace

std::set<std::uint32_t> instancesWith(const SceneStore& store, const StoredMaterial& material) {
    std::set<std::uint32_t> found;
    for (const auto& [index, uses] : material.instances) {
        found.insert(index);
    }
    for (const auto& [index, uses] : material.meshes) {
        const StoredMesh& mesh = store.meshes.at(index);
        found.insert(mesh.instances.begin(), mesh.instances.end());
    }
    return found;
}

Result<Shading> shadingBy(const CaseTable& cases, std::span<const SceneEditor::MaterialKey> keys,
                          AttributeMask attributes, const std::string& where) {
    const SceneEditor::MaterialKey* const key = keyFor(keys, attributes);
    if (key == nullptr) {
        return makeError(
            "scene-edit-key", where,
            "the material has no key for a primitive with the attributes " + std::to_string(attributes),
            "give a SceneEditor::MaterialKey for each set of attributes that its primitives have");
    }
    return cases.find(*key, where);
}

Diagnostic unknownHandle(const char* what) {
    return makeError("scene-edit-handle", "", std::string("the handle of a ") + what + " names nothing",
                     "drop handles of what was removed, and use those of this scene");
}

std::string placeOf(const char* what, std::uint32_t index) {
    return phrase(what, " ", index);
}

MaterialHandle materialOf(const SceneStore& store, const StoredInstance& instance, std::size_t primitive) {
    const bool own = !instance.materials.empty() && instance.materials[primitive].generation != 0;
    return own ? instance.materials[primitive]
               : store.meshes.find(instance.mesh)->primitives[primitive].material;
}

Result<Shading> shadingOf(const SceneStore& store, MaterialHandle material, AttributeMask attributes) {
    const StoredMaterial* const entry = store.materialSlots.find(material);
    if (entry == nullptr) {
        return unknownHandle("material");
    }
    return shadingBy(*store.cases, entry->keys, attributes, placeOf("material", material.index));
}

void addTo(SceneEditor::Report& report, const CaseTable& cases, MaterialHandle material,
           const Shading& shading) {
    const bool listed =
        std::ranges::any_of(report.missing, [&](const SceneEditor::Report::MissingCase& other) {
            return other.material == material && other.features == shading.features;
        });
    if (shading.missing && !listed) {
        report.missing.push_back(
            {material, shading.features, cases.package().featureNames(shading.features)});
    }
}

// A record says which textures it may read. A slot that no key reads holds zero.
std::vector<SceneEditor::TextureUse> usesOf(const PackageScene& known,
                                            std::span<const TextureHandle> textures, std::size_t material) {
    std::vector<SceneEditor::TextureUse> uses;
    for (std::uint32_t slot = 0; slot < known.materials.textureCount && !textures.empty(); ++slot) {
        const gpu::TextureRecord record = textureAt(known.materials, material, slot);
        if (std::ranges::all_of(std::as_bytes(std::span(&record, 1)),
                                [](std::byte part) { return part == std::byte{0}; })) {
            continue;
        }
        uses.push_back(
            {slot, textures[record.textureIndex], known.samplers[record.samplerIndex], record.texCoord});
    }
    return uses;
}

std::size_t findSampler(const SceneStore& store, const package::SamplerEntry& entry) {
    const auto known =
        std::ranges::find_if(store.samplers, [&](const auto& other) { return isSame(other, entry); });
    return static_cast<std::size_t>(known - store.samplers.begin());
}

Diagnostic noRoomForSampler(const SceneStore& store) {
    return makeError(
        "scene-edit-room", "",
        phrase("the scene has ", store.samplers.size(), " kinds of samplers, and no room for another"),
        "set SceneView::samplerRoom, or use fewer kinds of samplers");
}

Status ensureSampler(SceneStore& store, const package::SamplerEntry& entry) {
    if (findSampler(store, entry) < store.samplers.size()) {
        return okStatus();
    }
    if (store.samplers.size() >= store.scene.samplerRoom) {
        return noRoomForSampler(store);
    }
    GLINT_TRY(auto sampler, createSampler(store.scene.context, entry));
    store.scene.samplers.push_back(std::move(sampler));
    store.samplers.push_back(entry);
    store.setDirty = true;
    return okStatus();
}

void settleTextures(const SceneStore& store, const MaterialTable& layout,
                    std::span<const SceneEditor::TextureUse> uses, std::span<std::uint8_t> record) {
    const MaterialTable table = tableWith(layout, record);
    for (std::uint32_t slot = 0; slot < table.textureCount; ++slot) {
        gpu::TextureRecord settled = textureAt(table, 0, slot);
        settled.textureIndex = 0;
        settled.samplerIndex = 0;
        settled.texCoord = 0;
        settled.texels = {};
        settled.anisotropy = 1.0F;
        const auto use = std::ranges::find(uses, slot, &SceneEditor::TextureUse::slot);
        if (use != uses.end()) {
            const StoredTexture& texture = *store.textures.find(use->texture);
            settled.textureIndex = use->texture.index;
            settled.samplerIndex = static_cast<std::uint32_t>(findSampler(store, use->sampler));
            settled.texCoord = use->texCoord;
            settled.texels = {static_cast<float>(texture.width), static_cast<float>(texture.height)};
            settled.anisotropy = anisotropyOf(store.scene.context, use->sampler);
        }
        std::memcpy(&record[placeOfTexture(table, 0, slot)], &settled, sizeof settled);
    }
}

Result<TextureHandle> SceneEditor::addTexture(const ImageView& image, bool srgb) try {
    GpuScene::State& scene = store_->scene;
    const TextureHandle next = store_->textures.next();
    if (next.index >= scene.textureRoom) {
        return makeError(
            "scene-edit-room", "",
            phrase("the scene has ", store_->textures.count(), " textures, and no room for another"),
            "set SceneView::textureRoom, or remove a texture");
    }
    GLINT_TRY(auto made, makeImage(*store_, image, srgb, next.index));
    const TextureHandle texture =
        store_->textures.add({image.width, image.height, srgb, image.dimension, emissionTexels(image, srgb)});
    scene.textures.resize(std::max<std::size_t>(scene.textures.size(), store_->textures.end()));
    scene.textures[texture.index] = std::move(made);
    store_->setDirty = true;
    return texture;
}
GLINT_CATCH

Status SceneEditor::replaceTexture(TextureHandle texture, const ImageView& image) try {
    GLINT_TRY(StoredTexture* const entry, findNamed(store_->textures, texture, "texture"));
    if (store_->cases->package().trustTextures()) {
        return makeError("texture-trusted", "", "the shaders of the package rely on what its textures hold",
                         "compile it with --no-trust-textures, or with --fallback");
    }
    GLINT_TRY_DO(checkDimension(image.dimension, entry->dimension, placeOf("texture", texture.index)));
    GLINT_TRY(auto made, makeImage(*store_, image, entry->srgb, texture.index));
    DeviceImage& place = store_->scene.textures[texture.index];
    store_->retired.add(std::move(place));
    place = std::move(made);
    store_->setDirty = true;
    store_->otherTexels = true;
    entry->width = image.width;
    entry->height = image.height;
    entry->texels = emissionTexels(image, entry->srgb);
    replaceEmission(*store_, *entry);
    // Records have the sizes of their textures.
    for (const auto& [material, uses] : entry->materials) {
        forgetDecisions(*store_, material);
        const std::span<const std::uint8_t> old = store_->materials.at(material);
        std::vector<std::uint8_t> record(old.begin(), old.end());
        settleTextures(*store_, store_->scene.materialLayout, store_->materialSlots.at(material).textures,
                       record);
        store_->materials.writeBytes(material, record);
    }
    return okStatus();
}
GLINT_CATCH

Status SceneEditor::removeTexture(TextureHandle texture) try {
    GLINT_TRY(const StoredTexture* const entry, findNamed(store_->textures, texture, "texture"));
    if (!entry->materials.empty()) {
        return makeError("scene-edit-used", placeOf("texture", texture.index),
                         std::to_string(entry->materials.size()) + " materials use the texture",
                         "remove the materials first, or give them other textures");
    }
    store_->textures.take(texture);
    forgetTexture(store_->scene, texture.index);
    std::vector<DeviceImage>& images = store_->scene.textures;
    store_->retired.add(std::move(images[texture.index]));
    images[texture.index] = {};
    images.resize(store_->textures.end());
    store_->setDirty = true;
    return okStatus();
}
GLINT_CATCH

Result<MaterialHandle> SceneEditor::addMaterial(const SceneEditor::MaterialSource& source) try {
    const std::string where = placeOf("material", store_->materialSlots.next().index);
    GLINT_TRY_DO(checkSource(*store_, source, where));
    GLINT_TRY(auto record, makeRecord(*store_, source));
    const MaterialHandle material = store_->materialSlots.add(
        {{source.keys.begin(), source.keys.end()}, {source.textures.begin(), source.textures.end()}, true});
    countUses(*store_, material.index, source.textures, true);
    store_->materials.writeBytes(material.index, record);
    return material;
}
GLINT_CATCH

Result<SceneEditor::Report> SceneEditor::setMaterial(MaterialHandle material,
                                                     const SceneEditor::MaterialSource& source) try {
    GLINT_TRY(StoredMaterial* const entry, findNamed(store_->materialSlots, material, "material"));
    const std::string where = placeOf("material", material.index);
    GLINT_TRY_DO(checkSource(*store_, source, where));
    SceneEditor::Report report;
    bool changes = false;
    for (const AttributeMask attributes : attributesWith(*store_, material)) {
        GLINT_TRY(auto shading, shadingBy(*store_->cases, source.keys, attributes, where));
        addTo(report, *store_->cases, material, shading);
        const Result<Shading> before = shadingBy(*store_->cases, entry->keys, attributes, where);
        changes = changes || !before || !(*before == shading);
    }
    GLINT_TRY(auto record, makeRecord(*store_, source));
    // The new textures may be some of the old.
    countUses(*store_, material.index, source.textures, true);
    countUses(*store_, material.index, entry->textures, false);
    entry->keys.assign(source.keys.begin(), source.keys.end());
    entry->textures.assign(source.textures.begin(), source.textures.end());
    entry->isOwn = true;
    writeMaterial(*store_, material.index, record);
    if (changes) {
        store_->decidedMaterials.erase(material.index);
        for (const std::uint32_t index : instancesWith(*store_, *entry)) {
            writeGeometries(*store_, store_->instanceSlots.handleAt(index), store_->instanceSlots.at(index));
        }
    }
    return report;
}
GLINT_CATCH

Status SceneEditor::setMaterialValues(MaterialHandle material, std::span<const std::uint8_t> record) try {
    GLINT_TRY(StoredMaterial* const entry, findNamed(store_->materialSlots, material, "material"));
    if (record.size() != store_->scene.materialLayout.recordBytes) {
        return badValue(placeOf("material", material.index), "the record has another size than the package's",
                        "make the record in the package's layout");
    }
    const std::span<const std::uint8_t> old = store_->materials.at(material.index);
    std::vector<std::uint8_t> taken(old.begin(), old.end());
    takeValues(record, store_->scene.materialLayout, taken);
    entry->hasOwnValues = true;
    writeMaterial(*store_, material.index, taken);
    return okStatus();
}
GLINT_CATCH

Status SceneEditor::removeMaterial(MaterialHandle material) try {
    GLINT_TRY(const StoredMaterial* const entry, findNamed(store_->materialSlots, material, "material"));
    std::uint32_t uses = 0;
    for (const auto* const users : {&entry->meshes, &entry->instances}) {
        for (const auto& [index, count] : *users) {
            uses += count;
        }
    }
    if (uses > 0) {
        return makeError("scene-edit-used", placeOf("material", material.index),
                         std::to_string(uses) + " primitives of meshes and instances use the material",
                         "give them other materials first, or remove them");
    }
    const StoredMaterial gone = store_->materialSlots.take(material);
    store_->decidedMaterials.erase(material.index);
    countUses(*store_, material.index, gone.textures, false);
    store_->materials.shrink(store_->materialSlots.end());
    return okStatus();
}
GLINT_CATCH

}  // namespace glint
