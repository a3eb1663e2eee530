#include "frame.h"

#include "pipelines.h"

#include <glint/context.h>
#include <glint/ray_steps.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace engine {
namespace {

constexpr std::uint32_t kInFlight = 2;
constexpr std::uint32_t kPushOffset = 16;  // of Glint's push constants: the package's push-offset
constexpr VkShaderStageFlags kStages = VK_SHADER_STAGE_ALL;
using Vec3 = std::array<float, 3>;

// shaders/engine.glsl has the same structures.
struct GeometryData {
    VkDeviceAddress vertices;
    VkDeviceAddress indices;
    std::uint32_t shaderId, material, featureLobes, featureInputs, instance, pad;
};
struct SunData {
    Vec3 direction;
    Vec3 lux;
};
struct FrameData {
    std::array<std::array<float, 4>, 4> worldToClip;
    Vec3 cameraPosition;
    std::uint32_t width;
    Vec3 cameraForward;
    std::uint32_t height;
    Vec3 cameraRight;
    std::uint32_t sunCount;
    Vec3 cameraUp;
    float pixelSpread;
    Vec3 skyZenith;
    std::uint32_t tlas;
    Vec3 skyHorizon;
    float anisotropy;
    Vec3 skyGround;
    std::uint32_t compact;
    VkDeviceAddress geometries, transforms, suns, rays, rayCount, answers, weights, colors, textureSizes,
        materials;
};
static_assert(sizeof(FrameData) == 64 + 7 * 16 + 10 * 8);
struct Pushed {
    VkDeviceAddress frame;
    std::uint32_t geometry;
};

template <typename T>
T expect(glint::Result<T> result) {
    if (!result) {
        fail(toString(result.error()));
    }
    return std::move(*result);
}

void expect(const glint::Status& status) {
    if (!status) {
        fail(toString(status.error()));
    }
}

template <typename T>
std::span<const std::uint8_t> bytesOf(const std::vector<T>& values) {
    return {reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(T)};
}

Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

float dot(const Vec3& a, const Vec3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vec3 scaled(const Vec3& v, float factor) {
    return {v[0] * factor, v[1] * factor, v[2] * factor};
}

// Returns the transform of each instance from stored positions, as the file has it.
std::vector<std::array<float, 12>> restTransforms(const World& world) {
    std::vector<std::array<float, 12>> stored;
    for (const Instance& instance : world.instances) {
        stored.push_back(storedToWorld(world, instance));
    }
    return stored;
}

// Perspective with reversed depth (1 near, 0 infinitely far) and y down.
void setCamera(const Camera& camera, FrameData& frame) {
    const Vec3 right = cross(camera.forward, camera.up);
    const auto row = [&](const Vec3& axis, float scale) {
        return std::array{axis[0] * scale, axis[1] * scale, axis[2] * scale,
                          -dot(axis, camera.position) * scale};
    };
    frame.worldToClip = {row(right, 1.0F / camera.halfWidth), row(camera.up, -1.0F / camera.halfHeight),
                         std::array{0.0F, 0.0F, 0.0F, camera.near}, row(camera.forward, 1.0F)};
    frame.cameraPosition = camera.position;
    frame.cameraForward = camera.forward;
    frame.cameraRight = scaled(right, camera.halfWidth);
    frame.cameraUp = scaled(camera.up, camera.halfHeight);
    frame.pixelSpread = 2.0F * camera.halfHeight / static_cast<float>(frame.height);
}

}  // namespace

// One frame of those in flight.
struct Slot {
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;
    Buffer frame;
    Buffer transforms;
    Buffer instances;  // of the TLAS
    AccelerationStructure tlas;
};

struct Engine::State {
    State(Gpu& theGpu, const glint::Package& thePackage, const World& theWorld, const std::string& theShaders,
          const FrameSettings& theSettings)
        : gpu(theGpu), package(thePackage), world(theWorld), shaders(theShaders), settings(theSettings) {}

    Gpu& gpu;
    const glint::Package& package;
    const World& world;
    const std::string& shaders;
    FrameSettings settings;

    std::vector<Buffer> vertices;  // of each geometry of each mesh, in their order
    std::vector<Buffer> indices;
    std::vector<AccelerationStructure> blases;  // of each mesh
    std::vector<std::uint32_t> firstRecords;    // of each instance, in the order of the TLAS
    std::vector<glint::EngineGeometryView> records;
    std::vector<std::uint32_t> recordIndexCounts;
    std::vector<Image> textures;
    std::vector<VkSampler> samplers;
    Buffer geometryData, suns, textureSizes, rays, rayCount, answers, weights, colors;
    Image seen, depth;
    std::array<Slot, kInFlight> slots;
    std::uint32_t frames = 0;

    VkDescriptorSetLayout imageLayout = VK_NULL_HANDLE, worldLayout = VK_NULL_HANDLE;
    VkDescriptorSet imageSet = VK_NULL_HANDLE, worldSet = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkPipeline gbuffer = VK_NULL_HANDLE, compose = VK_NULL_HANDLE;
    std::optional<PrimaryPass> primary;

    std::unique_ptr<glint::Context> context;
    std::unique_ptr<glint::EngineScene> scene;
    std::unique_ptr<glint::RaySteps> steps;

    void buildMeshes();
    void placeInstances();
    void loadTextures();
    void makeBuffers();
    void makeSets();
    void makePipelines();
    void makeSlots();
    void startGlint();
    void writeSlot(std::uint32_t slot, const std::vector<std::array<float, 12>>& stored);
    void recordStructure(VkCommandBuffer commands, Slot& slot);
    std::vector<glint::LightView> lights() const;
    void record(std::uint32_t slot, const std::vector<std::array<float, 12>>& stored);
    void draw(VkCommandBuffer commands, const Slot& slot);
};

void Engine::State::buildMeshes() {
    const bool compact = world.format == Format::Compact;
    constexpr VkBufferUsageFlags kInput =
        VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;
    for (const Mesh& mesh : world.meshes) {
        std::vector<VkAccelerationStructureGeometryKHR> geometries;
        std::vector<std::uint32_t> triangles;
        for (const Geometry& geometry : mesh.geometries) {
            vertices.push_back(gpu.upload(geometry.vertices, kInput));
            indices.push_back(gpu.upload(geometry.indices, kInput));
            VkAccelerationStructureGeometryKHR described{};
            described.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR;
            described.geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR;
            described.flags = VK_GEOMETRY_OPAQUE_BIT_KHR;
            auto& data = described.geometry.triangles;
            data.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR;
            data.vertexFormat = compact ? VK_FORMAT_R16G16B16A16_SNORM : VK_FORMAT_R32G32B32_SFLOAT;
            data.vertexData.deviceAddress = vertices.back().address;
            data.vertexStride = vertexBytes(world.format);
            data.maxVertex = geometry.vertexCount - 1;
            data.indexType = compact ? VK_INDEX_TYPE_UINT16 : VK_INDEX_TYPE_UINT32;
            data.indexData.deviceAddress = indices.back().address;
            geometries.push_back(described);
            triangles.push_back(geometry.indexCount / 3);
        }
        blases.emplace_back();
        gpu.once([&](VkCommandBuffer commands) {
            gpu.build(commands, VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, geometries, triangles,
                      blases.back());
        });
    }
}

// Numbers the geometries of all instances. The engine's own custom indices mean something else, so Glint gets
// a table by the place of an instance in the TLAS.
void Engine::State::placeInstances() {
    std::vector<std::size_t> firstOfMesh;
    std::size_t sum = 0;
    for (const Mesh& mesh : world.meshes) {
        firstOfMesh.push_back(sum);
        sum += mesh.geometries.size();
    }
    const glint::PackageScene known = package.scene(0);
    std::vector<GeometryData> data;
    for (std::uint32_t i = 0; i < world.instances.size(); ++i) {
        const Mesh& mesh = world.meshes[world.instances[i].mesh];
        firstRecords.push_back(static_cast<std::uint32_t>(records.size()));
        for (std::size_t g = 0; g < mesh.geometries.size(); ++g) {
            const Geometry& geometry = mesh.geometries[g];
            const std::size_t place = firstOfMesh[world.instances[i].mesh] + g;
            const VkDeviceAddress address = vertices[place].address;
            glint::EngineGeometryView view{geometry.mesh,
                                           geometry.primitive,
                                           i,
                                           indices[place].address,
                                           address,
                                           address,
                                           address,
                                           address,
                                           address,
                                           address,
                                           0,
                                           0};
            view.hostFlags = world.format == Format::Compact ? 1 : 0;
            const glint::package::PrimitiveEntry* const entry =
                known.findPrimitive(geometry.mesh, geometry.primitive);
            if (entry == nullptr) {
                fail("the package is of another scene");
            }
            records.push_back(view);
            recordIndexCounts.push_back(geometry.indexCount);
            data.push_back({address, indices[place].address, entry->shaderId, entry->materialIndex,
                            entry->featureLobes, entry->featureInputs, i, 0});
        }
    }
    geometryData = gpu.upload(bytesOf(data));
}

void Engine::State::loadTextures() {
    const glint::PackageScene known = package.scene(0);
    std::vector<std::array<std::uint32_t, 2>> sizes;
    for (const glint::package::TextureEntry& entry : known.textures) {
        const Texture& texture = world.textures.at(entry.image);
        textures.push_back(gpu.texture(texture.rgba8, {texture.width, texture.height}, entry.srgb != 0));
        sizes.push_back({texture.width, texture.height});
    }
    textureSizes = gpu.upload(bytesOf(sizes));
    for (std::size_t i = 0; i < std::max<std::size_t>(known.samplers.size(), 1); ++i) {
        VkSamplerCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
        info.magFilter = info.minFilter = VK_FILTER_LINEAR;
        info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
        info.maxLod = VK_LOD_CLAMP_NONE;
        info.maxAnisotropy = gpu.anisotropy;
        info.anisotropyEnable = gpu.anisotropy > 1.0F ? VK_TRUE : VK_FALSE;
        samplers.emplace_back();
        check(vkCreateSampler(gpu.device, &info, nullptr, &samplers.back()), "vkCreateSampler");
        gpu.later([this, sampler = samplers.back(), device = gpu.device] {
            vkDestroySampler(device, sampler, nullptr);
        });
    }
}

void Engine::State::makeBuffers() {
    std::vector<SunData> data;
    for (const Sun& sun : world.suns) {
        data.push_back({sun.direction, sun.lux});
    }
    suns = gpu.upload(bytesOf(data));
    const VkDeviceSize pixels = VkDeviceSize{settings.width} * settings.height;
    rays = gpu.buffer(pixels * sizeof(glint::EngineRay), false);
    rayCount = gpu.buffer(sizeof(std::uint32_t), false);
    answers = gpu.buffer(pixels * sizeof(glint::EngineRadiance), false);
    weights = gpu.buffer(pixels * 16, false);
    colors = gpu.buffer(pixels * 16, false);
    const VkExtent2D extent{settings.width, settings.height};
    seen = gpu.image(VK_FORMAT_R32G32_UINT, extent, 1,
                     VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_STORAGE_BIT);
    depth = gpu.image(VK_FORMAT_D32_SFLOAT, extent, 1, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
    gpu.once([&](VkCommandBuffer commands) {
        std::array<VkImageMemoryBarrier2, 2> barriers{};
        for (std::size_t i = 0; i < 2; ++i) {
            barriers[i].sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
            barriers[i].dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
            barriers[i].dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
            barriers[i].newLayout =
                i == 0 ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
            barriers[i].image = i == 0 ? seen.handle : depth.handle;
            barriers[i].subresourceRange = {
                static_cast<VkImageAspectFlags>(i == 0 ? VK_IMAGE_ASPECT_COLOR_BIT
                                                       : VK_IMAGE_ASPECT_DEPTH_BIT),
                0, 1, 0, 1};
        }
        VkDependencyInfo dependency{};
        dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
        dependency.imageMemoryBarrierCount = 2;
        dependency.pImageMemoryBarriers = barriers.data();
        vkCmdPipelineBarrier2(commands, &dependency);
    });
}

void Engine::State::makeSlots() {
    VkCommandBufferAllocateInfo allocation{};
    allocation.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    allocation.commandPool = gpu.pool;
    allocation.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocation.commandBufferCount = 1;
    VkFenceCreateInfo fence{};
    fence.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
    fence.flags = VK_FENCE_CREATE_SIGNALED_BIT;
    for (Slot& slot : slots) {
        check(vkAllocateCommandBuffers(gpu.device, &allocation, &slot.commands), "vkAllocateCommandBuffers");
        check(vkCreateFence(gpu.device, &fence, nullptr, &slot.fence), "vkCreateFence");
        gpu.later([device = gpu.device, handle = slot.fence] { vkDestroyFence(device, handle, nullptr); });
        slot.frame = gpu.buffer(sizeof(FrameData), true);
        slot.transforms = gpu.buffer(world.instances.size() * 48, true);
        slot.instances = gpu.buffer(world.instances.size() * sizeof(VkAccelerationStructureInstanceKHR), true,
                                    VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR);
        writeSlot(static_cast<std::uint32_t>(&slot - slots.data()), restTransforms(world));
        gpu.once([&](VkCommandBuffer commands) { recordStructure(commands, slot); });
    }
}

void Engine::State::makeSets() {
    const auto textureCount = static_cast<std::uint32_t>(std::max<std::size_t>(textures.size(), 1));
    const auto samplerCount = static_cast<std::uint32_t>(samplers.size());
    const VkDescriptorSetLayoutBinding ofImages{0, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1, kStages, nullptr};
    // The numbers are those of the package's --bindings.
    const VkDescriptorSetLayoutBinding ofWorld[] = {
        {package.bindings().tlas, VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, kInFlight, kStages, nullptr},
        {package.bindings().textures, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, textureCount, kStages, nullptr},
        {package.bindings().samplers, VK_DESCRIPTOR_TYPE_SAMPLER, samplerCount, kStages, nullptr}};
    const auto makeLayout = [&](std::span<const VkDescriptorSetLayoutBinding> bindings) {
        const std::vector<VkDescriptorBindingFlags> flags(bindings.size(),
                                                          VK_DESCRIPTOR_BINDING_PARTIALLY_BOUND_BIT);
        VkDescriptorSetLayoutBindingFlagsCreateInfo flagsInfo{};
        flagsInfo.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_BINDING_FLAGS_CREATE_INFO;
        flagsInfo.bindingCount = static_cast<std::uint32_t>(flags.size());
        flagsInfo.pBindingFlags = flags.data();
        VkDescriptorSetLayoutCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
        info.pNext = &flagsInfo;
        info.bindingCount = static_cast<std::uint32_t>(bindings.size());
        info.pBindings = bindings.data();
        VkDescriptorSetLayout made = VK_NULL_HANDLE;
        check(vkCreateDescriptorSetLayout(gpu.device, &info, nullptr, &made), "vkCreateDescriptorSetLayout");
        gpu.later([device = gpu.device, made] { vkDestroyDescriptorSetLayout(device, made, nullptr); });
        return made;
    };
    imageLayout = makeLayout({&ofImages, 1});
    worldLayout = makeLayout(ofWorld);
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1},
                                          {VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, kInFlight},
                                          {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, textureCount},
                                          {VK_DESCRIPTOR_TYPE_SAMPLER, samplerCount}};
    VkDescriptorPoolCreateInfo poolInfo{};
    poolInfo.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    poolInfo.maxSets = 2;
    poolInfo.poolSizeCount = std::size(sizes);
    poolInfo.pPoolSizes = sizes;
    VkDescriptorPool pool = VK_NULL_HANDLE;
    check(vkCreateDescriptorPool(gpu.device, &poolInfo, nullptr, &pool), "vkCreateDescriptorPool");
    gpu.later([device = gpu.device, pool] { vkDestroyDescriptorPool(device, pool, nullptr); });
    const VkDescriptorSetLayout layouts[] = {imageLayout, worldLayout};
    VkDescriptorSetAllocateInfo allocation{};
    allocation.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    allocation.descriptorPool = pool;
    allocation.descriptorSetCount = 2;
    allocation.pSetLayouts = layouts;
    VkDescriptorSet sets[2]{};
    check(vkAllocateDescriptorSets(gpu.device, &allocation, sets), "vkAllocateDescriptorSets");
    imageSet = sets[0];
    worldSet = sets[1];

    const auto write = [&](VkDescriptorSet set, std::uint32_t binding, VkDescriptorType type,
                           std::size_t count, const VkDescriptorImageInfo* images, const void* next) {
        VkWriteDescriptorSet info{};
        info.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
        info.pNext = next;
        info.dstSet = set;
        info.dstBinding = binding;
        info.descriptorCount = static_cast<std::uint32_t>(count);
        info.descriptorType = type;
        info.pImageInfo = images;
        if (count > 0) {
            vkUpdateDescriptorSets(gpu.device, 1, &info, 0, nullptr);
        }
    };
    const VkDescriptorImageInfo image{VK_NULL_HANDLE, seen.view, VK_IMAGE_LAYOUT_GENERAL};
    write(imageSet, 0, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1, &image, nullptr);
    const VkAccelerationStructureKHR structures[] = {slots[0].tlas.handle, slots[1].tlas.handle};
    VkWriteDescriptorSetAccelerationStructureKHR tlases{};
    tlases.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR;
    tlases.accelerationStructureCount = kInFlight;
    tlases.pAccelerationStructures = structures;
    write(worldSet, package.bindings().tlas, VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, kInFlight,
          nullptr, &tlases);
    std::vector<VkDescriptorImageInfo> images;
    for (const Image& texture : textures) {
        images.push_back({VK_NULL_HANDLE, texture.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
    }
    write(worldSet, package.bindings().textures, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, images.size(),
          images.data(), nullptr);
    std::vector<VkDescriptorImageInfo> filters;
    for (const VkSampler sampler : samplers) {
        filters.push_back({sampler, VK_NULL_HANDLE, VK_IMAGE_LAYOUT_UNDEFINED});
    }
    write(worldSet, package.bindings().samplers, VK_DESCRIPTOR_TYPE_SAMPLER, filters.size(), filters.data(),
          nullptr);

    // One layout for the engine's pipelines and for Glint's: the engine's push constants, then Glint's.
    const VkPushConstantRange range{kStages, 0, kPushOffset + glint::RaySteps::kPushBytes};
    VkPipelineLayoutCreateInfo layoutInfo{};
    layoutInfo.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    layoutInfo.setLayoutCount = 2;
    layoutInfo.pSetLayouts = layouts;
    layoutInfo.pushConstantRangeCount = 1;
    layoutInfo.pPushConstantRanges = &range;
    check(vkCreatePipelineLayout(gpu.device, &layoutInfo, nullptr, &layout), "vkCreatePipelineLayout");
    gpu.later([device = gpu.device, made = layout] { vkDestroyPipelineLayout(device, made, nullptr); });
}

void Engine::State::makePipelines() {
    gbuffer =
        gbufferPipeline(gpu, layout, shaders, {settings.width, settings.height}, seen.format, depth.format);
    primary.emplace(gpu, layout, shaders, settings.tracer);
    compose = computePipeline(gpu, layout, shaders + "/compose.comp.spv");
}

std::vector<glint::LightView> Engine::State::lights() const {
    std::vector<glint::LightView> result;
    for (const Sun& sun : world.suns) {
        result.push_back({glint::LightView::Type::Directional, sun.lux, {}, sun.direction});
    }
    return result;
}

// Everything that Glint needs of the engine.
void Engine::State::startGlint() {
    glint::DeviceHandles handles;
    handles.instance = gpu.instance;
    handles.physicalDevice = gpu.physical;
    handles.device = gpu.device;
    handles.queue = gpu.queue;
    handles.queueFamily = gpu.family;
    handles.tracers = gpu.tracers;
    context = expect(glint::Context::adopt(handles));
    const glint::PackageScene known = package.scene(0);
    std::vector<glint::EngineTextureView> images;
    for (std::uint32_t i = 0; i < known.textures.size(); ++i) {
        const Texture& texture = world.textures[known.textures[i].image];
        images.push_back({i, texture.width, texture.height});
    }
    std::vector<glint::EngineSamplerView> filters;
    for (std::uint32_t i = 0; i < known.samplers.size(); ++i) {
        filters.push_back({i, gpu.anisotropy});
    }
    const std::vector<std::array<float, 12>> stored = restTransforms(world);
    glint::EngineSceneView view;
    view.geometries = records;
    view.instances = stored;
    view.textures = images;
    view.samplers = filters;
    const std::vector<glint::LightView> shining = lights();
    view.lights = shining;
    view.recordsBy = glint::RecordsBy::InstanceTable;
    view.firstRecords = firstRecords;
    scene = expect(glint::EngineScene::create(*context, package, view));
    glint::RayStepsOptions options;
    options.strategy = settings.strategy;
    options.tracer = settings.tracer;
    options.maxRays = settings.width * settings.height;
    options.layout = layout;
    options.pushStages = kStages;
    steps = expect(glint::RaySteps::create(*context, package, *scene, options));
}

void Engine::State::writeSlot(std::uint32_t number, const std::vector<std::array<float, 12>>& stored) {
    Slot& slot = slots[number];
    std::memcpy(slot.transforms.mapped, stored.data(), stored.size() * sizeof stored[0]);
    auto* const instances = static_cast<VkAccelerationStructureInstanceKHR*>(slot.instances.mapped);
    for (std::uint32_t i = 0; i < stored.size(); ++i) {
        VkAccelerationStructureInstanceKHR instance{};
        std::memcpy(&instance.transform, stored[i].data(), sizeof instance.transform);
        instance.instanceCustomIndex =
            (0xABC000U + i) & 0xFFFFFFU;  // the engine's own; Glint looks at the place alone
        instance.mask = 0xFF;
        // The hit record of hit-shaders: one for each geometry.
        instance.instanceShaderBindingTableRecordOffset = firstRecords[i] & 0xFFFFFFU;
        instance.accelerationStructureReference = blases[world.instances[i].mesh].address;
        instances[i] = instance;
    }
    FrameData data{};
    data.width = settings.width;
    data.height = settings.height;
    setCamera(world.camera, data);
    data.sunCount = static_cast<std::uint32_t>(world.suns.size());
    const glint::SkyView sky;
    data.skyZenith = sky.zenith;
    data.skyHorizon = sky.horizon;
    data.skyGround = sky.ground;
    data.tlas = number;
    data.compact = world.format == Format::Compact ? 1 : 0;
    data.geometries = geometryData.address;
    data.transforms = slot.transforms.address;
    data.suns = suns.address;
    data.rays = rays.address;
    data.rayCount = rayCount.address;
    data.answers = answers.address;
    data.weights = weights.address;
    data.colors = colors.address;
    data.textureSizes = textureSizes.address;
    data.anisotropy = gpu.anisotropy;
    data.materials = scene != nullptr ? scene->materials() : 0;
    std::memcpy(slot.frame.mapped, &data, sizeof data);
}

void Engine::State::recordStructure(VkCommandBuffer commands, Slot& slot) {
    VkAccelerationStructureGeometryKHR described{};
    described.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR;
    described.geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR;
    described.geometry.instances.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR;
    described.geometry.instances.data.deviceAddress = slot.instances.address;
    const auto count = static_cast<std::uint32_t>(world.instances.size());
    gpu.build(commands, VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR, {&described, 1}, {&count, 1},
              slot.tlas);
}

void Engine::State::draw(VkCommandBuffer commands, const Slot& slot) {
    VkRenderingAttachmentInfo color{};
    color.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
    color.imageView = seen.view;
    color.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
    color.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    color.clearValue.color.uint32[0] = std::numeric_limits<std::uint32_t>::max();
    VkRenderingAttachmentInfo far{};
    far.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
    far.imageView = depth.view;
    far.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    far.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    far.storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    VkRenderingInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
    info.renderArea.extent = {settings.width, settings.height};
    info.layerCount = 1;
    info.colorAttachmentCount = 1;
    info.pColorAttachments = &color;
    info.pDepthAttachment = &far;
    vkCmdBeginRendering(commands, &info);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, gbuffer);
    for (std::uint32_t i = 0; i < records.size(); ++i) {
        const Pushed pushed{slot.frame.address, i};
        vkCmdPushConstants(commands, layout, kStages, 0, 12, &pushed);
        vkCmdDraw(commands, recordIndexCounts[i], 1, 0, 0);
    }
    vkCmdEndRendering(commands);
}

void Engine::State::record(std::uint32_t number, const std::vector<std::array<float, 12>>& stored) {
    Slot& slot = slots[number];
    const VkCommandBuffer commands = slot.commands;
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
    gpu.barrier(commands);  // the frame before has used the same lists
    recordStructure(commands, slot);
    expect(scene->update(commands, stored, lights()));
    vkCmdFillBuffer(commands, rayCount.handle, 0, VK_WHOLE_SIZE, 0);
    gpu.barrier(commands);
    draw(commands, slot);
    gpu.barrier(commands);
    const VkDescriptorSet sets[] = {imageSet, worldSet};
    std::vector points{VK_PIPELINE_BIND_POINT_COMPUTE};
    if (settings.tracer == glint::package::kTracerRayPipeline) {
        points.push_back(VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR);
    }
    for (const VkPipelineBindPoint point : points) {
        vkCmdBindDescriptorSets(commands, point, layout, 0, 2, sets, 0, nullptr);
    }
    const Pushed pushed{slot.frame.address, 0};
    vkCmdPushConstants(commands, layout, kStages, 0, 12, &pushed);
    primary->record(commands, {settings.width, settings.height});

    glint::RayBatch batch;
    batch.rays = rays.address;
    batch.countBuffer = rayCount.handle;
    batch.answers = answers.address;
    batch.tlasIndex = number;
    expect(steps->record(commands, batch));

    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, compose);
    vkCmdDispatch(commands, (settings.width * settings.height + 63) / 64, 1, 1);
    check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
}

Engine::Engine(Gpu& gpu, const glint::Package& package, const World& world, const std::string& shaders,
               const FrameSettings& settings)
    : state_(std::make_unique<State>(gpu, package, world, shaders, settings)) {
    state_->buildMeshes();
    state_->placeInstances();
    state_->loadTextures();
    state_->makeBuffers();
    state_->makeSlots();
    state_->makeSets();
    state_->makePipelines();
    state_->startGlint();
}

Engine::~Engine() {
    vkDeviceWaitIdle(state_->gpu.device);
}

void Engine::frame(const std::vector<std::array<float, 12>>& transforms) {
    const std::uint32_t number = state_->frames++ % kInFlight;
    Slot& slot = state_->slots[number];
    check(vkWaitForFences(state_->gpu.device, 1, &slot.fence, VK_TRUE, UINT64_MAX), "vkWaitForFences");
    check(vkResetFences(state_->gpu.device, 1, &slot.fence), "vkResetFences");
    std::vector<std::array<float, 12>> stored;
    for (std::size_t i = 0; i < transforms.size(); ++i) {
        stored.push_back(storedToWorld(state_->world, {state_->world.instances[i].mesh, transforms[i]}));
    }
    state_->writeSlot(number, stored);
    state_->record(number, stored);
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &slot.commands;
    check(vkQueueSubmit(state_->gpu.queue, 1, &submit, slot.fence), "vkQueueSubmit");
}

Picture Engine::picture() {
    check(vkQueueWaitIdle(state_->gpu.queue), "vkQueueWaitIdle");
    const Buffer read = state_->gpu.buffer(state_->colors.bytes, true);
    state_->gpu.once([&](VkCommandBuffer commands) {
        const VkBufferCopy whole{0, 0, state_->colors.bytes};
        vkCmdCopyBuffer(commands, state_->colors.handle, read.handle, 1, &whole);
        state_->gpu.barrier(commands);
    });
    Picture picture{state_->settings.width, state_->settings.height, {}};
    picture.pixels.resize(std::size_t{picture.width} * picture.height);
    std::memcpy(picture.pixels.data(), read.mapped, picture.pixels.size() * 16);
    return picture;
}

std::uint32_t Engine::rays() {
    return expect(state_->steps->counters()).rays;
}

}  // namespace engine
