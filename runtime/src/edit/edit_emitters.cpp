// SceneEditor: triangles that are lights.
#include "edit/editor_state.h"
#include "scene/material_table.h"

#include <algorithm>
#include <span>
#include <utility>

namespace glint {
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
