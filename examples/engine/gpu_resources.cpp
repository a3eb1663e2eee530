// Meshes, textures, buffers, descriptor sets and pipelines: what an engine has without Glint.
#include "engine_state.h"

#include <algorithm>
#include <span>

namespace engine {
namespace {

template <typename T>
std::span<const std::uint8_t> bytesOf(const std::vector<T>& values) {
    return {reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(T)};
}

}  // namespace

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
            glint::EngineScene::View::Geometry view{geometry.mesh,
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
            data.push_back(
                {address, indices[place].address, entry->shaderId, entry->materialIndex, entry->key, i, 0});
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
    rays = gpu.buffer(pixels * sizeof(glint::RaySteps::Ray), false);
    rayCount = gpu.buffer(sizeof(std::uint32_t), false);
    answers = gpu.buffer(pixels * sizeof(glint::RaySteps::Radiance), false);
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
        {package.bindings().tlas, VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, 1, kStages, nullptr},
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
                                          {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, textureCount * kInFlight},
                                          {VK_DESCRIPTOR_TYPE_SAMPLER, samplerCount * kInFlight}};
    VkDescriptorPoolCreateInfo poolInfo{};
    poolInfo.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    poolInfo.maxSets = 1 + kInFlight;
    poolInfo.poolSizeCount = std::size(sizes);
    poolInfo.pPoolSizes = sizes;
    VkDescriptorPool pool = VK_NULL_HANDLE;
    check(vkCreateDescriptorPool(gpu.device, &poolInfo, nullptr, &pool), "vkCreateDescriptorPool");
    gpu.later([device = gpu.device, pool] { vkDestroyDescriptorPool(device, pool, nullptr); });
    const auto allocate = [&](VkDescriptorSetLayout setLayout) {
        VkDescriptorSetAllocateInfo allocation{};
        allocation.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
        allocation.descriptorPool = pool;
        allocation.descriptorSetCount = 1;
        allocation.pSetLayouts = &setLayout;
        VkDescriptorSet set = VK_NULL_HANDLE;
        check(vkAllocateDescriptorSets(gpu.device, &allocation, &set), "vkAllocateDescriptorSets");
        return set;
    };
    imageSet = allocate(imageLayout);

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
    std::vector<VkDescriptorImageInfo> images;
    for (const Image& texture : textures) {
        images.push_back({VK_NULL_HANDLE, texture.view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL});
    }
    std::vector<VkDescriptorImageInfo> filters;
    for (const VkSampler sampler : samplers) {
        filters.push_back({sampler, VK_NULL_HANDLE, VK_IMAGE_LAYOUT_UNDEFINED});
    }
    for (Slot& slot : slots) {
        slot.worldSet = allocate(worldLayout);
        VkWriteDescriptorSetAccelerationStructureKHR structure{};
        structure.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR;
        structure.accelerationStructureCount = 1;
        structure.pAccelerationStructures = &slot.tlas.handle;
        write(slot.worldSet, package.bindings().tlas, VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR, 1,
              nullptr, &structure);
        write(slot.worldSet, package.bindings().textures, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, images.size(),
              images.data(), nullptr);
        write(slot.worldSet, package.bindings().samplers, VK_DESCRIPTOR_TYPE_SAMPLER, filters.size(),
              filters.data(), nullptr);
    }

    const VkDescriptorSetLayout layouts[] = {imageLayout, worldLayout};
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

}  // namespace engine
