#include "image/image_file.h"

#include <glint/measure/render_settings.h>

#include <algorithm>
#include <charconv>
#include <numbers>

namespace glint::measure {

namespace {

constexpr std::int64_t kMaxScreenSteps = 1024;

constexpr MergePolicy kMergePolicies[] = {MergePolicy::None, MergePolicy::Family, MergePolicy::All,
                                          MergePolicy::Auto, MergePolicy::Profile};

// Returns the lobes for one word of --hit-lobes, which must be one of hitLobeChoices().
FeatureMask lobesNamed(std::string_view word) {
    const MaterialModel& model = builtinMaterialModel();
    if (word == "all") {
        return kLobeMask;
    }
    return word == "base" ? baseLobes() : model.baseModels() | model.mask(word);
}

}  // namespace

FeatureMask baseLobes() {
    const MaterialModel& model = builtinMaterialModel();
    FeatureMask mask = model.baseModels();
    for (const Feature& feature : model.features) {
        mask |= feature.isOfBase ? feature.mask() : 0;
    }
    return mask;
}

bool parseReal(const std::string& text, double min, double max, double& value) {
    const char* const begin = text.data() + (text.starts_with('+') ? 1 : 0);
    const char* const end = text.data() + text.size();
    const auto parsed = std::from_chars(begin, end, value);
    return parsed.ec == std::errc() && parsed.ptr == end && value >= min && value <= max;
}

bool parseSize(const std::string& text, std::uint32_t& width, std::uint32_t& height) {
    const char* end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, width);
    if (first.ec != std::errc() || first.ptr == end || *first.ptr != 'x') {
        return false;
    }
    const auto second = std::from_chars(first.ptr + 1, end, height);
    return second.ec == std::errc() && second.ptr == end && checkImageSize(width, height, "").ok();
}

std::int64_t screenStepsOf(const std::string& text) {
    if (text == "off") {
        return 0;
    }
    std::int64_t steps = 0;
    const char* const end = text.data() + text.size();
    const auto parsed = std::from_chars(text.data(), end, steps);
    return parsed.ec == std::errc() && parsed.ptr == end && steps >= 1 && steps <= kMaxScreenSteps ? steps
                                                                                                   : -1;
}

PlanOptions PlanSettings::options() const {
    PlanOptions plan;
    for (const MergePolicy policy : kMergePolicies) {
        if (merge == toString(policy)) {
            plan.merge = policy;
        }
    }
    plan.maxShaders = static_cast<int>(maxShaders);
    plan.keys.alpha = alpha == "tested" ? AlphaPolicy::Tested : AlphaPolicy::Opaque;
    plan.keys.keptLobes = 0;
    for (const std::string& name : hitLobes) {
        plan.keys.keptLobes |= lobesNamed(name);
    }
    return plan;
}

void AccuracySettings::apply(CompileSettings& settings) const {
    settings.energyCompensation = energyCompensation == "on";
    settings.textureLod = textureLod == "mip0" ? TextureLod::Mip0 : TextureLod::Cones;
    settings.precision = halves() ? package::ShadingPrecision::Half : package::ShadingPrecision::Single;
}

package::Strategy strategyNamed(const std::string& name) {
    const auto* const found = std::ranges::find(
        package::kStrategies, name, [](package::Strategy value) { return package::nameOf(value); });
    return found == std::end(package::kStrategies) ? package::kAllStrategies : *found;
}

package::Tracer tracerNamed(const std::string& name) {
    const auto* const found = std::ranges::find(package::kTracers, name,
                                                [](package::Tracer value) { return package::nameOf(value); });
    return found == std::end(package::kTracers) ? package::kAllTracers : *found;
}

void TracingSettings::apply(CompileSettings& settings, std::uint32_t available) const {
    settings.strategies = 0;
    for (const std::string& name : strategies) {
        settings.strategies |= strategyNamed(name);
    }
    settings.tracers = 0;
    for (const std::string& name : tracers) {
        const bool queries = (available & package::kTracerRayQuery) != 0;
        settings.tracers |= name != "auto" ? tracerNamed(name)
                            : queries      ? package::kTracerRayQuery
                                           : package::kTracerRayPipeline;
    }
    settings.positionFetch = positionFetch;
    settings.strategyChoice = advice;
    settings.shadows =
        shadows == "deferred" ? package::ShadowPlacement::Deferred : package::ShadowPlacement::Inline;
    settings.hitRecord =
        hitRecord == "packed" ? package::HitRecordFormat::Packed : package::HitRecordFormat::Full;
}

void FrameSettings::apply(RendererOptions& options) const {
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(package::Ordering::Count); ++i) {
        const auto candidate = static_cast<package::Ordering>(i);
        if (ordering == package::nameOf(candidate)) {
            options.ordering = candidate;
        }
    }
}

void FrameSettings::apply(FrameOptions& frame) const {
    frame.mirrorRoughness = static_cast<float>(mirrorRoughness);
    if (clamp > 0.0) {
        frame.maxSampleRadiance = static_cast<float>(clamp);
    }
    frame.binning = binning == "sign"         ? Binning::Sign
                    : binning == "octahedral" ? Binning::Octahedral
                                              : Binning::None;
    frame.screenSteps = static_cast<std::uint32_t>(screenStepsOf(ssr));
    frame.screenThickness = static_cast<float>(ssrThickness);
}

void EnvironmentSettings::apply(FrameOptions& frame) const {
    frame.environmentRotation = static_cast<float>(rotation / 180.0 * std::numbers::pi);
    frame.environmentIntensity = static_cast<float>(intensity);
}

void EffectSettings::apply(CompileSettings& settings) const {
    settings.effects = {};
    settings.effects.maxReflectionRoughness = static_cast<float>(maxRoughness);
    for (const std::string& name : effects) {
        settings.effects.automatic = settings.effects.automatic || name == "auto";
        if (name == "all") {
            settings.effects.named = package::kAllEffects;
        }
        for (const package::EffectInfo& info : package::kEffects) {
            settings.effects.named |= name == info.name ? std::uint32_t{info.effect} : 0U;
        }
    }
}

void EffectFrameSettings::apply(RendererOptions& options) const {
    options.batchEffects = batch;
}

void EffectFrameSettings::apply(FrameOptions& frame) const {
    frame.faintWeight = static_cast<float>(skipBelow);
    frame.shadowSamples = static_cast<std::uint32_t>(shadowSamples);
    frame.occlusionSamples = static_cast<std::uint32_t>(occlusionSamples);
    if (occlusionRadius > 0.0) {
        frame.occlusionRadius = static_cast<float>(occlusionRadius);
    }
    frame.occlusionFalloff = occlusionFalloff == "linear";
    frame.maxInterfaces = static_cast<std::uint32_t>(maxInterfaces);
}

void EffectFrameSettings::apply(scene_view::SceneViewData& scene) const {
    for (LightView& light : scene.lights) {
        light.size = light.type == LightView::Type::Directional
                         ? static_cast<float>(0.5 * sunAngle * std::numbers::pi / 180.0)
                         : static_cast<float>(lightRadius);
    }
}

TraversalOrder traversalOrderOf(const RenderSettings& render) {
    return render.traversalOrder == "input"     ? TraversalOrder::Input
           : render.traversalOrder == "halving" ? TraversalOrder::Halving
                                                : TraversalOrder::Auto;
}

package::Strategy strategyOf(const RenderSettings& render) {
    return strategyNamed(render.tracing.strategies.front());
}

std::optional<package::Tracer> tracerOf(const RenderSettings& render) {
    const std::string& name = render.tracing.tracers.front();
    return name == "auto" ? std::nullopt : std::optional(tracerNamed(name));
}

scene_view::SceneViewData sceneView(const RenderSettings& render, const Scene& scene) {
    scene_view::SceneViewData data = scene_view::makeSceneView(scene);
    if (render.addsSun(scene)) {
        data.lights.push_back(scene_view::sunLight());
    }
    render.effectFrame.apply(data);
    data.traversalOrder = traversalOrderOf(render);
    return data;
}

CompileSettings compileSettings(const RenderSettings& render, const PlanOptions& plan, std::uint32_t tracers,
                                const Scene& scene) {
    CompileSettings settings;
    render.tracing.apply(settings, tracers);
    settings.environmentMap = !render.environment.file.empty();
    settings.plan = plan;
    render.accuracy.apply(settings);
    render.effects.apply(settings);
    settings.addsLight = render.addsSun(scene);
    return settings;
}

RendererOptions rendererOptions(const RenderSettings& render) {
    RendererOptions options;
    options.strategy = strategyOf(render);
    parseSize(render.size, options.width, options.height);
    options.tracer = tracerOf(render);
    options.checkOrder = render.validate;
    options.pipelineThreads = static_cast<std::uint32_t>(render.pipelineThreads);
    render.frame.apply(options);
    render.effectFrame.apply(options);
    return options;
}

scene_view::SkyChoice chooseSky(const RenderSettings& render, const Scene& scene,
                                const scene_view::SceneViewData& view) {
    scene_view::SkyChoice choice;
    choice.automatic = render.sky == "auto";
    if (!choice.automatic) {
        parseReal(render.sky, 0.0, kMaxSky, choice.scale);
        return choice;
    }
    if (scene.lights.empty() || !render.environment.file.empty()) {
        return choice;
    }
    return scene_view::skyForLights(scene_view::litPatches(scene, view, view.lights));
}

FrameOptions frameOptions(const RenderSettings& render, const CameraView& camera,
                          const scene_view::SkyChoice& sky, const Environment* environment) {
    FrameOptions options;
    options.camera = camera;
    options.sky = sky.sky();
    options.averagedSamples = static_cast<std::uint32_t>(render.samples);
    render.frame.apply(options);
    render.effectFrame.apply(options);
    options.maxReflectionRoughness = static_cast<float>(render.effects.maxRoughness);
    options.environment = environment;
    render.environment.apply(options);
    options.seed = static_cast<std::uint32_t>(render.seed);
    return options;
}

}  // namespace glint::measure
