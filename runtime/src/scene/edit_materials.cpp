// SceneEditor: textures and materials.
#include "data/materials.h"
#include "data/scene_checks.h"
#include "package/package.h"
#include "scene/scene_editor.h"
#include "scene/texture_stream.h"

#include <algorithm>
#include <cstring>
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

Status checkUse(const SceneEditor::State& state, const TextureUse& use, const std::string& where) {
    if (state.textures.find(use.texture) == nullptr) {
        return unknownHandle("texture");
    }
    if (use.slot >= state.layout.textureCount || use.texCoord > 1 || !isKnown(use.sampler)) {
        return badValue(where,
                        "a texture has a slot that records lack, a UV set above 1 or an unknown sampler",
                        "use the slots of the package's records");
    }
    return okStatus();
}

// Checks a source on its own, without the scene.
Status checkSource(const SceneEditor::State& state, const MaterialSource& source, const std::string& where) {
    if (source.record.size() != state.layout.recordBytes) {
        return badValue(where,
                        "the record has " + std::to_string(source.record.size()) +
                            " bytes, those of the package have " + std::to_string(state.layout.recordBytes),
                        "make the record in the package's layout");
    }
    for (std::size_t i = 0; i < source.textures.size(); ++i) {
        const TextureUse& use = source.textures[i];
        GLINT_TRY_DO(checkUse(state, use, where));
        const auto earlier = std::span(source.textures).first(i);
        if (std::ranges::find(earlier, use.slot, &TextureUse::slot) != earlier.end()) {
            return badValue(where, "two textures have the slot " + std::to_string(use.slot),
                            "give each slot at most one texture");
        }
    }
    for (const MaterialKey& key : source.keys) {
        GLINT_TRY_DO(state.cases.checkAttributes(key, where));
    }
    return okStatus();
}

// Writes into a record which textures it has, if records of this layout hold that.
void settleTextures(const SceneEditor::State& state, std::span<const TextureUse> uses,
                    std::span<const std::uint32_t> samplers, std::span<std::uint8_t> record) {
    const MaterialTable table{record, state.layout.recordBytes, state.layout.textureOffset,
                              state.layout.textureCount};
    for (std::uint32_t slot = 0; slot < table.textureCount; ++slot) {
        gpu::TextureRecord settled = textureAt(table, 0, slot);
        settled.textureIndex = 0;
        settled.samplerIndex = 0;
        settled.texCoord = 0;
        settled.texels = {};
        settled.anisotropy = 1.0F;
        for (std::size_t i = 0; i < uses.size(); ++i) {
            if (uses[i].slot == slot) {
                const EditedTexture& texture = *state.textures.find(uses[i].texture);
                settled.textureIndex = uses[i].texture.index;
                settled.samplerIndex = samplers[i];
                settled.texCoord = uses[i].texCoord;
                settled.texels = {static_cast<float>(texture.width), static_cast<float>(texture.height)};
                settled.anisotropy = anisotropyOf(state.scene.context, uses[i].sampler);
            }
        }
        std::memcpy(&record[placeOfTexture(table, 0, slot)], &settled, sizeof settled);
    }
}

Result<std::vector<std::uint8_t>> makeRecord(SceneEditor::State& state, const MaterialSource& source) {
    std::vector<std::uint32_t> samplers;
    for (const TextureUse& use : source.textures) {
        GLINT_TRY(auto sampler, samplerIndex(state, use.sampler));
        samplers.push_back(sampler);
    }
    std::vector<std::uint8_t> record(source.record.begin(), source.record.end());
    settleTextures(state, source.textures, samplers, record);
    return record;
}

void countUses(SceneEditor::State& state, std::span<const TextureUse> uses, bool adds) {
    for (const TextureUse& use : uses) {
        std::uint32_t& count = state.textures.find(use.texture)->uses;
        count = adds ? count + 1 : count - 1;
    }
}

// Makes an image and queues its copies.
Result<DeviceImage> makeImage(SceneEditor::State& state, const ImageView& image, bool srgb,
                              std::uint32_t texture) {
    GpuScene::State& scene = state.scene;
    const std::string where = placeOf("texture", texture);
    GLINT_TRY_DO(checkImage(image, srgb, where, imageLimits(scene.context)));
    const std::size_t before = state.uploader->waiting();
    Result<DeviceImage> made = uploadSceneTexture(scene, *state.uploader, texture, image, srgb);
    if (!made && state.upload == nullptr) {
        state.uploader->forgetAfter(before);
    }
    return made;
}

// The attributes of the primitives that the material is on.
std::vector<AttributeMask> attributesWith(const SceneEditor::State& state, MaterialHandle material) {
    std::vector<AttributeMask> found;
    const auto add = [&](AttributeMask attributes) {
        if (std::ranges::find(found, attributes) == found.end()) {
            found.push_back(attributes);
        }
    };
    state.meshes.forEach([&](MeshHandle /*handle*/, const EditedMesh& mesh) {
        for (const EditedMeshPrimitive& primitive : mesh.primitives) {
            if (primitive.material == material) {
                add(primitive.attributes);
            }
        }
    });
    state.instanceSlots.forEach([&](InstanceHandle /*handle*/, const EditedInstance& instance) {
        for (std::size_t i = 0; i < instance.materials.size(); ++i) {
            if (instance.materials[i] == material) {
                add(state.meshes.find(instance.mesh)->primitives[i].attributes);
            }
        }
    });
    return found;
}

const MaterialKey* keyFor(std::span<const MaterialKey> keys, AttributeMask attributes) {
    const auto found = std::ranges::find(keys, attributes, &MaterialKey::attributes);
    return found == keys.end() ? nullptr : &*found;
}

Result<Shading> shadingBy(const SceneEditor::State& state, std::span<const MaterialKey> keys,
                          AttributeMask attributes, const std::string& where) {
    const MaterialKey* const key = keyFor(keys, attributes);
    if (key == nullptr) {
        return makeError(
            "scene-edit-key", where,
            "the material has no key for a primitive with the attributes " + std::to_string(attributes),
            "give a MaterialKey for each set of attributes that its primitives have");
    }
    return state.cases.find(*key, where);
}

}  // namespace

Diagnostic unknownHandle(const char* what) {
    return makeError("scene-edit-handle", "", std::string("the handle of a ") + what + " names nothing",
                     "drop handles of what was removed, and use those of this scene");
}

std::string placeOf(const char* what, std::uint32_t index) {
    return std::string(what) + " " + std::to_string(index);
}

Result<std::uint32_t> samplerIndex(SceneEditor::State& state, const package::SamplerEntry& entry) {
    const auto known =
        std::ranges::find_if(state.samplers, [&](const auto& other) { return isSame(other, entry); });
    if (known != state.samplers.end()) {
        return static_cast<std::uint32_t>(known - state.samplers.begin());
    }
    if (state.samplers.size() >= state.scene.samplerRoom) {
        return makeError("scene-edit-room", "",
                         "the scene has " + std::to_string(state.samplers.size()) +
                             " kinds of samplers, and no room for another",
                         "set SceneView::samplerRoom, or use fewer kinds of samplers");
    }
    GLINT_TRY(auto sampler, createSampler(state.scene.context, entry));
    state.scene.samplers.push_back(std::move(sampler));
    state.samplers.push_back(entry);
    state.setDirty = true;
    return static_cast<std::uint32_t>(state.samplers.size() - 1);
}

Result<Shading> shadingOf(const SceneEditor::State& state, MaterialHandle material,
                          AttributeMask attributes) {
    const EditedMaterial* const entry = state.materialSlots.find(material);
    if (entry == nullptr) {
        return unknownHandle("material");
    }
    return shadingBy(state, entry->keys, attributes, placeOf("material", material.index));
}

void addTo(EditReport& report, const SceneEditor::State& state, MaterialHandle material,
           const Shading& shading) {
    const bool listed = std::ranges::any_of(report.missing, [&](const MissingCase& other) {
        return other.material == material && other.features == shading.features;
    });
    if (shading.missing && !listed) {
        report.missing.push_back(
            {material, shading.features, state.cases.package().featureNames(shading.features)});
    }
}

Result<TextureHandle> SceneEditor::addTexture(const ImageView& image, bool srgb) {
    GpuScene::State& scene = state_->scene;
    const TextureHandle next = state_->textures.next();
    if (next.index >= scene.textureRoom) {
        return makeError("scene-edit-room", "",
                         "the scene has " + std::to_string(state_->textures.count()) +
                             " textures, and no room for another",
                         "set SceneView::textureRoom, or remove a texture");
    }
    GLINT_TRY(auto made, makeImage(*state_, image, srgb, next.index));
    const TextureHandle texture =
        state_->textures.add({image.width, image.height, srgb, 0, emissionTexels(*state_, image, srgb)});
    scene.textures.resize(std::max<std::size_t>(scene.textures.size(), state_->textures.end()));
    scene.textures[texture.index] = std::move(made);
    state_->setDirty = true;
    return texture;
}

Status SceneEditor::replaceTexture(TextureHandle texture, const ImageView& image) {
    EditedTexture* const entry = state_->textures.find(texture);
    if (entry == nullptr) {
        return unknownHandle("texture");
    }
    if (state_->trustsTextures) {
        return makeError("texture-trusted", "", "the shaders of the package rely on what its textures hold",
                         "compile it with --no-trust-textures, or with --fallback");
    }
    GLINT_TRY(auto made, makeImage(*state_, image, entry->srgb, texture.index));
    DeviceImage& place = state_->scene.textures[texture.index];
    state_->retired.add(std::move(place));
    place = std::move(made);
    state_->setDirty = true;
    entry->width = image.width;
    entry->height = image.height;
    entry->texels = emissionTexels(*state_, image, entry->srgb);
    replaceEmission(*state_, texture);
    // Records have the sizes of their textures.
    state_->materialSlots.forEach([&](MaterialHandle handle, const EditedMaterial& material) {
        for (const TextureUse& use : material.textures) {
            if (use.texture == texture) {
                const std::span<const std::uint8_t> old = state_->materials.at(handle.index);
                std::vector<std::uint8_t> record(old.begin(), old.end());
                const MaterialTable table{record, state_->layout.recordBytes, state_->layout.textureOffset,
                                          state_->layout.textureCount};
                gpu::TextureRecord settled = textureAt(table, 0, use.slot);
                settled.texels = {static_cast<float>(image.width), static_cast<float>(image.height)};
                std::memcpy(&record[placeOfTexture(table, 0, use.slot)], &settled, sizeof settled);
                state_->materials.writeBytes(handle.index, record);
            }
        }
    });
    return okStatus();
}

Status SceneEditor::removeTexture(TextureHandle texture) {
    const EditedTexture* const entry = state_->textures.find(texture);
    if (entry == nullptr) {
        return unknownHandle("texture");
    }
    if (entry->uses > 0) {
        return makeError("scene-edit-used", placeOf("texture", texture.index),
                         std::to_string(entry->uses) + " materials use the texture",
                         "remove the materials first, or give them other textures");
    }
    state_->textures.take(texture);
    forgetTexture(state_->scene, texture.index);
    std::vector<DeviceImage>& images = state_->scene.textures;
    state_->retired.add(std::move(images[texture.index]));
    images[texture.index] = {};
    images.resize(state_->textures.end());
    state_->setDirty = true;
    return okStatus();
}

Result<MaterialHandle> SceneEditor::addMaterial(const MaterialSource& source) {
    const std::string where = placeOf("material", state_->materialSlots.next().index);
    GLINT_TRY_DO(checkSource(*state_, source, where));
    GLINT_TRY(auto record, makeRecord(*state_, source));
    const MaterialHandle material = state_->materialSlots.add(
        {{source.keys.begin(), source.keys.end()}, {source.textures.begin(), source.textures.end()}, 0});
    countUses(*state_, source.textures, true);
    state_->materials.writeBytes(material.index, record);
    return material;
}

Result<EditReport> SceneEditor::setMaterial(MaterialHandle material, const MaterialSource& source) {
    EditedMaterial* const entry = state_->materialSlots.find(material);
    if (entry == nullptr) {
        return unknownHandle("material");
    }
    const std::string where = placeOf("material", material.index);
    GLINT_TRY_DO(checkSource(*state_, source, where));
    EditReport report;
    bool changes = false;
    for (const AttributeMask attributes : attributesWith(*state_, material)) {
        GLINT_TRY(auto shading, shadingBy(*state_, source.keys, attributes, where));
        addTo(report, *state_, material, shading);
        const Result<Shading> before = shadingBy(*state_, entry->keys, attributes, where);
        changes = changes || !before || !(*before == shading);
    }
    GLINT_TRY(auto record, makeRecord(*state_, source));
    // The new textures may be some of the old.
    countUses(*state_, source.textures, true);
    countUses(*state_, entry->textures, false);
    entry->keys.assign(source.keys.begin(), source.keys.end());
    entry->textures.assign(source.textures.begin(), source.textures.end());
    writeMaterial(*state_, material.index, record);
    if (changes) {
        state_->instanceSlots.forEach([&](InstanceHandle handle, const EditedInstance& instance) {
            for (std::size_t i = 0; i < state_->meshes.find(instance.mesh)->primitives.size(); ++i) {
                if (materialOf(*state_, instance, i) == material) {
                    writeGeometries(*state_, handle, instance);
                    return;
                }
            }
        });
    }
    return report;
}

Status SceneEditor::setMaterialValues(MaterialHandle material, std::span<const std::uint8_t> record) {
    if (state_->materialSlots.find(material) == nullptr) {
        return unknownHandle("material");
    }
    if (record.size() != state_->layout.recordBytes) {
        return badValue(placeOf("material", material.index), "the record has another size than the package's",
                        "make the record in the package's layout");
    }
    const std::span<const std::uint8_t> old = state_->materials.at(material.index);
    std::vector<std::uint8_t> taken(old.begin(), old.end());
    takeValues(record, state_->layout, taken);
    writeMaterial(*state_, material.index, taken);
    return okStatus();
}

Status SceneEditor::removeMaterial(MaterialHandle material) {
    const EditedMaterial* const entry = state_->materialSlots.find(material);
    if (entry == nullptr) {
        return unknownHandle("material");
    }
    if (entry->uses > 0) {
        return makeError("scene-edit-used", placeOf("material", material.index),
                         std::to_string(entry->uses) + " primitives of meshes and instances use the material",
                         "give them other materials first, or remove them");
    }
    const EditedMaterial gone = state_->materialSlots.take(material);
    countUses(*state_, gone.textures, false);
    state_->materials.shrink(state_->materialSlots.end());
    return okStatus();
}

namespace {

bool isEmitterRecord(const SceneEditor::State& state, std::uint32_t geometry) {
    return (state.geometries.read<gpu::GeometryRecord>(geometry).flags & gpu::kGeometryEmitter) != 0;
}

bool emitsLight(const SceneEditor::State& state, const EditedInstance& instance) {
    const std::uint32_t end = instance.firstGeometry + instance.geometryCount;
    for (std::uint32_t i = instance.firstGeometry; i < end; ++i) {
        if (isEmitterRecord(state, i)) {
            return true;
        }
    }
    return false;
}

bool hasTexture(const SceneEditor::State& state) {
    return state.emission->texture != package::EmissionEntry::kNone;
}

// The material's texture in the emission's slot. Requires that records have one.
gpu::TextureRecord emissionRecord(const SceneEditor::State& state, std::span<const std::uint8_t> record) {
    return textureAt(tableWith(state.layout, record), 0, state.emission->texture);
}

// Returns null if the material has no texture there, or its texels are not known.
std::shared_ptr<const EmissionTexels> texelsOf(const SceneEditor::State& state,
                                               const EditedMaterial& material) {
    const auto use = std::ranges::find(material.textures, state.emission->texture, &TextureUse::slot);
    return use == material.textures.end() ? nullptr : state.textures.find(use->texture)->texels;
}

// Appends the parts of an instance that is shown.
void addParts(SceneEditor::State& state, const EditedInstance& instance, std::uint32_t number,
              std::vector<EmitterPart>& parts) {
    std::uint32_t geometry = instance.firstGeometry;
    const std::vector<EditedMeshPrimitive>& primitives = state.meshes.find(instance.mesh)->primitives;
    for (std::size_t i = 0; i < primitives.size(); ++i) {
        for (const EditedPart& placed : primitives[i].parts) {
            const auto record = state.geometries.read<gpu::GeometryRecord>(geometry++);
            if ((record.flags & gpu::kGeometryEmitter) == 0) {
                continue;
            }
            const std::span<const std::uint8_t> values = state.materials.at(record.materialIndex);
            EmitterPart part;
            part.geometry = geometry - 1;
            part.instance = number;
            part.primitive = static_cast<std::uint32_t>(i);
            part.material = record.materialIndex;
            part.first = placed.triangles.first;
            part.count = placed.triangles.count;
            part.twoSided = (record.flags & gpu::kGeometryDoubleSided) != 0;
            part.luminance = emittedLuminance(values, *state.emission);
            part.shape = primitives[i].shape;
            if (hasTexture(state)) {
                const EditedMaterial& material = *state.materialSlots.find(materialOf(state, instance, i));
                part.texels = state.emitterMeans.find(
                    part.shape, record.materialIndex,
                    emitterTexture(*state.emission, record.featureInputs, emissionRecord(state, values),
                                   state.samplers, texelsOf(state, material)));
            }
            state.emissiveMaterials.insert(record.materialIndex);
            parts.push_back(std::move(part));
        }
    }
}

}  // namespace

std::shared_ptr<const EmissionTexels> emissionTexels(const SceneEditor::State& state, const ImageView& image,
                                                     bool srgb) {
    const std::uint64_t wanted = bytesOfLevel(TexelFormat::Rgba8, image.width, image.height, 0);
    const bool readable = !isBlockFormat(image.format) || image.decoded.size() == wanted;
    if (state.emission == nullptr || !hasTexture(state) || !srgb || !readable) {
        return nullptr;
    }
    return std::make_shared<EmissionTexels>(image, srgb);
}

void noteEmitters(SceneEditor::State& state, InstanceHandle handle, const EditedInstance& instance) {
    if (state.emission == nullptr) {
        return;
    }
    const bool was = state.emissiveInstances.contains(handle.generation);
    const bool is = emitsLight(state, instance);
    if (is) {
        state.emissiveInstances[handle.generation] = handle;
    } else if (was) {
        state.emissiveInstances.erase(handle.generation);
    }
    state.emittersDirty = state.emittersDirty || was || is;
    // These places may have held records of another instance. gatherEmitters() numbers those that are lights.
    const std::uint32_t end = instance.firstGeometry + instance.geometryCount;
    for (std::uint32_t i = instance.firstGeometry; i < end; ++i) {
        state.firstEmitters.write(i, gpu::kNoEmitter);
    }
}

void moveEmitters(SceneEditor::State& state, InstanceHandle handle, bool removed) {
    const auto found = state.emissiveInstances.find(handle.generation);
    if (found == state.emissiveInstances.end()) {
        return;
    }
    state.emittersDirty = true;
    if (removed) {
        state.emissiveInstances.erase(found);
    }
}

void replaceEmission(SceneEditor::State& state, TextureHandle texture) {
    if (state.emission == nullptr || !hasTexture(state)) {
        return;
    }
    state.materialSlots.forEach([&](MaterialHandle handle, const EditedMaterial& material) {
        const auto use = std::ranges::find(material.textures, state.emission->texture, &TextureUse::slot);
        if (use != material.textures.end() && use->texture == texture &&
            state.emissiveMaterials.contains(handle.index)) {
            state.emittersDirty = true;
        }
    });
}

void writeMaterial(SceneEditor::State& state, std::uint32_t material, std::span<const std::uint8_t> record) {
    if (state.emissiveMaterials.contains(material)) {
        const std::span<const std::uint8_t> old = state.materials.at(material);
        bool changes = emittedLuminance(old, *state.emission) != emittedLuminance(record, *state.emission);
        if (hasTexture(state)) {
            const gpu::TextureRecord before = emissionRecord(state, old);
            const gpu::TextureRecord after = emissionRecord(state, record);
            changes = changes || !std::ranges::equal(std::as_bytes(std::span(&before, 1)),
                                                     std::as_bytes(std::span(&after, 1)));
        }
        state.emittersDirty = state.emittersDirty || changes;
    }
    state.materials.writeBytes(material, record);
}

Emitters gatherEmitters(SceneEditor::State& state) {
    std::vector<EmitterPart> parts;
    std::uint32_t number = 0;
    state.emissiveMaterials.clear();
    for (const auto& [generation, handle] : state.emissiveInstances) {
        const EditedInstance& instance = *state.instanceSlots.find(handle);
        if (instance.isShown()) {
            addParts(state, instance, number++, parts);
        }
    }
    state.emitterMeans.forgetUnused();
    return {*state.emission, std::move(parts)};
}

std::vector<InstanceView> emissiveViews(const SceneEditor::State& state) {
    std::vector<InstanceView> views;
    for (const auto& [generation, handle] : state.emissiveInstances) {
        const EditedInstance& instance = *state.instanceSlots.find(handle);
        if (instance.isShown()) {
            views.emplace_back().objectToWorld = instance.objectToWorld;
        }
    }
    return views;
}

}  // namespace glint
