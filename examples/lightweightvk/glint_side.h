// Everything that Glint needs of the engine.
#pragma once

#include <lvk/vulkan/VulkanClasses.h>  // before Glint's headers, whose Vulkan is older
//
#include <glint/steps.h>

#include <glm/glm.hpp>

#include <deque>
#include <iostream>
#include <materials/glint_tables.h>

using Place = std::array<float, 12>;
// An object as the engine has it; shaders/frame.glsl.
struct Object {
    glm::vec3 color;
    float gloss;
    glm::vec3 mirror;
    float moved = 0;  // metres along x
    std::uint64_t positions = 0, normals = 0, indices = 0, pad = 0;
};

template <typename T>
T expect(glint::Result<T> result) {
    if (!result) {
        std::cerr << toString(result.error()) << '\n';
        std::exit(1);
    }
    return std::move(*result);
}

struct GlintSide {
    GlintSide(lvk::VulkanContext& theEngine, std::span<const Object> objects, std::span<const Place> places,
              const glint::LightView& theSun, std::uint32_t maxRays)
        : engine(theEngine), sun(theSun) {
        glint::DeviceHandles handles;
        handles.instance = engine.getVkInstance();
        handles.physicalDevice = engine.getVkPhysicalDevice();
        handles.device = engine.getVkDevice();
        handles.queue = engine.deviceQueues_.graphicsQueue;
        handles.queueFamily = engine.deviceQueues_.graphicsQueueFamilyIndex;
        handles.getInstanceProcAddr = vkGetInstanceProcAddr;
        handles.debugUtils = vkCmdBeginDebugUtilsLabelEXT != nullptr;
        context = expect(glint::Context::adopt(handles, {.pipelineCache = engine.pipelineCache_}));

        // The package has one material. Each object has values of its own.
        std::vector<glint::scene_materials::MaterialRecord> records(objects.size());
        std::vector<glint::EngineScene::View::Material> values;
        std::vector<glint::EngineScene::View::Geometry> geometries(objects.size());
        for (std::uint32_t i = 0; i < objects.size(); ++i) {
            const Object& object = objects[i];
            std::memcpy(&records[i], package.scene(0).materials.bytes.data(), sizeof records[i]);
            records[i].baseColorFactor = {object.color.x, object.color.y, object.color.z, 1};
            records[i].satinMirror = {object.mirror.x, object.mirror.y, object.mirror.z};
            records[i].satinGloss = object.gloss;
            values.push_back({0, {reinterpret_cast<const std::uint8_t*>(&records[i]), sizeof records[i]}});
            geometries[i].instance = geometries[i].material = i;
            geometries[i].indices = object.indices;
            geometries[i].positions = object.positions;
            geometries[i].normals = object.normals;
        }
        glint::EngineScene::View view;
        view.geometries = geometries;
        view.instances = places;
        view.lights = {&sun, 1};
        view.materials = values;
        lvk::ICommandBuffer& commands = engine.acquireCommandBuffer();
        scene = expect(
            glint::EngineScene::record(*context, package, view, lvk::getVkCommandBuffer(commands), frame));
        submitted(engine.submit(commands, {}));

        // The package reads no descriptor, so the layout has no sets.
        const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, glint::RaySteps::kPushBytes};
        const VkPipelineLayoutCreateInfo info{
            VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO, nullptr, 0, 0, nullptr, 1, &range};
        VK_ASSERT(vkCreatePipelineLayout(handles.device, &info, nullptr, &options.layout));
        options.maxRays = maxRays;
        steps = expect(glint::RaySteps::create(*context, package, *scene, options));
    }
    ~GlintSide() {
        engine.wait({});
        steps.reset();
        vkDestroyPipelineLayout(engine.getVkDevice(), options.layout, nullptr);
    }
    // Leaves a pipeline bound that the engine does not know of. So it must bind another than its last one.
    void record(lvk::ICommandBuffer& commands, std::span<const Place> places,
                const glint::RaySteps::Batch& batch) {
        expect(scene->update(lvk::getVkCommandBuffer(commands), places, {&sun, 1}, ++frame));
        expect(steps->record(lvk::getVkCommandBuffer(commands), batch));
    }
    void submitted(lvk::SubmitHandle handle) {
        inFlight.push_back(handle);
        for (; !inFlight.empty() && engine.immediate_->isReady(inFlight.front()); inFlight.pop_front()) {
            scene->complete(frame + 1 - inFlight.size());
        }
    }

    lvk::VulkanContext& engine;
    glint::LightView sun;
    glint::Package package = expect(glint::Package::load(std::filesystem::path(GLINT_PACKAGE_MATERIALS)));
    std::unique_ptr<glint::Context> context;
    glint::RaySteps::Options options;
    std::unique_ptr<glint::EngineScene> scene;
    std::unique_ptr<glint::RaySteps> steps;
    std::deque<lvk::SubmitHandle> inFlight;  // of the last frames
    std::uint64_t frame = 0;
};
