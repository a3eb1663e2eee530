#include "cli/render_setup.h"

namespace glint {

SceneViewData sceneView(const RenderArguments& arguments, const Scene& scene) {
    SceneViewData data = makeSceneView(scene);
    if (arguments.addsSun(scene)) {
        data.lights.push_back(sunLight());
    }
    arguments.effectFrame.apply(data);
    data.traversalOrder = traversalOrderOf(arguments);
    return data;
}

CompileSettings compileSettings(const RenderArguments& arguments, const PlanOptions& plan,
                                std::uint32_t tracers, const Scene& scene) {
    CompileSettings settings;
    arguments.tracing.apply(settings, tracers);
    settings.environmentMap = !arguments.environment.file.empty();
    settings.plan = plan;
    arguments.accuracy.apply(settings);
    arguments.effects.apply(settings);
    settings.addsLight = arguments.addsSun(scene);
    return settings;
}

RendererOptions rendererOptions(const RenderArguments& arguments) {
    RendererOptions options;
    options.strategy = strategyOf(arguments);
    parseSize(arguments.size, options.width, options.height);
    options.tracer = tracerOf(arguments);
    options.checkOrder = arguments.validate;
    options.pipelineThreads = static_cast<std::uint32_t>(arguments.pipelines.threads);
    arguments.frame.apply(options);
    arguments.effectFrame.apply(options);
    return options;
}

SkyChoice chooseSky(const RenderArguments& arguments, const Scene& scene, const SceneViewData& view) {
    SkyChoice choice;
    choice.automatic = arguments.sky == "auto";
    if (!choice.automatic) {
        parseReal(arguments.sky, 0.0, kMaxSky, choice.scale);
        return choice;
    }
    if (scene.lights.empty() || !arguments.environment.file.empty()) {
        return choice;
    }
    return skyForLights(litPatches(scene, view, view.lights));
}

FrameOptions frameOptions(const RenderArguments& arguments, const CameraView& camera, const SkyChoice& sky,
                          const Environment* environment) {
    FrameOptions options;
    options.camera = camera;
    options.sky = sky.sky();
    options.averagedSamples = static_cast<std::uint32_t>(arguments.samples);
    arguments.frame.apply(options);
    arguments.effectFrame.apply(options);
    options.maxReflectionRoughness = static_cast<float>(arguments.effects.maxRoughness);
    options.environment = environment;
    arguments.environment.apply(options);
    options.seed = static_cast<std::uint32_t>(arguments.seed);
    return options;
}

}  // namespace glint
