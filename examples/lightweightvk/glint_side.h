// Everything that Glint needs of the engine.
#pragma once

#include <lvk/vulkan/VulkanClasses.h>  // before Glint's headers, whose Vulkan is older
//
#include <glint/context.h>
#include <glint/package.h>
#include <glint/steps.h>

#define GLM_FORCE_DEPTH_ZERO_TO_ONE
#include <glm/glm.hpp>

#include <deque>
#include <iostream>
#include <materials/glint_tables.h>

// A material as the engine has it: shaders/frame.glsl.
struct Material {
    glm::vec3 color;
    float gloss;
    glm::vec3 mirror;
    float pad = 0;
};

template <typename T>
T expect(glint::Result<T> result) {
    if (!result) {
        std::cerr << toString(result.error()) << '\n';
        std::exit(1);
    }
    return std::move(*result);
}

class GlintSide {
public:
    GlintSide(lvk::VulkanContext& theEngine, std::span<const glint::EngineGeometryView> geometries,
              std::span<const Material> materials, const glint::LightView& theSun, std::uint32_t maxRays)
        : engine(theEngine), sun(theSun) {
        glint::DeviceHandles handles;
        handles.instance = engine.getVkInstance();
        handles.physicalDevice = engine.getVkPhysicalDevice();
        handles.device = engine.getVkDevice();
        handles.queue = engine.deviceQueues_.graphicsQueue;
        handles.queueFamily = engine.deviceQueues_.graphicsQueueFamilyIndex;
        handles.getInstanceProcAddr = vkGetInstanceProcAddr;
        handles.debugUtils = vkCmdBeginDebugUtilsLabelEXT != nullptr;
        glint::HostServices services;
        services.pipelineCache = engine.pipelineCache_;
        context = expect(glint::Context::adopt(handles, services));

        // The engine's materials, in records of the package.
        std::vector<glint::scene_materials::MaterialRecord> records(materials.size());
        std::vector<glint::MaterialView> values;
        for (std::size_t i = 0; i < records.size(); ++i) {
            std::memcpy(&records[i], package.scene(0).materials.bytes.data(), sizeof records[i]);
            const auto& [color, gloss, mirror, pad] = materials[i];
            records[i].baseColorFactor = {color.x, color.y, color.z, 1};
            records[i].satinMirror = {mirror.x, mirror.y, mirror.z};
            records[i].satinGloss = gloss;
            values.push_back({0, {reinterpret_cast<const std::uint8_t*>(&records[i]), sizeof records[i]}});
        }
        const std::vector<std::array<float, 12>> still(geometries.size(),
                                                       {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});
        glint::EngineSceneView view;
        view.geometries = geometries;
        view.instances = still;
        view.lights = {&sun, 1};
        view.materials = values;
        lvk::ICommandBuffer& commands = engine.acquireCommandBuffer();
        scene = expect(
            glint::EngineScene::record(*context, package, view, lvk::getVkCommandBuffer(commands), frame));
        submitted(engine.submit(commands, {}));

        // The package reads no descriptor, so the layout has no sets.
        const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, glint::RaySteps::kPushBytes};
        VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
        info.pushConstantRangeCount = 1;
        info.pPushConstantRanges = &range;
        VK_ASSERT(vkCreatePipelineLayout(handles.device, &info, nullptr, &options.layout));
        options.maxRays = maxRays;
        steps = expect(glint::RaySteps::create(*context, package, *scene, options));
    }
    ~GlintSide() {
        engine.wait({});
        steps.reset();
        vkDestroyPipelineLayout(engine.getVkDevice(), options.layout, nullptr);
    }

    // The engine's own ray queries need this. Its barrier after the build is for ray tracing pipelines alone.
    void waitForStructure(lvk::ICommandBuffer& commands) {
        VkMemoryBarrier barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
        barrier.srcAccessMask = VK_ACCESS_ACCELERATION_STRUCTURE_WRITE_BIT_KHR;
        barrier.dstAccessMask = VK_ACCESS_ACCELERATION_STRUCTURE_READ_BIT_KHR;
        vkCmdPipelineBarrier(lvk::getVkCommandBuffer(commands),
                             VK_PIPELINE_STAGE_ACCELERATION_STRUCTURE_BUILD_BIT_KHR,
                             VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, 0, 1, &barrier, 0, nullptr, 0, nullptr);
    }

    // Leaves a pipeline bound that the engine does not know of. So it must bind another than its last one.
    void record(lvk::ICommandBuffer& commands, std::span<const lvk::AccelStructInstance> instances,
                const glint::RayBatch& batch) {
        std::vector<std::array<float, 12>> places(instances.size());
        for (std::size_t i = 0; i < places.size(); ++i) {
            std::memcpy(&places[i], &instances[i].transform, sizeof places[i]);
        }
        expect(scene->update(lvk::getVkCommandBuffer(commands), places, {&sun, 1}, ++frame));
        expect(steps->record(lvk::getVkCommandBuffer(commands), batch));
    }
    void submitted(lvk::SubmitHandle handle) {
        inFlight.push_back(handle);
        for (; !inFlight.empty() && engine.immediate_->isReady(inFlight.front()); inFlight.pop_front()) {
            scene->complete(frame + 1 - inFlight.size());
        }
    }

private:
    lvk::VulkanContext& engine;
    glint::LightView sun;
    glint::Package package = expect(glint::Package::load(std::filesystem::path(GLINT_PACKAGE_MATERIALS)));
    std::unique_ptr<glint::Context> context;
    glint::RayStepsOptions options;
    std::unique_ptr<glint::EngineScene> scene;
    std::unique_ptr<glint::RaySteps> steps;
    std::deque<lvk::SubmitHandle> inFlight;  // of the last frames
    std::uint64_t frame = 0;
};
