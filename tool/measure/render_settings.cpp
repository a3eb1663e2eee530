#include "resolve/light.h"

#include <glint/measure/render_settings.h>

#include <algorithm>
#include <numbers>
#include <set>
#include <string>
#include <vector>

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

// Adds what packages of the same scenes would have with other settings.
void addAlternatives(const compiler::Build& build, compiler::BenchFacts& facts) {
    compiler::CompileSettings asked = build.settings.compile;
    asked.emissiveLights = build.asked.compile.emissiveLights;
    asked.skyLight = build.asked.compile.skyLight;
    asked.sizedLights = build.asked.compile.sizedLights;
    asked.lightSamples.reset();
    const auto planWith = [&](const auto& change) {
        compiler::CompileSettings settings = asked;
        change(settings);
        return planLight(*build.scenes, settings);
    };
    facts.lightsMayEmit =
        planWith([](auto& settings) { settings.emissiveLights = compiler::EmissiveLights::On; }).ok();
    facts.skyMayLight = planWith([](auto& settings) { settings.skyLight = compiler::SkyLight::On; }).ok();
    facts.sizedMayShow =
        planWith([](auto& settings) { settings.sizedLights = compiler::SizedLights::On; }).ok();
    if (const auto plan = planWith([](auto& settings) { settings.effects.maxReflectionRoughness = 1.0F; })) {
        facts.effectsOfAnyRoughness = namesOfChosen(plan->effects);
        facts.manyLights = plan->samples > 0;
    }
    const auto one = planWith([](auto& settings) { settings.maxBounces = 1; });
    const auto several = planWith([](auto& settings) { settings.maxBounces = 2; });
    facts.bouncesLight =
        one && several &&
        (one->emissive != several->emissive || one->sky != several->sky || one->sized != several->sized);
}

}  // namespace

compiler::BenchFacts factsOf(const compiler::Build& build, std::size_t index) {
    const gltf::Scene& scene = build.scenes->scenes()[index];
    const gltf::SceneList::Range range = build.scenes->primitivesOf(index);
    const compiler::Settings& settings = build.settings;
    compiler::BenchFacts facts;
    facts.masks = std::ranges::any_of(scene.materials, [](const materials::Material& material) {
        return material.alphaMode != materials::AlphaMode::Opaque;
    });
    for (std::size_t i = range.first; i < range.first + range.count; ++i) {
        const materials::PrimitiveInputs& primitive = build.scenes->primitives()[i];
        const materials::Material& material =
            build.scenes->materials()[static_cast<std::size_t>(primitive.material)];
        facts.passesLight = facts.passesLight || material.alphaMode == materials::AlphaMode::Blend ||
                            compiler::passesLight(material, primitive);
        // Hits that keep only the lobes of the base lose a lobe.
        facts.furtherLobes = facts.furtherLobes || (build.plan.primaryMaskOfPrimitive[i] &
                                                    materials::kLobeMask & ~compiler::baseLobes()) != 0;
    }
    facts.textures = !scene.textures.empty();
    facts.effects = namesOfChosen(build.plan.effects);
    facts.sendsRays = build.plan.effects.effects.rays != 0;
    facts.rayEffects = rayEffects(settings.compile.effects);
    facts.emits = compiler::countEmitters(*build.scenes, index) > 0;
    addAlternatives(build, facts);
    const scene_view::SceneViewData data = sceneView(settings, scene);
    facts.punctualLights = !data.lights.empty();
    const auto directional = std::ranges::count(data.lights, LightView::Type::Directional, &LightView::type);
    facts.directionalLights = directional > 0;
    facts.placedLights = static_cast<std::size_t>(directional) < data.lights.size();
    const compiler::LightCounts counts = countLights(*build.scenes, index, settings.compile.emissiveLights);
    facts.lights = counts.positions + counts.emitters;
    facts.sizedLights =
        std::ranges::any_of(data.lights, [](const LightView& light) { return light.size > 0.0F; });
    return facts;
}

HeadlessOptions deviceOptions(const compiler::Settings& settings) {
    HeadlessOptions options;
    options.validation = settings.validate ? Validation::Synchronization : Validation::Off;
    options.deviceName = settings.device;
    options.pipelineStatistics = settings.gpu == compiler::kThisDevice;
    options.positionFetch = settings.compile.positionFetch;
    const auto has = [](const std::vector<std::string>& layers) {
        return std::ranges::find(layers, "clocks") != layers.end();
    };
    options.shaderClock =
        has(settings.compile.layers) || (settings.package.empty() && has(settings.readLayers));
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
    if (compiler::addsSun(settings, scene)) {
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

RendererOptions rendererOptions(const compiler::Settings& settings) {
    RendererOptions options = settings.renderer;
    options.strategy = settings.strategy.value_or(options.strategy);
    options.bounces = settings.compile.maxBounces;
    options.checkOrder = settings.validate;
    options.screenMarch = settings.frame.screenSteps > 0;
    // Pipelines of cases swap in one after the other where the package can do without them for a while.
    options.backgroundPipelines = options.backgroundPipelines && settings.compile.plan.fallback;
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
