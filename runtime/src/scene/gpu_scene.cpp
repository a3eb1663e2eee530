// GpuScene: the steps of an upload.
#include "context/commands.h"
#include "context/resources.h"
#include "data/deformer.h"
#include "data/instance_math.h"
#include "data/materials.h"
#include "data/opacity_split.h"
#include "data/scene_checks.h"
#include "data/traversal_order.h"
#include "package/package.h"
#include "scene/gpu_scene_state.h"
#include "scene/scene_editor.h"
#include "scene/scene_motion.h"
#include "scene/scene_package.h"
#include "scene/texture_stream.h"

#include <chrono>
#include <utility>

namespace glint {
namespace {

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

// Uploads records that a replacement may copy from.
template <typename T>
Status uploadRecords(GpuScene::State& state, Uploader& uploader, std::span<const T> records, Buffer& target) {
    return glint::uploadRecords(state.context, state.pool, uploader, records, target,
                                VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
}

// Makes the hierarchy over lights and emissive triangles, and the records of the triangles, in packages that
// have them.
Status uploadLightTree(GpuScene::State& state, const Package& package, const SceneView& scene,
                       Uploader& uploader, std::span<const gpu::LightRecord> lights, std::size_t geometries) {
    const std::vector<EmitterBounds> bounds = state.emitters.boundsAt(scene.instances);
    state.emitterCount = static_cast<std::uint32_t>(bounds.size());
    if (package.lightSamples() > 0) {
        state.lightTree = buildLightTree(lights, bounds, scene.moves);
        const std::span<const gpu::LightNode> nodes(state.lightTree.nodes);
        GLINT_TRY_DO(uploadRecords(state, uploader, nodes, state.lightNodes));
        state.emitters.setLeaves(state.lightTree);
    } else {
        state.emitters.setLeaves(bounds);
    }
    if (package.emission() == nullptr) {
        return okStatus();
    }
    const std::span<const gpu::EmitterRecord> records(state.emitters.records);
    GLINT_TRY_DO(uploadRecords(state, uploader, records, state.emitterRecords));
    const std::vector<std::uint32_t> firsts = state.emitters.firstsOf(geometries);
    if (!scene.moves) {
        state.emitters = {};
    }
    return uploadRecords(state, uploader, std::span<const std::uint32_t>(firsts), state.firstEmitters);
}

// Makes one image for each TextureEntry, in their order. There is at least one image, so that the array is
// never empty.
Status uploadTextures(GpuScene::State& state, Uploader& uploader,
                      std::span<const package::TextureEntry> textures, std::span<const ImageView> images) {
    GLINT_TRY_DO(checkTextureCount(state.context, textures.size()));
    for (const package::TextureEntry& texture : textures) {
        GLINT_TRY(auto image,
                  uploadSceneTexture(state, uploader, static_cast<std::uint32_t>(state.textures.size()),
                                     images[texture.image], texture.srgb != 0));
        state.textures.push_back(std::move(image));
    }
    if (state.textures.empty()) {
        GLINT_TRY(auto image, uploadTexture(state.context, state.pool, uploader, {1, 1, kWhiteTexel}, false));
        state.textures.push_back(std::move(image));
    }
    return okStatus();
}

Status uploadMicromaps(GpuScene::State& state, SceneUpload& upload, const DecidedTriangles& decided) {
    if (decided.micromaps.empty()) {
        return okStatus();
    }
    std::vector<opacity::MicromapArray> arrays;
    for (const auto& [primitive, array] : decided.micromaps) {
        arrays.push_back(array);
    }
    GLINT_TRY(auto made, addMicromaps(upload, state.pool, arrays));
    std::size_t next = 0;
    for (const auto& [primitive, array] : decided.micromaps) {
        state.statistics.micromapBytes += made[next].bytes;
        state.micromaps.emplace(primitive, std::move(made[next++]));
    }
    state.statistics.micromaps = static_cast<std::uint32_t>(state.micromaps.size());
    return okStatus();
}

// Makes `deformer` if an instance changes its shape.
Status uploadData(GpuScene::State& state, const Package& package, const SceneView& scene,
                  std::span<const GridPositions> positions, SceneUpload& upload, SceneLayout& layout,
                  std::unique_ptr<Deformer>& deformer) {
    const PackageScene known = package.scene(scene.packageScene);
    Uploader& uploader = *upload.uploader;
    std::vector<std::uint8_t> materials = materialsWithSizes(state.context, known, scene.images);
    Result<std::vector<ChangingMaterial>> changing =
        replaceMaterials(scene.materials, known.materials, materials);
    state.materialLayout = known.materials.part(0, 0);
    if (!changing) {
        return changing.error();
    }
    BlasCapacity capacity = blasCapacity(state.context);
    const LeafOrder leafOrder = leafOrderFor(state.context, scene.traversalOrder);
    const Clock::time_point beginProof = Clock::now();
    // The indices of micromaps are in the order of the triangles, which an order of leaves would change.
    const std::uint32_t level = leafOrder == nullptr ? micromapLevel(state.context) : 0;
    DecidedTriangles decided = decideTriangles(package, known, scene, materials, capacity, level);
    state.statistics.opacityMs = millisecondsSince(beginProof);
    state.statistics.maskedTriangles = decided.tested;
    state.statistics.provedOpaque = decided.opaque;
    state.statistics.provedTransparent = decided.transparent;
    GLINT_TRY_DO(uploadMicromaps(state, upload, decided));
    std::vector<std::vector<std::uint32_t>> ordered = std::move(decided.sorted);
    if (leafOrder != nullptr) {
        const Clock::time_point begin = Clock::now();
        capacity = orderedCapacity(capacity);
        ordered = orderedTriangles(scene.primitives, capacity, leafOrder, ordered, decided.splits);
        state.statistics.orderMs = millisecondsSince(begin);
    }
    GLINT_TRY(state.primitives,
              uploadPrimitives(state.context, state.pool, uploader, package, known, scene.primitives,
                               positions, {scene.vertices, capacity.triangles, &upload.pool}, ordered));
    if (hasDeformedInstance(scene)) {
        GLINT_TRY(deformer, Deformer::create(state.context, package, scene, state.primitives, uploader,
                                             state.pool, state.deformed));
    }
    GLINT_TRY(layout, layOutScene(known, scene, state.primitives, capacity, state.deformed.addresses,
                                  decided.splits));
    if (leafOrder != nullptr) {
        const Clock::time_point begin = Clock::now();
        state.instanceOrder = std::make_unique<InstanceOrder>(scene.primitives, layout.parts, leafOrder);
        layout.partInstances = permuted<PartInstance>(
            layout.partInstances, state.instanceOrder->at(scene.instances, layout.partInstances));
        state.statistics.orderMs += millisecondsSince(begin);
    }
    for (std::size_t i = 0; i < layout.geometries.size(); ++i) {
        const gpu::GeometryRecord& geometry = layout.geometries[i];
        const std::uint32_t primitive = layout.primitives[i];
        const PrimitiveView& view = scene.primitives[primitive];
        state.shaderIds.push_back(geometry.shaderId);
        state.places.push_back({geometry.instanceIndex, view.mesh, view.primitive});
        if (!state.deformed.addresses.empty()) {
            const bool deforms = state.deformed.addresses.contains({geometry.instanceIndex, primitive});
            state.geometryPositions.push_back(
                {geometry.positions, deforms ? state.primitives[primitive].vertexCount : 0});
        }
    }
    const std::vector<gpu::LightRecord> lights = makeLightRecords(scene.lights);
    state.lightCount = static_cast<std::uint32_t>(lights.size());

    using Geometries = std::span<const gpu::GeometryRecord>;
    using Instances = std::span<const gpu::InstanceRecord>;
    using Lights = std::span<const gpu::LightRecord>;
    using Materials = std::span<const std::uint8_t>;
    GLINT_TRY_DO(uploadRecords(state, uploader, Geometries(layout.geometries), state.geometries));
    GLINT_TRY_DO(uploadRecords(state, uploader, Instances(layout.instances), state.instances));
    state.package = describePackage(package, scene, layout, *changing);
    for (const auto& [primitive, split] : decided.splits) {
        const std::uint32_t entry = state.package.entryOfUploaded[primitive];
        state.package.decided.push_back(
            {entry, alphaInputs(*package.opacity(), tableWith(known.materials, materials),
                                known.primitives[entry])});
    }
    if (scene.moves) {
        state.changing = std::move(*changing);
    }
    GLINT_TRY_DO(uploadRecords(state, uploader, Materials(materials), state.materials));
    GLINT_TRY_DO(uploadRecords(state, uploader, Lights(lights), state.lights));
    if (package.emission() != nullptr) {
        state.emitters =
            emittersOf(package, known, scene, layout, state.deformed.addresses, ordered, materials);
    }
    GLINT_TRY_DO(uploadLightTree(state, package, scene, uploader, lights, layout.geometries.size()));
    GLINT_TRY_DO(uploadTextures(state, uploader, known.textures, scene.images));
    state.statistics.narrowedTextures = countNarrowed(state.context, known.textures, scene.images);
    return okStatus();
}

// Computes the vertices of the scene's first pose, before structures are built from them.
void deformOnce(SceneUpload& upload, const Deformer& deformer, std::size_t instances) {
    upload.uploader->add([&context = upload.context, &deformer, instances](VkCommandBuffer commands) {
        deformer.recordPose(commands);
        recordDependency(context, commands, kAllToAll);
        deformer.recordDeform(commands, std::vector<bool>(instances, true));
    });
}

BlasInput makeInput(const GpuScene::State& state, const PackageScene& known, const SceneView& scene,
                    const MeshPart& part, bool dataAccess) {
    BlasInput input;
    input.dataAccess = dataAccess;
    input.updatable = scene.moves && part.instance.has_value();
    for (const TriangleRange& range : part.ranges) {
        const PrimitiveView& view = scene.primitives[range.primitive];
        const std::uint32_t flags = known.findPrimitive(view.mesh, view.primitive)->geometryFlags;
        const GpuPrimitive& primitive = state.primitives[range.primitive];
        BlasGeometry& geometry =
            input.geometries.emplace_back(blasGeometry(primitive, range.first, range.count));
        if (part.instance) {
            const auto own = state.deformed.addresses.find({*part.instance, range.primitive});
            geometry.positions =
                own == state.deformed.addresses.end() ? geometry.positions : own->second.positions;
        }
        const auto micromap = state.micromaps.find(range.primitive);
        geometry.opaque =
            range.opaque || (flags & (gpu::kGeometryAlphaTested | gpu::kGeometryPassesLight)) == 0;
        geometry.once = (flags & gpu::kGeometryPassesLight) != 0;
        if (!geometry.opaque && micromap != state.micromaps.end()) {
            geometry.micromap = &micromap->second;
        }
    }
    return input;
}

// Builds the BLASes that stay as they are. createMotion() builds those that move.
Status buildBottomLevels(GpuScene::State& state, SceneUpload& upload, const PackageScene& known,
                         const SceneView& scene, const SceneLayout& layout, bool dataAccess,
                         std::vector<BlasInput>& refitted) {
    std::vector<BlasInput> inputs;
    std::vector<std::size_t> parts;
    for (std::size_t i = 0; i < layout.parts.size(); ++i) {
        BlasInput input = makeInput(state, known, scene, layout.parts[i], dataAccess);
        if (input.updatable) {
            refitted.push_back(std::move(input));
        } else {
            parts.push_back(i);
            inputs.push_back(std::move(input));
        }
    }
    BlasStatistics statistics;
    GLINT_TRY(state.blases, addBlases(upload, inputs, statistics));
    state.partBlases.resize(layout.parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i) {
        state.partBlases[parts[i]] = state.blases[i].address;
    }
    state.statistics.blasCount = static_cast<std::uint32_t>(state.blases.size());
    state.statistics.blasBytes = statistics.bytes;
    state.statistics.blasUncompactedBytes = statistics.bytes;
    return okStatus();
}

Status buildTopLevel(GpuScene::State& state, SceneUpload& upload, const SceneView& scene,
                     const SceneLayout& layout) {
    std::vector<VkAccelerationStructureInstanceKHR> instances;
    for (const PartInstance& placed : layout.partInstances) {
        instances.push_back(makePlaced(layout.parts[placed.part].doubleSided, placed,
                                       scene.instances[placed.instance].objectToWorld,
                                       state.partBlases[placed.part]));
    }
    GLINT_TRY(state.tlas, addTlas(upload, state.pool, instances));
    if (upload.compaction) {
        upload.compaction->placed = std::move(instances);
    }
    return okStatus();
}

// Queues the upload of a scene that is not edited.
Status uploadStill(GpuScene::State& state, const Package& package, const PackageScene& known,
                   const SceneView& given, SceneUpload& upload) {
    // Everything that is made from positions uses those that the device reads.
    const std::vector<GridPositions> positions = packPositions(given.primitives, given.vertices);
    const std::vector<PrimitiveView> primitives = withPositions(given.primitives, positions);
    SceneView scene = given;
    scene.primitives = primitives;
    SceneLayout layout;
    std::unique_ptr<Deformer> deformer;
    GLINT_TRY_DO(uploadData(state, package, scene, positions, upload, layout, deformer));
    if (deformer) {
        deformOnce(upload, *deformer, scene.instances.size());
    }
    std::vector<BlasInput> refitted;
    GLINT_TRY_DO(buildBottomLevels(state, upload, known, scene, layout, package.positionFetch(), refitted));
    if (scene.moves) {
        GLINT_TRY_DO(createMotion(state, scene, layout, refitted, std::move(deformer), *upload.uploader));
    } else {
        GLINT_TRY_DO(buildTopLevel(state, upload, scene, layout));
        upload.deformer = std::move(deformer);
    }
    for (GpuPrimitive& primitive : state.primitives) {
        upload.keep(std::move(primitive.buildInput));
    }
    GLINT_TRY(state.samplers, createSamplers(state.context, known.samplers));
    GLINT_TRY_DO(createSceneSet(state));
    state.statistics.triangles = layout.triangles;
    state.statistics.geometries = static_cast<std::uint32_t>(layout.geometries.size());
    state.statistics.instances = static_cast<std::uint32_t>(layout.instances.size());
    if (!state.motion) {
        state.batches = batchDraws(layout.draws);
    }
    return okStatus();
}

}  // namespace

namespace {

// Makes a scene and records its upload. If its staging memory would exceed `mostStaged`, parts of the upload
// are submitted and waited for.
Result<std::unique_ptr<GpuScene::State>> makeScene(Context& context, const Package& package,
                                                   const SceneView& scene, VkCommandBuffer commands,
                                                   std::uint64_t frame, VkDeviceSize mostStaged) {
    Context::State& contextState = context.state();
    const bool hasNothing = scene.editable && scene.packageScene == kNoPackageScene;
    if (!hasNothing && scene.packageScene >= package.sceneCount()) {
        return makeError("scene-package", "",
                         "scene " + std::to_string(scene.packageScene) +
                             " is not in the package, which has " + std::to_string(package.sceneCount()),
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
    if (scene.editable) {
        GLINT_TRY_DO(uploadEditable(*state, package, known, scene, upload, commands));
    } else {
        GLINT_TRY_DO(uploadStill(*state, package, known, scene, upload));
        for (Buffer& staging : upload.uploader->record(commands)) {
            upload.keep(std::move(staging));
        }
        recordDependency(contextState, commands, kAllToAll);
    }
    state->package.records = recordsHash(package, known);
    state->compaction = std::move(upload.compaction);
    return state;
}

// Device times of the builds. They are for people, so an error leaves them at 0.
void readTimes(GpuScene::State& state) {
    const SceneUpload& upload = *state.upload;
    if (upload.timer && upload.timer->available()) {
        if (const Result<std::vector<double>> times = upload.timer->read(upload.stretches)) {
            state.statistics.blasBuildMs = (*times)[SceneUpload::kBlasStretch];
            state.statistics.tlasBuildMs = times->size() > 1 ? (*times)[SceneUpload::kTlasStretch] : 0.0;
        }
    }
    if (state.motion) {
        readFirstBuild(state);
    }
}

// The staging memory of a blocking upload.
constexpr VkDeviceSize kMostStaged = VkDeviceSize{64} << 20;

}  // namespace

Result<std::unique_ptr<GpuScene>> GpuScene::record(Context& context, const Package& package,
                                                   const SceneView& scene, VkCommandBuffer commands,
                                                   std::uint64_t frame) {
    GLINT_TRY(auto state, makeScene(context, package, scene, commands, frame, Uploader::kUnlimited));
    return std::unique_ptr<GpuScene>(new GpuScene(std::move(state)));
}

Result<std::unique_ptr<GpuScene>> GpuScene::upload(Context& context, const Package& package,
                                                   const SceneView& scene) {
    Result<std::unique_ptr<GpuScene>> uploaded =
        makeOnce(context.state(), [&](VkCommandBuffer commands) -> Result<std::unique_ptr<GpuScene>> {
            GLINT_TRY(auto state, makeScene(context, package, scene, commands, 0, kMostStaged));
            return std::unique_ptr<GpuScene>(new GpuScene(std::move(state)));
        });
    if (!uploaded || !(*uploaded)->state_->compaction) {
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

GpuScene::State::State(Context::State& contextState) : context(contextState), pool(contextState) {}
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
    if (state_->editor) {
        state_->editor->complete(frame);
    }
    if (state_->stream) {
        state_->stream->complete(frame);
    }
    if (state_->upload && state_->upload->frame <= frame) {
        readTimes(*state_);
        state_->upload.reset();
    }
    completeCompaction(*state_, frame);
}

bool GpuScene::isUploaded() const {
    return state_->upload == nullptr;
}

Result<bool> GpuScene::recordCompaction(VkCommandBuffer commands, std::uint64_t frame) {
    return glint::recordCompaction(*state_, commands, frame);
}

const GpuScene::Statistics& GpuScene::statistics() const {
    return state_->statistics;
}

Status GpuScene::update(VkCommandBuffer commands, const MotionView& motion) {
    return recordMotion(*state_, commands, motion);
}

Status GpuScene::updateAndWait(const MotionView& motion) {
    return runOnce(state_->context, [&](VkCommandBuffer commands) { return update(commands, motion); });
}

Result<MotionStatistics> GpuScene::motion() const {
    return readMotion(*state_);
}

GpuScene::State& GpuScene::state() {
    return *state_;
}

namespace {

void addMotion(std::vector<MemoryItem>& items, const SceneMotion& motion) {
    if (motion.deformer != nullptr) {
        motion.deformer->addMemory(items);
    }
    if (motion.blases != nullptr) {
        motion.blases->addMemory(items);
    }
    addTo(items, "instances of the top level", motion.placedBuffer);
    addTo(items, "scratch of structures", motion.tlasScratch.buffer);
    addTo(items, "poses on their way", motion.staging);
}

void addEditor(std::vector<MemoryItem>& items, const SceneEditor::State& editor) {
    editor.meshes.forEach([&](MeshHandle /*handle*/, const EditedMesh& mesh) {
        for (const EditedMeshPrimitive& primitive : mesh.primitives) {
            addTo(items, "vertices and indices", primitive.device.buffer);
            for (const EditedPart& part : primitive.parts) {
                addTo(items, "bottom levels", part.blas.buffer);
            }
        }
    });
    addTo(items, "textures", editor.white);
    addTo(items, "scratch of structures", editor.tlasScratch.buffer);
    for (const Buffer& staging : editor.uploader->staging()) {
        addTo(items, "edits on their way", staging);
    }
    if (editor.retired.count() > 0) {
        addTo(items,
              {"retired by edits", MemoryUse::Device, false, editor.retired.count(), editor.retired.bytes()});
    }
}

}  // namespace

std::vector<MemoryItem> GpuScene::memory() const {
    std::vector<MemoryItem> items;
    for (const GpuPrimitive& primitive : state_->primitives) {
        addTo(items, "vertices and indices", primitive.buffer);
    }
    for (const Buffer& buffer : state_->deformed.buffers) {
        addTo(items, "deformed vertices", buffer);
    }
    for (const DeviceImage& texture : state_->textures) {
        addTo(items, "textures", texture);
    }
    if (state_->stream != nullptr) {
        addTo(items, {"levels on their way", MemoryUse::Upload, false, 1, state_->stream->retiredBytes()});
    }
    for (const AccelerationStructure& blas : state_->blases) {
        addTo(items, "bottom levels", blas.buffer);
    }
    for (const auto& [primitive, micromap] : state_->micromaps) {
        addTo(items, "opacity micromaps", micromap.buffer);
        addTo(items, "opacity micromaps", micromap.indices);
    }
    addTo(items, "top level", state_->tlas.buffer);
    addTo(items, "geometry records", state_->geometries);
    addTo(items, "instance records", state_->instances);
    addTo(items, "material records", state_->materials);
    addTo(items, "light records", state_->lights);
    if (state_->lightNodes.address != 0) {
        addTo(items, "light nodes", state_->lightNodes);
    }
    if (state_->emitterRecords.address != 0) {
        addTo(items, "emissive triangles", state_->emitterRecords);
        addTo(items, "emissive triangles", state_->firstEmitters);
    }
    if (state_->motion != nullptr) {
        addMotion(items, *state_->motion);
    }
    if (state_->upload != nullptr) {
        for (const Buffer& buffer : state_->upload->kept) {
            addTo(items, "upload on its way", buffer);
        }
    }
    if (state_->compaction != nullptr) {
        for (const AccelerationStructure& blas : state_->compaction->replaced) {
            addTo(items, "bottom levels before compaction", blas.buffer);
        }
    }
    if (state_->editor != nullptr) {
        addEditor(items, state_->editor->state());
    }
    return items;
}

std::uint64_t GpuScene::allocatedBytes() const {
    const SceneMotion* const motion = state_->motion.get();
    std::uint64_t bytes = state_->pool.bytes();
    bytes += state_->package.pool != nullptr ? state_->package.pool->bytes() : 0;
    bytes += state_->upload != nullptr ? state_->upload->pool.bytes() : 0;
    bytes += state_->compaction != nullptr ? state_->compaction->pool.bytes() : 0;
    if (motion != nullptr) {
        bytes +=
            motion->pool.bytes() + (motion->deformer != nullptr ? motion->deformer->allocatedBytes() : 0);
    }
    return bytes;
}

}  // namespace glint
