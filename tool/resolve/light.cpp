#include "resolve/light.h"

#include "base/text.h"
#include "resolve/host.h"
#include "settings/settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <interop/frame.h>
#include <interop/lights.h>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace glint::compiler {

namespace {

// Samples of emissive triangles grow with the cube root of their number, between these bounds. docs/lights.md
// has the measurements.
constexpr double kFewestOfEmitters = 2.0;
constexpr double kMostOfEmitters = 8.0;

std::uint32_t samplesOfEmitters(std::size_t emitters) {
    const double root = std::round(std::cbrt(static_cast<double>(emitters)));
    return static_cast<std::uint32_t>(std::clamp(root, kFewestOfEmitters, kMostOfEmitters));
}

bool takesAll(std::size_t lights) {
    return lights == 0 || std::ranges::all_of(fitted::kLightScenes, [&](const fitted::LightTimes& scene) {
               return lightTime(scene, lights, 0) <= lightTime(scene, lights, fitted::kLightSamples);
           });
}

}  // namespace

double lightTime(const fitted::LightTimes& scene, std::size_t lights, std::uint32_t samples) {
    const auto count = static_cast<double>(lights);
    const double each = scene.sample + scene.level * std::log2(count);
    return scene.rest + (samples == 0 ? scene.light * count : samples * each);
}

std::uint32_t lightSamplesFor(const LightCounts& counts) {
    if (counts.emitters == 0) {
        return takesAll(counts.positions) ? 0 : fitted::kLightSamples;
    }
    // With fewer samples, one further light that is apart from the triangles would make all of them cheap.
    return counts.areApart ? samplesOfEmitters(counts.emitters) : fitted::kLightSamples;
}

namespace {

// The files of a host that decide where emissive triangles and their materials are, those that decide what
// the sky is and who samples it, and that of punctual lights. With steps the host's scene says where the
// triangles are, in whatever format its geometry is.
constexpr std::string_view kEmitterFiles[] = {"lights.glsl", "material.glsl", "geometry.glsl"};
constexpr std::span<const std::string_view> kEmitterFilesOfSteps = std::span(kEmitterFiles).first(2);
constexpr std::string_view kSkyFiles[] = {"lights.glsl", "sky.glsl"};
constexpr std::string_view kLightFiles[] = {"lights.glsl"};

// At rest, or at a time of an animation.
bool isLit(const gltf::Scene& scene) {
    return std::ranges::any_of(scene.lights,
                               [](const gltf::Light& light) { return light.shines() || light.canShine; });
}

const std::vector<materials::EffectDeclaration>& declaredEffects(const gltf::SceneList& scenes) {
    return scenes.materials().empty() ? materials::builtinMaterialModel().effects
                                      : scenes.materials().front().model().effects;
}

class LightPlanner {
public:
    LightPlanner(const gltf::SceneList& scenes, const CompileSettings& settings,
                 std::vector<std::string> replaced, const EffectPlan& ofLit)
        : scenes_(scenes),
          settings_(settings),
          replaced_(std::move(replaced)),
          lit_(ofLit),
          plan_{.effects = lit_} {}

    Result<LightPlan> plan() && {
        GLINT_TRY(plan_.emissive,
                  decide(settings_.emissiveLights, [&] { return emits(); },
                         replaces(isOfSteps() ? kEmitterFilesOfSteps : std::span(kEmitterFiles)),
                         {"emissive-lights", "", "the lights or the geometry"}));
        GLINT_TRY(plan_.sky,
                  decide(settings_.skyLight, [&] { return settings_.skyLight == SkyLight::On || scatters(); },
                         replaces(kSkyFiles), {"sky-light", " and a sky", "the lights or the sky"}));
        GLINT_TRY(plan_.sized,
                  decide(settings_.sizedLights,
                         [&] { return settings_.sizedLights == SizedLights::On || settings_.sizesLights; },
                         replaces(kLightFiles), {"sized-lights", "", "the lights"}));
        plan_.disks = disks();
        GLINT_TRY_DO(countSamples());
        const bool isAnyLit = settings_.addsLight || plan_.emissive == EmissiveLights::On ||
                              plan_.sky == SkyLight::On || std::ranges::any_of(scenes_.scenes(), isLit);
        if (!isAnyLit) {
            plan_.effects = planEffects(scenes_, settings_, false);
        }
        return std::move(plan_);
    }

private:
    // The words of messages about a kind of lights.
    struct Wording {
        std::string_view option;
        std::string_view needs;
        std::string_view ofHost;
    };

    // Returns whether there are emissive triangles, and no more than the setting takes.
    bool emits() const {
        std::size_t most = 0;
        for (std::size_t i = 0; i < scenes_.scenes().size(); ++i) {
            most = std::max(most, countEmitters(scenes_, i));
        }
        return most > 0 && (settings_.emissiveLights == EmissiveLights::On || most <= kMostEmitters);
    }

    // Returns whether rays bring the light of the sky, and of surfaces in front of it, to surfaces that
    // scatter it. If none do, the ambient term stands for both: samples of the sky would replace it by the
    // first alone.
    bool scatters() const {
        const std::vector<materials::EffectDeclaration>& declared = declaredEffects(scenes_);
        return !scenes_.materials().empty() &&
               std::ranges::any_of(declared, [&](const materials::EffectDeclaration& effect) {
                   return (lit_.effects.rays & materials::findEffect(declared, effect.name)) != 0 &&
                          !effect.refines.empty();
               });
    }

    bool replaces(std::span<const std::string_view> files) const {
        return std::ranges::any_of(files, [&](std::string_view file) {
            return std::ranges::find(replaced_, file) != replaced_.end();
        });
    }

    bool isOfSteps() const {
        return settings_.passes == package::Passes::Steps;
    }

    // Steps have disks because the scene is a program's, which glTF does not limit.
    DiskLights disks() const {
        const bool isUseful =
            isOfSteps() || plan_.emissive == EmissiveLights::On || plan_.sized == SizedLights::On;
        return settings_.diskLights != DiskLights::Auto ? settings_.diskLights
               : isUseful                               ? DiskLights::On
                                                        : DiskLights::Off;
    }

    // Returns On or Off. `isUseful` says whether these lights would change the picture. `ofHost`: a host has
    // them itself. Without a word of the user's, steps have none: a host's scene may not know of them.
    template <typename Choice, typename IsUseful>
    Result<Choice> decide(Choice asked, const IsUseful& isUseful, bool ofHost, const Wording& wording) const {
        const bool isOn = asked == Choice::On;
        const bool isAutoOff = settings_.maxBounces == 1 || isOfSteps();
        if (asked == Choice::Off || (!isOn && isAutoOff) || !isUseful()) {
            return Choice::Off;
        }
        const bool isUnlit = isOfSteps() && settings_.answer == package::HitAnswer::Surface;
        const std::string why = ofHost    ? fmt::format("{} are the host's", wording.ofHost)
                                : isUnlit ? "hits answer with surfaces, which the host lights"
                                : lit_.effects.lights == 0 ? "the package has no effect shadow"
                                                           : "";
        if (isOn && !why.empty()) {
            return makeError(
                std::string(wording.option), "",
                fmt::format("--{} needs shadow rays{} of Glint's own: {}", wording.option, wording.needs,
                            why),
                fmt::format("{}, or leave out --{}",
                            isUnlit ? "use --answer radiance" : "add the effect shadow", wording.option));
        }
        return why.empty() ? Choice::On : Choice::Off;
    }

    // Without a number in the settings it is the most of lightSamplesFor() over the scenes. A host that has
    // its own lights has no hierarchy. With steps nobody knows how many lights the host's scene has: auto
    // takes all, and the samples of many emissive triangles where these are lights.
    Status countSamples() {
        const bool ofHost = replaces(kLightFiles);
        if (settings_.lightSamples) {
            plan_.samples = *settings_.lightSamples;
            return !ofHost || plan_.samples == 0
                       ? okStatus()
                       : Status(makeError(
                             "lights", "",
                             fmt::format(
                                 "--lights {} needs the hierarchy of Glint's renderer, and the lights "
                                 "are the host's",
                                 plan_.samples),
                             "leave out --lights, and let the host's hostLight() choose"));
        }
        if (isOfSteps()) {
            const bool emits = plan_.emissive == EmissiveLights::On;
            plan_.samples = emits ? samplesOfEmitters(kMostEmitters) : 0;
            return okStatus();
        }
        for (std::size_t i = 0; i < scenes_.scenes().size() && !ofHost; ++i) {
            plan_.samples = std::max(plan_.samples, lightSamplesFor(countLights(scenes_, i, plan_.emissive)));
        }
        return okStatus();
    }

    const gltf::SceneList& scenes_;
    const CompileSettings& settings_;
    const std::vector<std::string> replaced_;  // files of shaders/host
    const EffectPlan& lit_;                    // of a package with a light
    LightPlan plan_;
};

}  // namespace

EffectPlan planEffects(const gltf::SceneList& scenes, const CompileSettings& settings, bool isLit) {
    EffectPlan plan = decideEffects(scenes.materials(), scenes.primitives(), {isLit}, settings.effects);
    if (settings.passes == package::Passes::Steps) {
        // The host decides which surfaces send rays. What hits need of the effects is their shadow rays.
        const bool lights = settings.answer == package::HitAnswer::Radiance;
        plan.effects = effectSetOf(declaredEffects(scenes), lights ? plan.effects.lights : 0U);
        for (EffectDecision& decision : plan.decisions) {
            if (decision.chosen && (plan.effects.all & decision.effect) == 0) {
                decision.chosen = false;
                decision.reason = "the steps of a host's own rays have no effects but the shadows of hits";
            }
        }
    }
    return plan;
}

Result<LightPlan> planLight(const gltf::SceneList& scenes, const CompileSettings& settings,
                            const EffectPlan& ofLit) {
    GLINT_TRY(auto replaced, replacedHostFiles(settings.host));
    return LightPlanner(scenes, settings, std::move(replaced), ofLit).plan();
}

std::size_t countEmitters(const gltf::SceneList& scenes, std::size_t index) {
    const gltf::Scene& scene = scenes.scenes()[index];
    const gltf::SceneList::Range range = scenes.primitivesOf(index);
    std::vector<std::size_t> ofMeshes(scene.meshes.size());
    for (const materials::PrimitiveInputs& primitive :
         scenes.primitives().subspan(range.first, range.count)) {
        if (isEmitter(scenes.materials()[static_cast<std::size_t>(primitive.material)], primitive)) {
            const auto mesh = static_cast<std::size_t>(primitive.mesh);
            ofMeshes[mesh] +=
                scene.meshes[mesh].primitives[static_cast<std::size_t>(primitive.primitive)].indices.size() /
                3;
        }
    }
    std::size_t count = 0;
    for (const gltf::Node& node : scene.nodes) {
        if (node.mesh >= 0 && node.canShow) {
            const std::size_t copies =
                node.instancing < 0 ? 1 : scene.instancings[static_cast<std::size_t>(node.instancing)].count;
            count += copies * ofMeshes[static_cast<std::size_t>(node.mesh)];
        }
    }
    return count;
}

LightCounts countLights(const gltf::SceneList& scenes, std::size_t index, EmissiveLights emissive) {
    const auto hasPosition = [](const gltf::Light& light) {
        return light.type != gltf::LightType::Directional;
    };
    LightCounts counts;
    counts.positions =
        static_cast<std::size_t>(std::ranges::count_if(scenes.scenes()[index].lights, hasPosition));
    counts.emitters = emissive == EmissiveLights::On ? countEmitters(scenes, index) : 0;
    counts.areApart = counts.emitters > 0 && counts.positions <= gpu::kMostLightsApart;
    return counts;
}

namespace {

// Surfaces with more shadow rays trace them inline, because each round of kMostFirstShadowRays shades them
// once more.
constexpr std::size_t kMostDeferredRays = std::size_t{4} * gpu::kMostFirstShadowRays;

// Returns the most shadow rays of a surface, apart from those to further points of area lights.
std::size_t mostShadowRays(const gltf::SceneList& scenes, const CompileSettings& compile) {
    std::size_t most = 0;
    for (std::size_t i = 0; i < scenes.scenes().size(); ++i) {
        const LightCounts counts = countLights(scenes, i, compile.emissiveLights);
        const std::size_t punctual = scenes.scenes()[i].lights.size() + (compile.addsLight ? 1 : 0);
        const std::size_t apart = counts.areApart ? punctual : punctual - counts.positions;
        const std::size_t samples = compile.lightSamples.value_or(0);
        const std::size_t found = compile.sizedLights == SizedLights::On ? punctual : 0;
        most = std::max(most, found + (samples > 0 ? apart + samples : punctual + counts.emitters));
    }
    return most + (compile.skyLight == SkyLight::On ? 1 : 0);
}

}  // namespace

Result<FirstShadowPlan> planFirstShadows(const gltf::SceneList& scenes, const Plan& plan,
                                         const CompileSettings& compile, bool chooses) {
    const bool showsLight = std::ranges::any_of(plan.layers, [](const package::LayerInfo::Entry& entry) {
        return entry.effect == 0 && entry.layer == package::findLayer("radiance")->number;
    });
    const package::EffectSet& effects = plan.effects.effects;
    const std::string why = showsLight              ? "a layer shows the light of lights by itself"
                            : effects.surfaces != 0 ? "an effect traces rays at the same surfaces"
                            : !compile.host.empty() ? "a host may have any number of lights"
                                                    : "";
    if (!chooses && compile.firstShadows == package::ShadowPlacement::Deferred && !why.empty()) {
        return makeError("first-shadows", scenes.path(),
                         "the shadow rays of first hits can't be deferred: " + why,
                         "use --first-shadows inline, or leave out the option");
    }
    const std::size_t most = mostShadowRays(scenes, compile);
    const bool wanted = chooses ? why.empty() && most <= kMostDeferredRays
                                : compile.firstShadows == package::ShadowPlacement::Deferred;
    const bool hasRays = compile.passes == package::Passes::Frame && effects.lights != 0;
    return FirstShadowPlan{
        wanted && hasRays ? package::ShadowPlacement::Deferred : package::ShadowPlacement::Inline,
        static_cast<std::uint32_t>(std::clamp<std::size_t>(most, 1, gpu::kMostFirstShadowRays))};
}

bool addsSun(const Settings& settings, const gltf::Scene& scene) {
    const bool isUnlit = scene.lights.empty() && settings.environment.empty();
    return settings.sun == Sun::On || (settings.sun == Sun::Auto && isUnlit);
}

EmitterFeatures emitterFeatures(const gltf::SceneList& scenes, const Plan& plan, bool fallback) {
    const materials::MaterialModel& model = *plan.model;
    materials::FeatureMask covers = 0;
    for (const materials::FeatureCode& code : model.code) {
        covers |= code.coversEmission ? model.features[static_cast<std::size_t>(code.feature)].mask() : 0;
    }
    std::vector<materials::FeatureMask> masks;
    EmitterFeatures result;
    for (std::size_t i = 0; i < scenes.primitives().size(); ++i) {
        const materials::PrimitiveInputs& primitive = scenes.primitives()[i];
        if (isEmitter(scenes.materials()[static_cast<std::size_t>(primitive.material)], primitive)) {
            masks.push_back(plan.primaryMaskOfPrimitive[i]);
            result.coveredByLayers = result.coveredByLayers || (masks.back() & covers) != 0;
        }
    }
    if (fallback) {
        masks = {0, plan.primaryAlways | plan.primarySometimes};
        result.coveredByLayers = (masks.back() & covers) != 0;
    }
    result.read = result.coveredByLayers ? materials::kAllFeatures
                                         : covers | model.featuresFor(package::Role::Emission) |
                                               model.featuresFor(package::Role::EmissionStrength);
    materials::FeatureMask any = 0;
    result.always = masks.empty() ? 0 : result.read;
    for (const materials::FeatureMask& mask : masks) {
        any |= mask & result.read;
        result.always &= mask;
    }
    result.sometimes = any & ~result.always;
    return result;
}

package::ShadowThrough shadowThroughOf(const gltf::SceneList& scenes, const Plan& plan,
                                       const CompileSettings& settings) {
    using enum package::ShadowThrough;
    // Rays of a host's own ask for visibility without an effect.
    const bool tracesLight = plan.effects.effects.lights != 0 || settings.passes == package::Passes::Steps;
    if (settings.shadowThrough == Alpha || !tracesLight) {
        return Alpha;
    }
    const bool passesBlended = settings.plan.keys.alpha == package::AlphaPolicy::Stochastic;
    const auto asked = [&](const materials::PrimitiveInputs& primitive) {
        const materials::Material& material =
            scenes.materials()[static_cast<std::size_t>(primitive.material)];
        return (passesBlended && material.alphaMode == materials::AlphaMode::Blend) ||
               (settings.shadowThrough == Glass && passesLight(material, primitive));
    };
    return std::ranges::any_of(scenes.primitives(), asked) ? settings.shadowThrough : Alpha;
}

// --- Layers ---

using package::LayerInfo;

const LayerInfo& infoOf(const LayerInfo::Entry& entry) {
    return *package::findLayer(entry.layer);
}

const materials::EffectDeclaration& declarationOf(const materials::MaterialModel& model,
                                                  package::Effect effect) {
    return model.effects[package::effectNumber(effect)];
}

const LayerInfo& albedoOf(package::Effect effect, const materials::MaterialModel& model) {
    const std::string lobes = effect == 0 ? std::string() : declarationOf(model, effect).albedo;
    return *package::findLayer(lobes.empty() ? std::string("albedo") : "albedo-" + lobes);
}

bool demodulates(const LayerInfo& info) {
    return info.name.ends_with("demodulated");
}

namespace {

// The words of --layers for several layers at once.
constexpr std::string_view kEveryLayer = "all";
constexpr std::string_view kSurfaceLayers = "surface";

// The images of a layer that the package may have. `bounces` have layers of their own.
std::vector<LayerInfo::Entry> entriesOf(const LayerInfo& info, const Plan& plan, std::uint32_t bounces) {
    std::vector<LayerInfo::Entry> entries;
    if (!package::hasSources(info) || info.subject == LayerInfo::Subject::Light) {
        entries.push_back({info.number, 0, 0});
    }
    package::forEachEffect(plan.effects.effects.rays, [&](std::uint32_t number) {
        const package::Effect effect = 1U << number;
        const bool moves =
            info.subject == LayerInfo::Subject::Ray && (info.demands & package::LayerInfo::kHistory) != 0;
        if (info.subject == LayerInfo::Subject::Bounce) {
            for (std::uint32_t bounce = 1; bounce <= bounces; ++bounce) {
                entries.push_back({info.number, effect, bounce});
            }
        } else if (package::hasSources(info) && (!moves || !plan.model->effects[number].shows.empty())) {
            entries.push_back({info.number, effect, 0});
        }
    });
    return entries;
}

// Returns the number of bounces of the package's paths that have layers of their own; 0 if paths have one
// bounce.
std::uint32_t layerBouncesOf(const Plan& plan, const CompileSettings& settings) {
    const bool hasPaths = plan.effects.effects.rays != 0 && settings.maxBounces > 1;
    return hasPaths ? std::min(settings.maxBounces, package::kMostLayerBounces) : 0;
}

// The layers that a word stands for, with all their sources. Empty if it is "SOURCE.LAYER".
std::vector<const LayerInfo*> layersNamed(std::string_view word) {
    std::vector<const LayerInfo*> named;
    for (const LayerInfo& info : package::layerTable()) {
        const bool isSurface = info.subject == LayerInfo::Subject::Surface;
        const bool inGroup =
            !info.isDiagnostic && (word == kEveryLayer || (word == kSurfaceLayers && isSurface));
        if (inGroup || word == info.name) {
            named.push_back(&info);
        }
    }
    return named;
}

// Resolves "reflection.radiance", or "reflection" for all layers of the effect.
Status addOfSource(std::string_view word, const Plan& plan, std::uint32_t bounces, const std::string& where,
                   std::vector<LayerInfo::Entry>& entries) {
    const std::size_t dot = std::min(word.find('.'), word.size());
    const std::string source(word.substr(0, dot));
    const std::string_view layer = word.substr(std::min(dot + 1, word.size()));
    std::vector<std::string> known{std::string(package::kDirectLight)};
    package::forEachEffect(plan.effects.effects.rays,
                           [&](std::uint32_t number) { known.push_back(plan.model->effects[number].name); });
    if (std::ranges::find(known, source) == known.end()) {
        const bool exists = findEffect(plan.model->effects, source) != 0;
        return makeError(
            "layer-effect", where,
            exists
                ? fmt::format("the package has no effect {} with rays, so there is no layer {}", source, word)
                : fmt::format("there is no effect {}{}", source, base::suggestion(source, known)),
            fmt::format("layers are of {}; --effects decides which effects the package has",
                        fmt::join(known, ", ")));
    }
    // 0 for the direct light, which no effect is called.
    const package::Effect effect = findEffect(plan.model->effects, source);
    const std::size_t before = entries.size();
    for (const LayerInfo& info : package::layerTable()) {
        const bool wanted = layer.empty() ? !info.isDiagnostic : layer == info.name;
        if (!wanted || !package::hasSources(info)) {
            continue;
        }
        for (const LayerInfo::Entry& entry : entriesOf(info, plan, bounces)) {
            if (entry.effect == effect) {
                entries.push_back(entry);
            }
        }
    }
    return entries.size() > before
               ? okStatus()
               : Status(
                     makeError("layer-effect", where, fmt::format("{} has no layer {}", source, layer),
                               "see docs/layers.md for which layers a source of light has; those of bounces "
                               "need --bounces"));
}

// Adds what others are computed from.
void addNeeded(const Plan& plan, std::vector<LayerInfo::Entry>& entries) {
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const LayerInfo::Entry entry = entries[i];
        const LayerInfo& info = infoOf(entry);
        if (!info.from.empty()) {
            entries.push_back({package::findLayer(info.from)->number, entry.effect, entry.bounce});
        }
        if (demodulates(info)) {
            entries.push_back({albedoOf(entry.effect, *plan.model).number, 0, 0});
        }
    }
    const auto place = [](const LayerInfo::Entry& entry) {
        const auto row = std::ranges::find(package::layerTable(), entry.layer, &LayerInfo::number);
        return std::tuple(row - package::layerTable().begin(), entry.effect, entry.bounce);
    };
    std::ranges::sort(entries, {}, place);
    entries.erase(std::unique(entries.begin(), entries.end()), entries.end());
}

}  // namespace

Result<std::vector<LayerInfo::Entry>> resolveLayers(const Plan& plan, const CompileSettings& settings,
                                                    const std::string& where) {
    std::vector<LayerInfo::Entry> entries;
    const std::uint32_t bounces = layerBouncesOf(plan, settings);
    for (const std::string& asked : settings.layers) {
        const bool isOptional = asked.ends_with(kOptionalLayer);
        const std::string word = asked.substr(0, asked.size() - (isOptional ? 1 : 0));
        const std::vector<const LayerInfo*> named = layersNamed(word);
        const std::size_t before = entries.size();
        for (const LayerInfo* const info : named) {
            std::ranges::copy(entriesOf(*info, plan, bounces), std::back_inserter(entries));
        }
        if (named.empty()) {
            GLINT_TRY_DO(addOfSource(word, plan, bounces, where, entries));
        } else if (entries.size() == before && !isOptional) {
            return makeError("layer-effect", where,
                             fmt::format("nothing in the package has the layer {}", word),
                             named.front()->subject == LayerInfo::Subject::Bounce
                                 ? "add an effect with rays by --effects, and --bounces"
                                 : "add an effect with rays by --effects");
        }
    }
    if (!entries.empty() && settings.passes != package::Passes::Frame) {
        return makeError("passes", where, "--layers is about frames, and --passes steps draws none",
                         "leave out --layers, or --passes steps");
    }
    addNeeded(plan, entries);
    return entries;
}

std::string layerNameOf(const LayerInfo::Entry& entry, const materials::MaterialModel& model) {
    const std::string_view source =
        entry.effect == 0 ? package::kDirectLight : declarationOf(model, entry.effect).name;
    return package::layerName(infoOf(entry), source, entry.bounce);
}

}  // namespace glint::compiler
