#include "emit/effects.h"
#include "emit/lights.h"
#include "gltf/import.h"
#include "gltf/scene_list.h"

#include <glint/measure/render_settings.h>

#include <algorithm>
#include <numbers>
#include <set>
#include <string>

namespace glint::measure {

namespace {

// Returns `--effects` for everything that rays find: the effects that the scene calls for, those that refine
// the light of the sky by rays, and those of packs that the user names. Effects that approximate the light of
// rays are left out.
std::string rayEffects(const compiler::EffectRequest& request) {
    std::string words = "auto";
    for (const materials::EffectDeclaration& effect : materials::builtinMaterialModel().effects) {
        if (effect.kind == package::EffectKind::Rays && !effect.refines.empty()) {
            words += "," + effect.name;
        }
    }
    for (const std::string& name : request.ofPacks) {
        words += "," + name;
    }
    return words;
}

std::set<std::string, std::less<>> namesOfChosen(const compiler::EffectPlan& plan) {
    std::set<std::string, std::less<>> names;
    for (const compiler::EffectDecision& decision : plan.decisions) {
        if (decision.chosen) {
            names.insert(decision.name);
        }
    }
    return names;
}

// Returns whether hits of any primitive lose a lobe if they keep only those of the base.
bool losesLobes(const gltf::Scene& scene, const compiler::PlanOptions& plan) {
    const std::vector<materials::PrimitiveInputs> primitives = planningInputs(scene);
    return std::ranges::any_of(primitives, [&](const materials::PrimitiveInputs& inputs) {
        const materials::Material& material = scene.materials[static_cast<std::size_t>(inputs.material)];
        return (compiler::makeKey(material, inputs, plan.keys) & materials::kLobeMask &
                ~compiler::baseLobes()) != 0;
    });
}

}  // namespace

compiler::BenchFacts factsOf(const compiler::Settings& settings, const gltf::Scene& scene,
                             const compiler::PlanOptions& plan) {
    compiler::BenchFacts facts;
    facts.masks = std::ranges::any_of(scene.materials, [](const materials::Material& material) {
        return material.alphaMode != materials::AlphaMode::Opaque;
    });
    const std::vector<materials::PrimitiveInputs> primitives = planningInputs(scene);
    facts.passesLight = std::ranges::any_of(primitives, [&](const materials::PrimitiveInputs& primitive) {
        const materials::Material& material = scene.materials[static_cast<std::size_t>(primitive.material)];
        return material.alphaMode == materials::AlphaMode::Blend ||
               compiler::passesLight(material, primitive);
    });
    facts.furtherLobes = losesLobes(scene, plan);
    facts.textures = !scene.textures.empty();
    compiler::CompileSettings compile = compileSettings(settings, plan, package::kAllTracers, scene);
    const gltf::SceneList scenes({&scene, 1});
    const compiler::EffectPlan effects = planEffects(scenes, compile);
    facts.effects = namesOfChosen(effects);
    facts.sendsRays = effects.effects.rays != 0;
    facts.rayEffects = rayEffects(compile.effects);
    compile.effects.maxReflectionRoughness = 1.0F;
    facts.effectsOfAnyRoughness = namesOfChosen(planEffects(scenes, compile));
    facts.emits = compiler::countEmitters(scene) > 0;
    compiler::CompileSettings emissive = compileSettings(settings, plan, package::kAllTracers, scene);
    emissive.emissiveLights = compiler::EmissiveLights::On;
    facts.lightsMayEmit = compiler::emissiveLightsOf({&scene, 1}, emissive).ok();
    emissive.skyLight = compiler::SkyLight::On;
    facts.skyMayLight = compiler::skyLightOf({&scene, 1}, emissive).ok();
    emissive.sizedLights = compiler::SizedLights::On;
    facts.sizedMayShow = compiler::sizedLightsOf({&scene, 1}, emissive).ok();
    const scene_view::SceneViewData data = sceneView(settings, scene);
    facts.punctualLights = !data.lights.empty();
    const auto directional = std::ranges::count(data.lights, LightView::Type::Directional, &LightView::type);
    facts.directionalLights = directional > 0;
    facts.placedLights = static_cast<std::size_t>(directional) < data.lights.size();
    compiler::CompileSettings own = compileSettings(settings, plan, package::kAllTracers, scene);
    const Result<compiler::EmissiveLights> emissiveLights = compiler::emissiveLightsOf({&scene, 1}, own);
    own.emissiveLights = emissiveLights ? *emissiveLights : compiler::EmissiveLights::Off;
    const compiler::LightCounts counts = compiler::countLights(scene, own);
    facts.lights = counts.positions + counts.emitters;
    own.lightSamples.reset();
    const Result<std::uint32_t> samples = compiler::lightSamplesOf({&scene, 1}, own);
    facts.manyLights = samples && *samples > 0;
    facts.sizedLights =
        std::ranges::any_of(data.lights, [](const LightView& light) { return light.size > 0.0F; });
    return facts;
}

bool addsSun(const compiler::Settings& settings, const gltf::Scene& scene) {
    const bool isUnlit = scene.lights.empty() && settings.environment.empty();
    return settings.sun == compiler::Sun::On || (settings.sun == compiler::Sun::Auto && isUnlit);
}

HeadlessOptions deviceOptions(const compiler::Settings& settings) {
    HeadlessOptions options;
    options.validation = settings.validate ? Validation::Synchronization : Validation::Off;
    options.deviceName = settings.device;
    options.pipelineStatistics = settings.gpu == compiler::kThisDevice;
    options.positionFetch = settings.compile.positionFetch;
    options.shaderClock =
        std::ranges::find(settings.compile.layers, "clocks") != settings.compile.layers.end();
    options.shaderFloat16 = settings.compile.precision == package::ShadingPrecision::Half;
    return options;
}

void sizeLights(const compiler::Settings& settings, scene_view::SceneViewData& scene) {
    for (LightView& light : scene.lights) {
        light.size = light.type == LightView::Type::Directional
                         ? static_cast<float>(0.5 * settings.sunAngle * std::numbers::pi / 180.0)
                         : static_cast<float>(settings.lightRadius);
    }
}

scene_view::SceneViewData sceneView(const compiler::Settings& settings, const gltf::Scene& scene) {
    scene_view::SceneViewData data = scene_view::makeSceneView(scene);
    if (addsSun(settings, scene)) {
        data.lights.push_back(scene_view::sunLight());
    }
    sizeLights(settings, data);
    data.traversalOrder = settings.traversalOrder;
    data.opacity = settings.opacity;
    data.vertices = settings.vertices;
    return data;
}

scene_view::TextureOptions textureOptions(const compiler::Settings& settings, const Context& context,
                                          const Package& package, compiler::CacheStore* cache) {
    scene_view::TextureOptions options;
    options.fit.formats = context.texelFormats();
    options.fit.compress = settings.compressTextures;
    options.fit.decodeEmission = package.emission() != nullptr;
    options.cache = cache;
    options.threads = static_cast<std::uint32_t>(settings.compile.jobs);
    return options;
}

compiler::CompileSettings compileSettings(const compiler::Settings& settings,
                                          const compiler::PlanOptions& plan) {
    compiler::CompileSettings compile = settings.compile;
    compile.plan = plan;
    compile.effects.maxReflectionRoughness = settings.frame.maxReflectionRoughness;
    return compile;
}

compiler::CompileSettings compileSettings(const compiler::Settings& settings,
                                          const compiler::PlanOptions& plan, std::uint32_t tracers,
                                          const gltf::Scene& scene) {
    compiler::CompileSettings compile = compileSettings(settings, plan);
    compile.strategies = settings.strategy ? std::uint32_t{*settings.strategy} : package::allStrategies();
    const bool queries = (tracers & package::kTracerRayQuery) != 0;
    compile.tracers =
        settings.renderer.tracer.value_or(queries ? package::kTracerRayQuery : package::kTracerRayPipeline);
    compile.environmentMap = !settings.environment.empty();
    compile.addsLight = addsSun(settings, scene);
    compile.sizesLights = settings.lightRadius > 0.0 || settings.sunAngle > 0.0;
    return compile;
}

RendererOptions rendererOptions(const compiler::Settings& settings) {
    RendererOptions options = settings.renderer;
    options.strategy = settings.strategy.value_or(options.strategy);
    options.bounces = settings.compile.maxBounces;
    options.checkOrder = settings.validate;
    options.screenMarch = settings.frame.screenSteps > 0;
    if (options.pipelineThreads == 0) {
        options.pipelineThreads = static_cast<std::uint32_t>(settings.compile.jobs);
    }
    return options;
}

scene_view::SkyChoice chooseSky(const compiler::Settings& settings, const gltf::Scene& scene,
                                const scene_view::SceneViewData& view) {
    scene_view::SkyChoice choice;
    choice.automatic = !settings.sky;
    if (settings.sky) {
        choice.scale = *settings.sky;
        return choice;
    }
    if (scene.lights.empty() || !settings.environment.empty()) {
        return choice;
    }
    return scene_view::skyForLights(scene_view::litPatches(scene, view, view.lights));
}

FrameOptions frameOptions(const compiler::Settings& settings, const CameraView& camera,
                          const scene_view::SkyChoice& sky, const Environment* environment) {
    FrameOptions options = settings.frame;
    options.camera = camera;
    options.sky = sky.sky();
    options.averagedSamples = settings.samples;
    options.environment = environment;
    options.environmentRotation = static_cast<float>(settings.environmentRotation / 180.0 * std::numbers::pi);
    return options;
}

}  // namespace glint::measure
