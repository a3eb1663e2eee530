#include "engine_state.h"

#include <cstring>
#include <limits>

namespace engine {
namespace {

Vec3 cross(const Vec3& a, const Vec3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

float dot(const Vec3& a, const Vec3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vec3 scaled(const Vec3& v, float factor) {
    return {v[0] * factor, v[1] * factor, v[2] * factor};
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
    expect(scene->update(commands, stored, lights(), frames));
    vkCmdFillBuffer(commands, rayCount.handle, 0, VK_WHOLE_SIZE, 0);
    gpu.barrier(commands);
    draw(commands, slot);
    gpu.barrier(commands);
    const VkDescriptorSet sets[] = {imageSet, slot.worldSet};
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

    glint::RaySteps::Batch batch;
    batch.rays = rays.address;
    batch.countAddress = rayCount.address;
    batch.answers = answers.address;
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
    if (state_->frames > kInFlight) {
        state_->scene->complete(state_->frames - kInFlight);
    }
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
