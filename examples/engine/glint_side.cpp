// Everything that Glint needs of the engine.
#include "engine_state.h"

namespace engine {

std::vector<glint::LightView> Engine::State::lights() const {
    std::vector<glint::LightView> result;
    for (const Sun& sun : world.suns) {
        result.push_back({glint::LightView::Type::Directional, sun.lux, {}, sun.direction});
    }
    return result;
}

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
    std::vector<glint::EngineScene::View::Texture> images;
    for (std::uint32_t i = 0; i < known.textures.size(); ++i) {
        const Texture& texture = world.textures[known.textures[i].image];
        images.push_back({i, texture.width, texture.height});
    }
    std::vector<glint::EngineScene::View::Sampler> filters;
    for (std::uint32_t i = 0; i < known.samplers.size(); ++i) {
        filters.push_back({i, gpu.anisotropy});
    }
    const std::vector<std::array<float, 12>> stored = restTransforms(world);
    glint::EngineScene::View view;
    view.geometries = records;
    view.instances = stored;
    view.textures = images;
    view.samplers = filters;
    const std::vector<glint::LightView> shining = lights();
    view.lights = shining;
    view.recordsBy = glint::EngineScene::View::RecordsBy::InstanceTable;
    view.firstRecords = firstRecords;
    scene = expect(glint::EngineScene::create(*context, package, view));
    glint::RaySteps::Options options;
    options.strategy = settings.strategy;
    options.tracer = settings.tracer;
    options.maxRays = settings.width * settings.height;
    options.layout = layout;
    options.pushStages = kStages;
    steps = expect(glint::RaySteps::create(*context, package, *scene, options));
}

}  // namespace engine
