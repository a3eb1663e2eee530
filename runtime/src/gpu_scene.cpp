// GpuScene: the order of an upload.
#include "gpu_scene_state.h"
#include "instance_math.h"
#include "scene_checks.h"
#include "textures.h"

#include <cstring>
#include <utility>

namespace glint {
namespace {

// An array of records that shaders reach by address; never empty, so that the address is one.
template <typename T>
Status uploadRecords(GpuScene::State& state, Uploader& uploader, std::span<const T> records, Buffer& target) {
    Result<Buffer> buffer =
        createBuffer(state.context, state.pool, std::max(records.size_bytes(), sizeof(T)),
                     VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    if (!buffer) {
        return buffer.error();
    }
    target = std::move(*buffer);
    return uploader.copyToBuffer(bytesOf(records), target);
}

Status uploadData(GpuScene::State& state, const PackageScene& known, const SceneView& scene,
                  SceneLayout& layout) {
    Result<std::unique_ptr<Uploader>> uploader = Uploader::create(state.context);
    if (!uploader) {
        return uploader.error();
    }
    Result<std::vector<GpuPrimitive>> primitives =
        uploadPrimitives(state.context, state.pool, **uploader, scene.primitives);
    if (!primitives) {
        return primitives.error();
    }
    state.primitives = std::move(*primitives);
    Result<SceneLayout> laidOut = layOutScene(known, scene, state.primitives, blasCapacity(state.context));
    if (!laidOut) {
        return laidOut.error();
    }
    layout = std::move(*laidOut);
    for (const gpu::GeometryRecord& geometry : layout.geometries) {
        state.shaderIds.push_back(geometry.shaderId);
    }
    std::vector<gpu::LightRecord> lights;
    for (const LightView& light : scene.lights) {
        lights.push_back(makeLightRecord(light));
    }
    state.lightCount = static_cast<std::uint32_t>(lights.size());

    using Geometries = std::span<const gpu::GeometryRecord>;
    using Instances = std::span<const gpu::InstanceRecord>;
    using Lights = std::span<const gpu::LightRecord>;
    using Materials = std::span<const gpu::MaterialRecord>;
    if (Status s = uploadRecords(state, **uploader, Geometries(layout.geometries), state.geometries); !s) {
        return s;
    }
    if (Status s = uploadRecords(state, **uploader, Instances(layout.instances), state.instances); !s) {
        return s;
    }
    const std::vector<gpu::MaterialRecord> materials = materialsWithSizes(state.context, known, scene.images);
    if (Status s = uploadRecords(state, **uploader, Materials(materials), state.materials); !s) {
        return s;
    }
    if (Status s = uploadRecords(state, **uploader, Lights(lights), state.lights); !s) {
        return s;
    }
    Result<std::vector<DeviceImage>> textures =
        uploadTextures(state.context, state.pool, **uploader, known.textures, scene.images);
    if (!textures) {
        return textures.error();
    }
    state.textures = std::move(*textures);
    state.statistics.narrowedTextures = countNarrowed(state.context, known.textures, scene.images);
    return (*uploader)->finish();
}

Status buildBottomLevels(GpuScene::State& state, const PackageScene& known, const SceneView& scene,
                         const SceneLayout& layout, bool dataAccess) {
    std::vector<BlasInput> inputs;
    for (const MeshPart& part : layout.parts) {
        BlasInput input;
        input.dataAccess = dataAccess;
        for (const TriangleRange& range : part.ranges) {
            const PrimitiveView& view = scene.primitives[range.primitive];
            const std::uint32_t flags = known.findPrimitive(view.mesh, view.primitive)->geometryFlags;
            const GpuPrimitive& primitive = state.primitives[range.primitive];
            const VkDeviceAddress indices = primitive.indices + range.first * 3 * sizeof(std::uint32_t);
            input.geometries.push_back({primitive.positions, indices, primitive.vertexCount, range.count,
                                        (flags & gpu::kGeometryAlphaTested) == 0});
        }
        inputs.push_back(std::move(input));
    }
    BlasStatistics statistics;
    Result<std::vector<AccelerationStructure>> blases =
        buildBlases(state.context, state.pool, inputs, statistics);
    if (!blases) {
        return blases.error();
    }
    state.blases = std::move(*blases);
    state.statistics.blasCount = static_cast<std::uint32_t>(state.blases.size());
    state.statistics.blasBytes = statistics.bytes;
    state.statistics.blasUncompactedBytes = statistics.uncompactedBytes;
    state.statistics.blasBuildMs = statistics.buildMs;
    return okStatus();
}

VkAccelerationStructureInstanceKHR makeInstance(const GpuScene::State& state, const SceneView& scene,
                                                const SceneLayout& layout, const PartInstance& placed) {
    VkAccelerationStructureInstanceKHR instance{};
    const std::array<float, 12>& rows = scene.instances[placed.instance].objectToWorld;
    static_assert(sizeof(instance.transform) == sizeof(rows));
    std::memcpy(&instance.transform, rows.data(), sizeof(rows));
    // An instance mask of 8 bits, a custom index of 24: layOutScene() has seen that it fits.
    instance.instanceCustomIndex = placed.customIndex & 0xFFFFFFU;
    // Shader binding tables, where they have records, have one for each geometry record.
    instance.instanceShaderBindingTableRecordOffset = placed.customIndex & 0xFFFFFFU;
    instance.mask = 0xFF;
    // Facing is determined in object space, so that a mirroring transform changes nothing, and the default
    // is glTF's: a front is clockwise to a left-handed eye, which is counter-clockwise to a right-handed one.
    instance.flags = layout.parts[placed.part].doubleSided
                         ? VK_GEOMETRY_INSTANCE_TRIANGLE_FACING_CULL_DISABLE_BIT_KHR & 0xFFU
                         : 0U;
    instance.accelerationStructureReference = state.blases[placed.part].address;
    return instance;
}

Status buildTopLevel(GpuScene::State& state, const SceneView& scene, const SceneLayout& layout) {
    std::vector<VkAccelerationStructureInstanceKHR> instances;
    for (const PartInstance& placed : layout.partInstances) {
        instances.push_back(makeInstance(state, scene, layout, placed));
    }
    Result<AccelerationStructure> tlas =
        buildTlas(state.context, state.pool, instances, state.statistics.tlasBuildMs);
    if (!tlas) {
        return tlas.error();
    }
    state.tlas = std::move(*tlas);
    return okStatus();
}

}  // namespace

Result<std::unique_ptr<GpuScene>> GpuScene::upload(Context& context, const Package& package,
                                                   const SceneView& scene) {
    Context::State& contextState = context.state();
    if (scene.packageScene >= package.sceneCount()) {
        return makeError("scene-package", "",
                         "scene " + std::to_string(scene.packageScene) +
                             " is not in the package, which has " + std::to_string(package.sceneCount()),
                         "find its index by Package::findScene()");
    }
    if (package.positionFetch() && !contextState.handles.positionFetch) {
        return makeError(
            "position-fetch", "",
            "the package's shaders read positions from acceleration structures, which the device does "
            "not allow or was not created for",
            "create it with VK_KHR_ray_tracing_position_fetch and set DeviceHandles::positionFetch, or "
            "compile without --position-fetch");
    }
    const PackageScene known = package.scene(scene.packageScene);
    if (Status s = checkScene(known, scene, contextState.limits.core.maxImageDimension2D); !s) {
        return s.error();
    }
    auto state = std::make_unique<State>(contextState);
    SceneLayout layout;
    if (Status s = uploadData(*state, known, scene, layout); !s) {
        return s.error();
    }
    if (Status s = buildBottomLevels(*state, known, scene, layout, package.positionFetch()); !s) {
        return s.error();
    }
    if (Status s = buildTopLevel(*state, scene, layout); !s) {
        return s.error();
    }
    Result<std::vector<UniqueSampler>> samplers = createSamplers(contextState, known.samplers);
    if (!samplers) {
        return samplers.error();
    }
    state->samplers = std::move(*samplers);
    if (Status s = createSceneSet(*state); !s) {
        return s.error();
    }
    state->statistics.triangles = layout.triangles;
    state->statistics.geometries = static_cast<std::uint32_t>(layout.geometries.size());
    state->statistics.instances = static_cast<std::uint32_t>(layout.instances.size());
    state->draws = std::move(layout.draws);
    return std::unique_ptr<GpuScene>(new GpuScene(std::move(state)));
}

GpuScene::GpuScene(std::unique_ptr<State> state) : state_(std::move(state)) {}
GpuScene::~GpuScene() = default;

const GpuScene::Statistics& GpuScene::statistics() const {
    return state_->statistics;
}

GpuScene::State& GpuScene::state() {
    return *state_;
}

}  // namespace glint
