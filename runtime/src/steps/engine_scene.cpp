#include "steps/engine_scene.h"

#include "context/commands.h"
#include "context/upload.h"
#include "data/instance_math.h"
#include "data/materials.h"
#include "data/scene_checks.h"
#include "interop/frame.h"
#include "package/package.h"
#include "scene/gpu_scene_state.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <utility>

namespace glint {
namespace {

static_assert(static_cast<std::uint32_t>(RecordsBy::CustomIndexTable) == gpu::kRecordsByCustomIndexTable);
static_assert(static_cast<std::uint32_t>(RecordsBy::InstanceTable) == gpu::kRecordsByInstanceTable);

std::string geometryPlace(std::size_t index) {
    return "geometry " + std::to_string(index);
}

Diagnostic outOfRange(const std::string& where, const std::string& what, std::size_t value,
                      std::size_t count) {
    return makeError(
        "engine-scene", where,
        what + " " + std::to_string(value) + " is out of range, there are " + std::to_string(count),
        "give indices below the number of what they name");
}

struct NamedAddress {
    const char* name;
    VkDeviceAddress EngineGeometryView::*address;
    std::uint32_t input;  // the key bit that makes it necessary; 0: it always is
};
constexpr NamedAddress kAddresses[] = {{"indices", &EngineGeometryView::indices, 0},
                                       {"positions", &EngineGeometryView::positions, 0},
                                       {"normals", &EngineGeometryView::normals, kInputNormals},
                                       {"tangents", &EngineGeometryView::tangents, kInputTangents},
                                       {"texCoords0", &EngineGeometryView::texCoords0, kInputTexCoord0},
                                       {"texCoords1", &EngineGeometryView::texCoords1, kInputTexCoord1},
                                       {"colors", &EngineGeometryView::colors, kInputVertexColor}};

Status checkAddresses(const EngineGeometryView& view, const package::PrimitiveEntry& entry,
                      const std::string& where) {
    for (const NamedAddress& one : kAddresses) {
        const bool needed = one.input == 0 || (entry.featureInputs & one.input) != 0;
        if (needed && view.*one.address == 0) {
            return makeError("engine-scene", where,
                             std::string("the package's key reads ") + one.name + ", whose address is 0",
                             "give its address");
        }
    }
    return okStatus();
}

Result<std::vector<gpu::GeometryRecord>> makeGeometries(const PackageScene& known,
                                                        const EngineSceneView& scene) {
    std::vector<gpu::GeometryRecord> records;
    for (std::size_t i = 0; i < scene.geometries.size(); ++i) {
        const EngineGeometryView& view = scene.geometries[i];
        const package::PrimitiveEntry* const entry = known.findPrimitive(view.mesh, view.primitive);
        if (entry == nullptr) {
            return makeError("scene-package", geometryPlace(i),
                             "the package does not know primitive " + std::to_string(view.primitive) +
                                 " of mesh " + std::to_string(view.mesh),
                             "compile the package from the scene that is traced");
        }
        if (view.instance >= scene.instances.size()) {
            return outOfRange(geometryPlace(i), "instance", view.instance, scene.instances.size());
        }
        GLINT_TRY_DO(checkAddresses(view, *entry, geometryPlace(i)));
        gpu::GeometryRecord record = recordOf(*entry, view, view.instance);
        record.flags |= std::uint32_t{view.hostFlags} << gpu::kGeometryHostFlagsShift;
        records.push_back(record);
    }
    return records;
}

Result<std::vector<gpu::InstanceRecord>> makeInstances(std::span<const Rows> instances) {
    std::vector<gpu::InstanceRecord> records;
    for (std::size_t i = 0; i < instances.size(); ++i) {
        if (!std::ranges::all_of(instances[i], [](float value) { return std::isfinite(value); })) {
            return makeError("engine-scene", "instance " + std::to_string(i), "its transform is not finite",
                             "give twelve finite numbers");
        }
        records.push_back(makeInstanceRecord(instances[i]));
    }
    return records;
}

// Returns transforms relative to an origin that has moved.
std::vector<Rows> movedBack(std::vector<Rows> instances, const std::array<double, 3>& originMoved) {
    for (Rows& rows : instances) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            rows[4 * axis + 3] = static_cast<float>(rows[4 * axis + 3] - originMoved[axis]);
        }
    }
    return instances;
}

Result<std::vector<gpu::LightRecord>> makeLights(std::span<const LightView> lights) {
    GLINT_TRY_DO(checkLights(lights));
    return makeLightRecords(lights);
}

// The package's materials, with the host's numbers of textures and samplers.
Result<std::vector<std::uint8_t>> makeMaterials(const Context::State& context, const PackageScene& known,
                                                const EngineSceneView& scene) {
    if (scene.textures.size() != known.textures.size() || scene.samplers.size() != known.samplers.size()) {
        return makeError("engine-scene", "",
                         "there are " + std::to_string(scene.textures.size()) + " textures and " +
                             std::to_string(scene.samplers.size()) + " samplers, the package's scene has " +
                             std::to_string(known.textures.size()) + " and " +
                             std::to_string(known.samplers.size()),
                         "give one for each of PackageScene::textures and PackageScene::samplers");
    }
    std::vector<ImageView> images;
    for (std::size_t i = 0; i < known.textures.size(); ++i) {
        const EngineTextureView& texture = scene.textures[i];
        if (texture.width == 0 || texture.height == 0) {
            return makeError("engine-scene", "texture " + std::to_string(i), "it has no texels",
                             "give the size of its finest level");
        }
        images.resize(std::max<std::size_t>(images.size(), known.textures[i].image + std::size_t{1}));
        images[known.textures[i].image].width = texture.width;
        images[known.textures[i].image].height = texture.height;
    }
    std::vector<std::uint8_t> bytes = materialsWithSizes(context, known, images);
    for (std::size_t i = 0; i < known.materials.size(); ++i) {
        for (std::uint32_t slot = 0; slot < known.materials.textureCount; ++slot) {
            std::uint8_t* const place =
                &bytes[i * known.materials.recordBytes + known.materials.textureOffset +
                       slot * sizeof(gpu::TextureRecord)];
            gpu::TextureRecord record{};
            std::memcpy(&record, place, sizeof record);
            if (record.textureIndex < scene.textures.size()) {
                record.textureIndex = scene.textures[record.textureIndex].index;
            }
            if (record.samplerIndex < scene.samplers.size()) {
                record.anisotropy = scene.samplers[record.samplerIndex].maxAnisotropy;
                record.samplerIndex = scene.samplers[record.samplerIndex].index;
            }
            std::memcpy(place, &record, sizeof record);
        }
    }
    return bytes;
}

Status findShaderIds(std::span<const gpu::GeometryRecord> geometries,
                     std::span<const std::uint32_t> hitRecords, std::vector<std::uint32_t>& shaderIds) {
    if (hitRecords.empty()) {
        for (const gpu::GeometryRecord& geometry : geometries) {
            shaderIds.push_back(geometry.shaderId);
        }
        return okStatus();
    }
    for (std::size_t i = 0; i < hitRecords.size(); ++i) {
        if (hitRecords[i] >= geometries.size()) {
            return outOfRange("hit record " + std::to_string(i), "geometry", hitRecords[i],
                              geometries.size());
        }
        shaderIds.push_back(geometries[hitRecords[i]].shaderId);
    }
    return okStatus();
}

template <typename T>
Status upload(EngineScene::State& state, const std::vector<T>& records, VkBufferUsageFlags usage,
              Buffer& target) {
    return uploadRecords(state.context, state.pool, *state.upload->uploader, std::span<const T>(records),
                         target, usage);
}

// Records new contents of a buffer. The bytes travel in the command buffer.
template <typename T>
void recordContents(const EngineScene::State& state, VkCommandBuffer commands, const std::vector<T>& records,
                    const Buffer& target) {
    constexpr VkDeviceSize kMost = 65536;  // bytes that one command may carry
    const std::span<const std::uint8_t> bytes = bytesOf(std::span<const T>(records));
    for (VkDeviceSize offset = 0; offset < bytes.size(); offset += kMost) {
        state.context.vk.CmdUpdateBuffer(commands, target.handle.get(), offset,
                                         std::min(kMost, bytes.size() - offset), &bytes[offset]);
    }
}

}  // namespace

Result<std::unique_ptr<EngineScene>> EngineScene::record(Context& context, const Package& package,
                                                         const EngineSceneView& scene,
                                                         VkCommandBuffer commands, std::uint64_t frame) try {
    if (scene.packageScene >= package.sceneCount()) {
        return makeError("scene-package", "",
                         "the package has no scene " + std::to_string(scene.packageScene),
                         "give an index below Package::sceneCount()");
    }
    GLINT_TRY_DO(checkDevice(package, context.handles()));
    const PackageScene known = package.scene(scene.packageScene);
    GLINT_TRY(auto geometries, makeGeometries(known, scene));
    GLINT_TRY(auto instances, makeInstances(scene.instances));
    GLINT_TRY(auto lights, makeLights(scene.lights));
    GLINT_TRY(auto materials, makeMaterials(context.state(), known, scene));
    for (std::size_t i = 0; i < scene.firstRecords.size(); ++i) {
        if (scene.firstRecords[i] >= std::max<std::size_t>(geometries.size(), 1)) {
            return outOfRange("entry " + std::to_string(i) + " of firstRecords", "geometry",
                              scene.firstRecords[i], geometries.size());
        }
    }
    auto state = std::make_unique<State>(context.state());
    GLINT_TRY_DO(findShaderIds(geometries, scene.hitRecords, state->shaderIds));
    state->placed.assign(scene.instances.begin(), scene.instances.end());
    state->lightCount = state->lightCapacity = static_cast<std::uint32_t>(lights.size());
    state->recordsBy = scene.recordsBy;
    state->records = recordsHash(package, known);
    state->upload = std::make_unique<StagedCopies>(context.state());
    const std::vector<std::uint32_t> firstRecords(scene.firstRecords.begin(), scene.firstRecords.end());
    for (const Status& status :
         {upload(*state, geometries, 0, state->geometries),
          upload(*state, instances, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, state->instances),
          upload(*state, instances, 0, state->previousInstances), upload(*state, lights, 0, state->lights),
          upload(*state, materials, 0, state->materials),
          upload(*state, firstRecords, 0, state->firstRecords)}) {
        if (!status) {
            return status.error();
        }
    }
    state->upload->record(commands, frame);
    return std::unique_ptr<EngineScene>(new EngineScene(std::move(state)));
}
GLINT_CATCH

Result<std::unique_ptr<EngineScene>> EngineScene::create(Context& context, const Package& package,
                                                         const EngineSceneView& scene) try {
    return makeOnce(context.state(),
                    [&](VkCommandBuffer commands) { return record(context, package, scene, commands, 0); });
}
GLINT_CATCH

void EngineScene::complete(std::uint64_t frame) {
    if (state_->upload && state_->upload->frame <= frame) {
        state_->upload.reset();
    }
}

Result<std::unique_ptr<EngineScene>> EngineScene::share(Context& context, GpuScene& scene) try {
    auto state = std::make_unique<State>(context.state());
    state->shared = &scene.state();
    state->shaderIds = state->shared->shaderIds;
    state->records = state->shared->package.records;
    return std::unique_ptr<EngineScene>(new EngineScene(std::move(state)));
}
GLINT_CATCH

EngineScene::State::Addresses EngineScene::State::addresses() const {
    if (shared != nullptr) {
        return {shared->geometries.address, shared->instances.address, shared->instances.address,
                shared->materials.address,  shared->lights.address,    0};
    }
    return {geometries.address, instances.address, previousInstances.address,
            materials.address,  lights.address,    firstRecords.address};
}

std::uint32_t EngineScene::State::lightsNow() const {
    return shared != nullptr ? shared->lightCount : lightCount;
}

EngineScene::EngineScene(std::unique_ptr<State> state) : state_(std::move(state)) {}
EngineScene::~EngineScene() = default;

Status EngineScene::update(VkCommandBuffer commands, std::span<const std::array<float, 12>> instances,
                           std::span<const LightView> lights, const std::array<double, 3>& originMoved) try {
    if (state_->shared != nullptr) {
        return makeError("engine-scene", "", "the scene is that of a GpuScene", "use GpuScene::update()");
    }
    if (instances.size() != state_->placed.size() || lights.size() > state_->lightCapacity) {
        return makeError("engine-scene", "",
                         "there are " + std::to_string(instances.size()) + " instances and " +
                             std::to_string(lights.size()) + " lights, at creation there were " +
                             std::to_string(state_->placed.size()) + " and " +
                             std::to_string(state_->lightCapacity),
                         "give as many instances, and no more lights");
    }
    GLINT_TRY(auto records, makeInstances(instances));
    GLINT_TRY(auto lightRecords, makeLights(lights));
    const bool staysPut = originMoved == std::array<double, 3>{};
    GLINT_TRY(auto previous, staysPut ? std::vector<gpu::InstanceRecord>()
                                      : makeInstances(movedBack(state_->placed, originMoved)));
    state_->placed.assign(instances.begin(), instances.end());
    const Context::State& context = state_->context;
    recordDependency(context, commands, kAllToAll);
    if (staysPut && !instances.empty()) {
        const VkBufferCopy whole{0, 0, instances.size() * sizeof(gpu::InstanceRecord)};
        context.vk.CmdCopyBuffer(commands, state_->instances.handle.get(),
                                 state_->previousInstances.handle.get(), 1, &whole);
        recordDependency(context, commands, kAllToAll);
    }
    recordContents(*state_, commands, previous, state_->previousInstances);
    recordContents(*state_, commands, records, state_->instances);
    recordContents(*state_, commands, lightRecords, state_->lights);
    recordDependency(context, commands, kAllToAll);
    state_->lightCount = static_cast<std::uint32_t>(lightRecords.size());
    return okStatus();
}
GLINT_CATCH

VkDeviceAddress EngineScene::materials() const {
    return state_->addresses().materials;
}

std::uint64_t EngineScene::bytes() const {
    std::uint64_t sum = 0;
    for (const Buffer* const buffer : {&state_->geometries, &state_->instances, &state_->previousInstances,
                                       &state_->materials, &state_->lights, &state_->firstRecords}) {
        sum += buffer->bytes;
    }
    return sum;
}

EngineScene::State& EngineScene::state() {
    return *state_;
}

}  // namespace glint
