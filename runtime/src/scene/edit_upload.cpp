// The upload of a scene that can be edited. Its content becomes the editor's, and is then recorded as edits
// are. Only the BLASes are built together.
#include "data/materials.h"
#include "package/package.h"
#include "scene/scene_editor.h"
#include "scene/texture_stream.h"

#include <algorithm>
#include <utility>

namespace glint {
namespace {

Status checkEditable(const SceneView& view) {
    const bool deforms = std::ranges::any_of(view.instances, [](const InstanceView& instance) {
        return !instance.joints.empty() || !instance.morphWeights.empty();
    });
    if (view.moves || deforms) {
        return makeError("scene-edit-moves", "",
                         "the scene moves by GpuScene::update(), or has a mesh that changes its shape",
                         "edit the transforms of instances instead, or leave SceneView::editable out");
    }
    return okStatus();
}

Status addTextures(SceneEditor::State& state, const PackageScene& known, const SceneView& view) {
    GpuScene::State& scene = state.scene;
    GLINT_TRY(state.white,
              uploadTexture(scene.context, scene.pool, *state.uploader, {1, 1, kWhiteTexel}, false));
    if (scene.textureRoom > scene.context.limits.maxTextures) {
        return makeError("scene-textures", "",
                         "the scene has room for " + std::to_string(scene.textureRoom) +
                             " textures, the device takes " +
                             std::to_string(scene.context.limits.maxTextures),
                         "lower SceneView::textureRoom, or use a smaller scene");
    }
    for (const package::TextureEntry& entry : known.textures) {
        const ImageView& image = view.images[entry.image];
        GLINT_TRY(auto made, uploadSceneTexture(scene, *state.uploader,
                                                static_cast<std::uint32_t>(scene.textures.size()), image,
                                                entry.srgb != 0));
        scene.textures.push_back(std::move(made));
        const bool srgb = entry.srgb != 0;
        state.firstTextures.push_back(
            state.textures.add({image.width, image.height, srgb, 0, emissionTexels(state, image, srgb)}));
    }
    scene.statistics.narrowedTextures = countNarrowed(scene.context, known.textures, view.images);
    return okStatus();
}

// Samplers keep the package's numbers, which its records have.
Status addSamplers(SceneEditor::State& state, const PackageScene& known) {
    GLINT_TRY(state.scene.samplers, createSamplers(state.scene.context, known.samplers));
    state.samplers.assign(known.samplers.begin(), known.samplers.end());
    if (state.samplers.empty()) {
        state.samplers.push_back({0, 0, 1, 1, 1, 1});
    }
    return okStatus();
}

// A record says which textures it may read. A slot that no key reads names the first texture, too.
std::vector<TextureUse> usesOf(const SceneEditor::State& state, const PackageScene& known,
                               std::size_t material) {
    std::vector<TextureUse> uses;
    for (std::uint32_t slot = 0; slot < known.materials.textureCount && !known.textures.empty(); ++slot) {
        const gpu::TextureRecord record = textureAt(known.materials, material, slot);
        uses.push_back({slot, state.firstTextures[record.textureIndex], state.samplers[record.samplerIndex],
                        record.texCoord});
    }
    return uses;
}

Status addMaterials(SceneEditor::State& state, const PackageScene& known, const SceneView& view) {
    std::vector<std::uint8_t> records = materialsWithSizes(state.scene.context, known, view.images);
    GLINT_TRY([[maybe_unused]] const auto changing,
              replaceMaterials(view.materials, known.materials, records));
    const std::size_t bytes = state.layout.recordBytes;
    for (std::size_t i = 0; i < known.materials.size(); ++i) {
        EditedMaterial material;
        material.textures = usesOf(state, known, i);
        for (const TextureUse& use : material.textures) {
            ++state.textures.find(use.texture)->uses;
        }
        const MaterialHandle handle = state.materialSlots.add(std::move(material));
        state.firstMaterials.push_back(handle);
        state.materials.writeBytes(handle.index, std::span(records).subspan(i * bytes, bytes));
    }
    return okStatus();
}

// The key of a primitive of the package becomes a key of its material.
void addKey(SceneEditor::State& state, const package::PrimitiveEntry& entry, AttributeMask attributes) {
    EditedMaterial& material = *state.materialSlots.find(state.firstMaterials[entry.materialIndex]);
    if (std::ranges::find(material.keys, attributes, &MaterialKey::attributes) == material.keys.end()) {
        const std::uint64_t features = std::uint64_t{entry.featureInputs} << 32U | entry.featureLobes;
        material.keys.push_back({attributes, features, features, entry.geometryFlags});
    }
}

Status addMeshes(SceneEditor::State& state, const PackageScene& known, const SceneView& view) {
    std::vector<BlasInput> inputs;
    for (std::uint32_t first = 0; first < view.primitives.size();) {
        const std::uint32_t number = view.primitives[first].mesh;
        const PrimitiveRange range = primitivesOf(view.primitives, number);
        const std::span<const PrimitiveView> own = view.primitives.subspan(first, range.end - first);
        GLINT_TRY(auto mesh, makeMesh(state, own, &inputs));
        for (std::size_t i = 0; i < own.size(); ++i) {
            const package::PrimitiveEntry& entry = *known.findPrimitive(number, own[i].primitive);
            EditedMeshPrimitive& primitive = mesh.primitives[i];
            primitive.material = state.firstMaterials[entry.materialIndex];
            ++state.materialSlots.find(primitive.material)->uses;
            addKey(state, entry, primitive.attributes);
        }
        state.firstMeshes[number] = state.meshes.add(std::move(mesh));
        first = range.end;
    }
    BlasStatistics statistics;
    GLINT_TRY(auto built, addBlases(*state.upload, inputs, statistics));
    std::size_t next = 0;
    for (const auto& [number, handle] : state.firstMeshes) {
        std::vector<EditedMeshPrimitive>& primitives = state.meshes.find(handle)->primitives;
        for (std::size_t i = 0; i < primitives.size(); ++i) {
            for (std::size_t part = 0; part < primitives[i].parts.size(); ++part) {
                primitives[i].parts[part].blas = std::move(built[next++]);
                state.upload->compaction->parts.push_back({handle, i, part});
            }
            state.retired.add(std::move(primitives[i].device.buildInput));
        }
    }
    GpuScene::Statistics& scene = state.scene.statistics;
    scene.blasCount = static_cast<std::uint32_t>(built.size());
    scene.blasBytes = statistics.bytes;
    scene.blasUncompactedBytes = statistics.bytes;
    return okStatus();
}

}  // namespace

Status uploadEditable(GpuScene::State& scene, const Package& package, const PackageScene& known,
                      const SceneView& view, SceneUpload& upload, VkCommandBuffer commands) {
    GLINT_TRY_DO(checkEditable(view));
    auto owned = std::make_unique<SceneEditor::State>(scene, package, view);
    SceneEditor::State& state = *owned;
    scene.textureRoom = std::max({view.textureRoom, static_cast<std::uint32_t>(known.textures.size()), 1U});
    scene.samplerRoom = std::max({view.samplerRoom, static_cast<std::uint32_t>(known.samplers.size()), 1U});
    scene.shaderIds = state.cases.shaderIds();
    scene.materialLayout = state.layout;
    state.upload = &upload;
    state.uploader = upload.uploader.get();
    GLINT_TRY_DO(addSamplers(state, known));
    for (const auto step : {addTextures, addMaterials, addMeshes}) {
        GLINT_TRY_DO(step(state, known, view));
    }
    for (const InstanceView& instance : view.instances) {
        const auto mesh = state.firstMeshes.find(instance.mesh);
        if (mesh == state.firstMeshes.end()) {
            state.firstInstances.emplace_back();
            continue;
        }
        EditedInstance placed;
        placed.mesh = mesh->second;
        placed.objectToWorld = instance.objectToWorld;
        placed.visible = instance.visible;
        state.firstInstances.push_back(placeInstance(state, std::move(placed)));
    }
    for (const LightView& light : view.lights) {
        state.firstLights.push_back(state.lightSlots.add(light));
        state.lightOrder.push_back(state.firstLights.back());
    }
    GLINT_TRY_DO(createSetLayout(scene));
    GLINT_TRY_DO(recordEdits(state, commands, upload.frame));
    for (RecordStore* const store : {&state.geometries, &state.instances, &state.materials, &state.lights,
                                     &state.lightNodes, &state.emitters, &state.firstEmitters}) {
        store->firstCapacity = store->capacity;
    }
    state.firstTlasCapacity = state.tlasCapacity;
    state.ownUploader = Uploader::createDeferred(scene.context, scene.pool);
    state.uploader = state.ownUploader.get();
    state.upload = nullptr;
    scene.editor = SceneEditor::create(std::move(owned));
    return okStatus();
}

}  // namespace glint
