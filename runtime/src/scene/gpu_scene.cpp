// GpuScene: uploads, descriptor set 0, and what programs and renderers see of a scene.
#include "context/commands.h"
#include "context/device_objects.h"
#include "context/parallel.h"
#include "context/vulkan_table.h"
#include "data/scene_checks.h"
#include "interop/frame.h"
#include "package/package.h"
#include "scene/scene_store.h"
#include "scene/texture_stream.h"

#include <algorithm>
#include <array>
#include <utility>

namespace glint {
namespace {

// Makes a scene and records its upload. If its staging memory would exceed `mostStaged`, parts of the upload
// are submitted and waited for.
Result<std::unique_ptr<GpuScene::State>> makeScene(Context& context, const Package& package,
                                                   const SceneView& scene, VkCommandBuffer commands,
                                                   std::uint64_t frame, VkDeviceSize mostStaged) {
    Context::State& contextState = context.state();
    const bool hasNothing = scene.editable && scene.packageScene == kNoPackageScene;
    if (!hasNothing && scene.packageScene >= package.sceneCount()) {
        return makeError(
            "scene-package", "",
            phrase("scene ", scene.packageScene, " is not in the package, which has ", package.sceneCount()),
            "find its index by Package::findScene()");
    }
    GLINT_TRY_DO(checkDevice(package, contextState.handles));
    const PackageScene known = hasNothing ? PackageScene{} : package.scene(scene.packageScene);
    GLINT_TRY_DO(checkScene(package, known, scene, imageLimits(contextState)));
    auto state = std::make_unique<GpuScene::State>(contextState);
    state->origin = scene.origin;
    state->upload = std::make_unique<SceneUpload>(contextState, mostStaged);
    SceneUpload& upload = *state->upload;
    upload.frame = frame;
    if (scene.streamsTextures) {
        state->stream = std::make_unique<TextureStream>(
            std::make_unique<TextureStream::State>(*state, scene.firstTexels));
        state->stream->state().lastFrame = frame;
    }
    GLINT_TRY_DO(uploadScene(*state, package, known, scene, upload, commands));
    if (scene.editable) {
        state->editor = std::make_unique<SceneEditor>(*state->store);
    }
    return state;
}

// Device times of the builds. They are for people, so an error leaves them at 0.
void readBuildTimes(GpuScene::State& state) {
    const SceneStore& store = *state.store;
    if (!store.posed && store.timer->available()) {
        if (const Result<std::vector<double>> times = readTimes(store)) {
            state.statistics.blasBuildMs = (*times)[1];
            state.statistics.tlasBuildMs = (*times)[2];
        }
    }
}

// The staging memory of a blocking upload.
constexpr VkDeviceSize kMostStaged = VkDeviceSize{64} << 20;

}  // namespace

Result<std::unique_ptr<GpuScene>> GpuScene::record(Context& context, const Package& package,
                                                   const SceneView& scene, VkCommandBuffer commands,
                                                   std::uint64_t frame) try {
    GLINT_TRY(auto state, makeScene(context, package, scene, commands, frame, Uploader::kUnlimited));
    return std::unique_ptr<GpuScene>(new GpuScene(std::move(state)));
}
GLINT_CATCH

Result<std::unique_ptr<GpuScene>> GpuScene::upload(Context& context, const Package& package,
                                                   const SceneView& scene) try {
    Result<std::unique_ptr<GpuScene>> uploaded =
        makeOnce(context.state(), [&](VkCommandBuffer commands) -> Result<std::unique_ptr<GpuScene>> {
            GLINT_TRY(auto state, makeScene(context, package, scene, commands, 0, kMostStaged));
            return std::unique_ptr<GpuScene>(new GpuScene(std::move(state)));
        });
    if (!uploaded || (*uploaded)->state_->store->compactions.empty()) {
        return uploaded;
    }
    const Status compacted = runOnce(context.state(), [&](VkCommandBuffer commands) -> Status {
        const Result<bool> recorded = (*uploaded)->recordCompaction(commands, 0);
        return recorded ? okStatus() : Status(recorded.error());
    });
    if (!compacted) {
        return compacted.error();
    }
    (*uploaded)->complete(0);
    return uploaded;
}
GLINT_CATCH

GpuScene::State::State(Context::State& contextState)
    : DrawnScene(contextState),
      pool(contextState),
      brief(contextState, "scene", MemoryPool::Use::EachFrame) {}
GpuScene::State::~State() = default;

GpuScene::GpuScene(std::unique_ptr<State> state) : state_(std::move(state)) {}
GpuScene::~GpuScene() = default;

SceneEditor* GpuScene::editor() {
    return state_->editor.get();
}

TextureStream* GpuScene::textureStream() {
    return state_->stream.get();
}

VkDescriptorSet GpuScene::descriptorSet() const {
    return state_->set;
}

VkDescriptorSetLayout GpuScene::descriptorSetLayout() const {
    return state_->setLayout.get();
}

void GpuScene::complete(std::uint64_t frame) {
    completeFrames(*state_->store, frame);
    if (state_->stream) {
        state_->stream->complete(frame);
    }
    if (state_->upload && state_->upload->frame <= frame) {
        readBuildTimes(*state_);
        state_->upload.reset();
    }
}

bool GpuScene::isUploaded() const {
    return state_->upload == nullptr;
}

const GpuScene::Statistics& GpuScene::statistics() const {
    return state_->statistics;
}

Status GpuScene::updateAndWait(const MotionView& motion) try {
    const std::uint64_t frame = state_->store->lastFrame;
    GLINT_TRY_DO(
        runOnce(state_->context, [&](VkCommandBuffer commands) { return update(commands, motion, frame); }));
    complete(frame);
    return okStatus();
}
GLINT_CATCH

GpuScene::State& GpuScene::state() {
    return *state_;
}

namespace {

void addStore(std::vector<MemoryItem>& items, const SceneStore& store) {
    store.meshes.forEach([&](MeshHandle /*handle*/, const StoredMesh& mesh) {
        for (const StoredPrimitive& primitive : mesh.primitives) {
            addTo(items, "vertices and indices", primitive.device.buffer);
            addTo(items, "targets and influences", primitive.source.buffer);
        }
        for (const StoredPart& part : mesh.parts) {
            addTo(items, "bottom levels", part.blas.buffer);
        }
        for (const std::unique_ptr<SealedForm>& form : mesh.forms) {
            for (const SealedRun& run : form->runs) {
                addTo(items, "bottom levels", run.blas.buffer);
            }
        }
    });
    store.instanceSlots.forEach([&](InstanceHandle /*handle*/, const StoredInstance& instance) {
        if (instance.shape != nullptr) {
            for (const DeformedVertices& vertices : instance.shape->vertices) {
                addTo(items, "deformed vertices", vertices.buffer);
            }
            for (const AccelerationStructure& blas : instance.shape->blases) {
                addTo(items, store.keeps() ? "refitted bottom levels" : "bottom levels", blas.buffer);
            }
        }
    });
    addTo(items, "textures", store.white);
    addTo(items, "poses", store.poses.device);
    addTo(items, "deform records", store.deforms.device);
    addTo(items, "instances of the top level", store.topLevel.records().device);
    addTo(items, "scratch of structures", store.tlasScratch.buffer);
    for (const Buffer& staging : store.uploader->staging()) {
        addTo(items, "changes on their way", staging);
    }
    if (store.retired.count() > 0) {
        addTo(items,
              {"retired by changes", MemoryUse::Device, false, store.retired.count(), store.retired.bytes()});
    }
}

}  // namespace

std::vector<MemoryItem> GpuScene::memory() const {
    std::vector<MemoryItem> items;
    const SceneStore& store = *state_->store;
    addStore(items, store);
    for (const DeviceImage& texture : state_->textures) {
        addTo(items, "textures", texture);
    }
    if (state_->stream != nullptr) {
        addTo(items, {"levels on their way", MemoryUse::Upload, false, 1, state_->stream->retiredBytes()});
    }
    for (const auto& [primitive, micromap] : state_->micromaps) {
        addTo(items, "opacity micromaps", micromap.buffer);
        addTo(items, "opacity micromaps", micromap.indices);
    }
    addTo(items, "top level", state_->tlas.buffer);
    addTo(items, "geometry records", store.geometries.device);
    addTo(items, "instance records", store.instances.device);
    addTo(items, "material records", store.materials.device);
    addTo(items, "light records", store.lights.device);
    addTo(items, "light nodes", store.lightNodes.device);
    addTo(items, "emissive triangles", store.emitterRecords.device);
    addTo(items, "emissive triangles", store.firstEmitters.device);
    if (state_->upload != nullptr) {
        for (const Buffer& buffer : state_->upload->kept) {
            addTo(items, "upload on its way", buffer);
        }
    }
    return items;
}

std::uint64_t GpuScene::allocatedBytes() const {
    std::uint64_t bytes = state_->pool.bytes() + state_->brief.bytes() + state_->store->building.bytes();
    bytes += state_->upload != nullptr ? state_->upload->pool.bytes() : 0;
    return bytes;
}

void fillScene(const GpuScene::State& state, gpu::FrameConstants& constants) {
    state.store->fill(constants);
}

const Buffer& instanceRecords(const GpuScene::State& state) {
    return state.store->instances.device;
}

void GpuScene::State::partBlases() {
    glint::partBlases(*store);
}

bool isChanging(const GpuScene::State& state) {
    return state.store->keeps();
}

std::uint64_t shapeVersion(const GpuScene::State& state) {
    return state.store->shapeVersion;
}

std::vector<GeometryPositions> geometryPositions(const GpuScene::State& state) {
    const SceneStore& store = *state.store;
    std::vector<GeometryPositions> places;
    if (store.shaped.empty()) {
        return places;
    }
    for (std::uint32_t i = 0; i < store.geometries.count(); ++i) {
        places.push_back({store.geometries.read<gpu::GeometryRecord>(i).positions});
    }
    for (const std::uint32_t index : store.shaped) {
        const StoredInstance& instance = store.instanceSlots.at(index);
        forEachGeometry(*store.meshes.find(instance.mesh), instance,
                        [&](const TriangleRange& range, const StoredPrimitive& primitive, std::uint32_t own) {
                            const DeformedVertices& vertices = instance.shape->vertices[range.primitive];
                            if (vertices.positions != 0) {
                                places[own].vertexCount = primitive.device.vertexCount;
                                places[own].buffer = vertices.buffer.handle.get();
                                places[own].offset = vertices.positions - vertices.buffer.address;
                            }
                        });
    }
    return places;
}

std::optional<GeometryPlace> placeOf(const GpuScene::State& state, std::uint32_t geometry) {
    const SceneStore& store = *state.store;
    std::optional<GeometryPlace> place;
    if (geometry >= store.geometries.count()) {
        return place;
    }
    const auto record = store.geometries.read<gpu::GeometryRecord>(geometry);
    const std::uint32_t index = record.instanceIndex;
    if (!store.instanceSlots.has(index)) {
        return place;
    }
    const StoredInstance& instance = store.instanceSlots.at(index);
    forEachGeometry(*store.meshes.find(instance.mesh), instance,
                    [&](const TriangleRange& range, const StoredPrimitive& primitive, std::uint32_t own) {
                        if (own == geometry) {
                            const bool isEntry = !store.editable;
                            place = GeometryPlace{store.instanceSlots.handleAt(index),
                                                  isEntry ? primitive.entry.mesh : instance.mesh.index,
                                                  isEntry ? primitive.entry.primitive : range.primitive,
                                                  record.shaderId};
                        }
                    });
    return place;
}

// --- Descriptor set 0: the acceleration structure, textures, samplers ---

namespace {

constexpr std::size_t kBindings = 3;

SceneSetSize sizeOf(const GpuScene::State& state) {
    return {std::max(state.textureRoom, static_cast<std::uint32_t>(state.textures.size())),
            std::max(state.samplerRoom, static_cast<std::uint32_t>(state.samplers.size())),
            state.textureRoom > 0};
}

std::array<VkDescriptorSetLayoutBinding, kBindings> makeBindings(const Context::State& context,
                                                                 const SceneSetSize& size) {
    const VkShaderStageFlags stages = VK_SHADER_STAGE_FRAGMENT_BIT | passStages(context);
    return {{{gpu::kBindingTlas, VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, 1, stages, nullptr},
             {gpu::kBindingTextures, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, size.textures, stages, nullptr},
             {gpu::kBindingSamplers, VK_DESCRIPTOR_TYPE_SAMPLER, size.samplers, stages, nullptr}}};
}

}  // namespace

Result<UniqueSetLayout> createSceneSetLayout(Context::State& context, const SceneSetSize& size) {
    const auto bindings = makeBindings(context, size);
    // Update-after-bind gives higher limits: devices that otherwise see 16 textures then see 500,000. A scene
    // with room has places without a texture or sampler.
    VkDescriptorBindingFlags room = 0;
    if (size.hasRoom) {
        room = VK_DESCRIPTOR_BINDING_PARTIALLY_BOUND_BIT;
    }
    const VkDescriptorBindingFlags arrays = VK_DESCRIPTOR_BINDING_UPDATE_AFTER_BIND_BIT | room;
    const VkDescriptorBindingFlags bindingFlags[kBindings] = {0, arrays, arrays};
    return createSetLayout(context, bindings, bindingFlags);
}

Status createSetLayout(GpuScene::State& state) {
    GLINT_TRY(state.setLayout, createSceneSetLayout(state.context, sizeOf(state)));
    return okStatus();
}

Result<DescriptorSet> makeSceneSet(const GpuScene::State& state, VkAccelerationStructureKHR tlas,
                                   VkImageView absent) {
    Context::State& context = state.context;
    GLINT_TRY(auto made,
              createSet(context, state.setLayout.get(), makeBindings(context, sizeOf(state)), true));
    std::vector<VkDescriptorImageInfo> textures;
    for (const DeviceImage& texture : state.textures) {
        const VkImageView view = texture.view.get() == VK_NULL_HANDLE ? absent : texture.view.get();
        textures.push_back({VK_NULL_HANDLE, view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
    }
    if (textures.empty()) {
        textures.push_back({VK_NULL_HANDLE, absent, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
    }
    std::vector<VkDescriptorImageInfo> samplers;
    for (const UniqueSampler& sampler : state.samplers) {
        samplers.push_back({sampler.get(), VK_NULL_HANDLE, VK_IMAGE_LAYOUT_UNDEFINED});
    }
    writeImages(context, made.set, gpu::kBindingTextures, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, textures);
    writeImages(context, made.set, gpu::kBindingSamplers, VK_DESCRIPTOR_TYPE_SAMPLER, samplers);
    const VkWriteDescriptorSetAccelerationStructureKHR structures{
        .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR,
        .accelerationStructureCount = 1,
        .pAccelerationStructures = &tlas};
    const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                     .pNext = &structures,
                                     .dstSet = made.set,
                                     .dstBinding = gpu::kBindingTlas,
                                     .descriptorCount = 1,
                                     .descriptorType = VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR};
    context.vk.UpdateDescriptorSets(context.handles.device, 1, &write, 0, nullptr);
    return made;
}

}  // namespace glint
