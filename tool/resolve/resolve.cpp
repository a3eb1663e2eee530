#include "resolve/resolve.h"

#include "base/clock.h"
#include "base/text.h"
#include "cache/action.h"
#include "materials/declarations.h"
#include "plan/frame_time.h"
#include "resolve/build.h"
#include "resolve/light.h"
#include "resolve/lock_file.h"
#include "resolve/profile.h"
#include "scene/deformed.h"
#include "settings/descriptor.h"
#include "spirv/compiler.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

namespace glint::compiler {

namespace {

std::vector<std::uint32_t> retiredIds(const Plan& plan) {
    std::vector<std::uint32_t> ids;
    for (const Case& shaderCase : plan.cases) {
        if (shaderCase.isRetired()) {
            ids.push_back(static_cast<std::uint32_t>(shaderCase.shaderId));
        }
    }
    return ids;
}

}  // namespace

package::PackageShape shapeOf(const gltf::SceneList& scenes, const Plan& plan,
                              const CompileSettings& settings) {
    return {settings.strategies,
            settings.tracers,
            settings.shadows,
            plan.effects.effects,
            settings.plan.keys.alpha != package::AlphaPolicy::Opaque,
            static_cast<std::uint32_t>(plan.cases.size()),
            retiredIds(plan),
            std::ranges::any_of(scenes.scenes(), hasDeformedMesh),
            settings.passes,
            settings.maxBounces,
            settings.plan.fallback,
            settings.shadowThrough != package::ShadowThrough::Alpha,
            settings.firstShadows == package::ShadowPlacement::Deferred ? settings.firstShadowRays : 0};
}

namespace {

Status checkPositionFetch(const CompileSettings& settings, const std::string& where) {
    if (!supportsPositionFetch()) {
        return makeError(
            "position-fetch", where,
            fmt::format(
                "position fetch needs GL_EXT_ray_tracing_position_fetch, which this glint's glslang {} "
                "does not know",
                glslangVersion()),
            "build glint with glslang 12.2 or newer, as Debian 13 has it, or leave out --position-fetch");
    }
    const std::uint32_t able = settings.strategies & ~package::orderedStrategies();
    const bool byQuery =
        (able & ~package::pipelineStrategies()) != 0 && (settings.tracers & package::kTracerRayQuery) != 0;
    if (!byQuery && (able & package::pipelineStrategies()) == 0) {
        return makeError("position-fetch", where,
                         fmt::format("no shader of this package could fetch positions: only {} with ray "
                                     "queries and {} can, because they shade a hit where they find it",
                                     fmt::join(strategyNames(~package::orderedStrategies() &
                                                             ~package::pipelineStrategies()),
                                               ", "),
                                     fmt::join(strategyNames(package::pipelineStrategies()), ", ")),
                         "add one of these strategies, or leave out --position-fetch");
    }
    return okStatus();
}

Status checkSettings(const CompileSettings& settings, const std::string& where) {
    if (settings.strategies == 0 || settings.strategies > package::allStrategies()) {
        return makeError(
            "strategy", where, fmt::format("{:#x} is no set of strategies", settings.strategies),
            fmt::format("choose among {}", fmt::join(strategyNames(package::allStrategies()), ", ")));
    }
    if (settings.tracers == 0 || settings.tracers > package::kAllTracers) {
        return makeError("tracer", where, fmt::format("{:#x} is no set of tracers", settings.tracers),
                         "choose ray-query, ray-pipeline or both");
    }
    if (settings.passes == package::Passes::Frame && settings.answer != package::HitAnswer::Radiance) {
        return makeError("passes", where, "a frame needs the radiance of its hits",
                         "add --passes steps, or leave out --answer surface");
    }
    if (settings.passes == package::Passes::Frame && settings.bindings != package::Bindings()) {
        return makeError("passes", where, "the renderer of whole frames has bindings of its own",
                         "add --passes steps, or leave out --bindings");
    }
    if (settings.passes == package::Passes::Steps && settings.textureLevels) {
        return makeError("passes", where,
                         "--texture-levels notes what a frame reads, and --passes steps has none",
                         "leave out --texture-levels, or --passes steps");
    }
    if (settings.maxBounces == 0 || settings.maxBounces > package::kMaxBounces) {
        return makeError("bounces", where,
                         fmt::format("paths of {} bounces cannot be followed", settings.maxBounces),
                         fmt::format("choose 1 to {}", package::kMaxBounces));
    }
    if (settings.answer == package::HitAnswer::Surface && settings.maxBounces > 1) {
        return makeError("bounces", where, "rays that are answered with a surface end there",
                         "leave out --bounces, or --answer surface");
    }
    if (settings.bindings.pushOffset % 8 != 0) {
        return makeError("bindings", where,
                         fmt::format("push-offset={} is no multiple of 8, which the addresses in the push "
                                     "constants need",
                                     settings.bindings.pushOffset),
                         "choose a multiple of 8");
    }
    return settings.positionFetch ? checkPositionFetch(settings, where) : okStatus();
}

template <typename Values>
std::vector<std::string> namesIn(std::uint32_t bits, const Values& values) {
    std::vector<std::string> names;
    for (const auto value : values) {
        if ((bits & value) != 0) {
            names.emplace_back(package::nameOf(value));
        }
    }
    return names;
}

// Returns the strategies that can be chosen, in the order of simplestFirst(): those that the package has, if
// there is one, and that the device can run, if one is known, by `tracer` if that is given.
std::vector<std::string> runnableStrategies(const Target& target, std::optional<package::Tracer> tracer) {
    const std::uint32_t wanted = tracer ? std::uint32_t{*tracer} : package::kAllTracers;
    const std::uint32_t compiled = target.package ? target.package->shape.tracers : package::kAllTracers;
    std::vector<std::string> names;
    for (const std::string_view name : simplestFirst()) {
        const package::Strategy strategy = *valueNamed<package::Strategy>(name);
        const bool has = !target.package || (target.package->shape.strategies & strategy) != 0;
        // Some strategies need ray tracing pipelines, whatever the package's tracers are.
        const std::uint32_t tracers = package::tracersOf(strategy, compiled);
        if (has && (tracers & wanted & target.tracers.value_or(package::kAllTracers)) != 0) {
            names.emplace_back(name);
        }
    }
    // Features that the device lacks are reported when the package is used.
    return names.empty() && target.package ? strategyNames(target.package->shape.strategies) : names;
}

// Decides one thing after the other. Each step relies on those before it.
class Resolver {
public:
    Resolver(std::shared_ptr<const gltf::SceneList> list, const Settings& asked, const Target& target)
        : target_(target), scenes_(*list), settings_(build_.settings), compile_(build_.settings.compile) {
        build_.scenes = std::move(list);
        build_.asked = asked;
        build_.settings = asked;
        build_.draws = target.tracers.has_value();
    }

    Result<Build> resolve() && {
        const base::Clock::time_point start = base::Clock::now();
        takePurpose();
        decideByGpu();
        GLINT_TRY_DO(decideKeys());
        GLINT_TRY_DO(decideLight());
        GLINT_TRY_DO(decideCases());
        GLINT_TRY_DO(decideStrategy());
        if (!target_.package) {
            GLINT_TRY_DO(checkSettings(compile_, scenes_.path()));
            GLINT_TRY(build_.plan.layers, resolveLayers(build_.plan, compile_, scenes_.path()));
            compile_.shadowThrough = shadowThroughOf(scenes_, build_.plan, compile_);
            GLINT_TRY_DO(decideFirstShadows());
            warnOfEffects();
        }
        build_.plan.emitters = emitterFeatures(scenes_, build_.plan, compile_.plan.fallback);
        build_.excess = describeExcess(build_.plan, compile_.plan);
        build_.milliseconds = base::millisecondsSince(start);
        return std::move(build_);
    }

private:
    // Decides the settings that follow from the purpose of the package.
    void takePurpose() {
        compile_.trustTextures = trustsTextures(settings_, package());
        compile_.effects.maxReflectionRoughness = settings_.frame.maxReflectionRoughness;
        if (target_.package) {
            compile_.plan.fallback = target_.package->shape.fallback;
        }
        if (settings_.countsHits) {
            compile_.plan.merge = MergePolicy::None;
        }
        if (build_.draws) {
            compile_.environmentMap = !settings_.environment.empty();
            compile_.addsLight = addsSun(settings_, scenes_.scenes().front());
            compile_.sizesLights = settings_.lightRadius > 0.0 || settings_.sunAngle > 0.0;
            compile_.emitHeader = false;
        }
        settings_.sun = compile_.addsLight ? Sun::On : Sun::Off;
        if (build_.draws && !target_.package) {
            compile_.layers.insert(compile_.layers.end(), settings_.readLayers.begin(),
                                   settings_.readLayers.end());
        }
    }

    // Decides what the table of a GPU decides: the cost of branches, and settings that are `auto`. A finished
    // package has decided about these itself.
    void decideByGpu() {
        if (target_.package) {
            return;
        }
        const GpuCosts* const gpu = target_.costs.gpu ? &*target_.costs.gpu : nullptr;
        if (gpu != nullptr) {
            compile_.plan.branchFactor = branchFactor(*gpu).value_or(1.0);
        }
        Configuration decided;
        for (const GpuChoice& choice : chooseSettings(gpu, settings_.precisionError)) {
            if (sweptSetting(choice.setting)->values.text(settings_) == "auto") {
                decided.emplace(choice.setting, choice.value);
                build_.messages.push_back(
                    {Severity::Note, "gpu-choice", "",
                     fmt::format("--{} auto is {}: {}", choice.setting, choice.value, choice.why), ""});
            }
        }
        settings_ = withSettings(settings_, decided);
    }

    Status decideKeys() {
        PlanOptions& options = compile_.plan;
        std::vector<Diagnostic>& messages = build_.messages;
        decideAlpha();
        GLINT_TRY_DO(keepPackLobes());
        build_.plan = planKeys(scenes_.materials(), scenes_.primitives(), options.keys);
        if (!settings_.profile.empty()) {
            GLINT_TRY(options.hits, readHits(settings_.profile, scenes_, build_.plan, options, messages));
        }
        std::stable_partition(messages.begin(), messages.end(), [](const Diagnostic& message) {
            return message.severity == Severity::Warning;
        });
        return okStatus();
    }

    // Decides which keys share a case. Which is best depends on the rays, and so on the effects.
    Status decideCases() {
        PlanOptions& options = compile_.plan;
        std::vector<Diagnostic>& messages = build_.messages;
        const LockRequest& lock = settings_.lock;
        LockText before;
        if (!lock.file.empty()) {
            GLINT_TRY(before, readLock(lock, *build_.plan.model));
            options.lockedIds = before.ids;
        }
        std::vector<MergeCandidate> candidates;
        const auto compare = [&](const Plan& plan) {
            const std::vector<WeightedKey> keys = weightedKeys(plan, options);
            const int most = budgetOf(options) > 0 ? budgetOf(options) : kDefaultMaxCases;
            candidates = mergeCandidates(keys, most);
            const FrameModel model = modelOf(plan);
            build_.mergedFor = model.strategies;
            build_.merges = estimateMerges(model, keys, candidates);
        };
        CaseChooser choose;
        if (!target_.package) {
            choose = [&](const Plan& plan) {
                compare(plan);
                if (plan.keys.empty()) {
                    return std::vector<CaseKeys>();
                }
                const auto chosen = std::ranges::find(build_.merges, true, &MergeEstimate::chosen);
                messages.push_back({Severity::Note, "merge-choice", "",
                                    describeChoice(build_.merges, build_.mergedFor, choosesStrategy()), ""});
                return candidates[static_cast<std::size_t>(chosen - build_.merges.begin())].cases;
            };
        }
        build_.plan = planCases(std::move(build_.plan), scenes_.primitives(), options, choose);
        if (settings_.advisesStrategy && build_.merges.empty()) {
            compare(build_.plan);
        }
        if (!lock.file.empty()) {
            GLINT_TRY(build_.lockText, updateLock(lock, before, scenes_, build_.plan, messages));
        }
        return okStatus();
    }

    // Returns what is known of frames while keys have no cases yet.
    FrameModel modelOf(const Plan& plan) const {
        FrameModel model{{}, frameShape(), target_.costs.device, {}, choosesStrategy()};
        model.strategies = model.takesFastest ? availableStrategies()
                           : build_.draws ? strategyNames(*settings_.strategy | settings_.furtherStrategies)
                                          : strategyNames(compile_.strategies);
        for (std::size_t i = 0; i < scenes_.scenes().size(); ++i) {
            const gltf::SceneList::Range range = scenes_.primitivesOf(i);
            const auto primitives = scenes_.primitives().subspan(range.first, range.count);
            model.scenes.push_back({frameRounds(scenes_.materials(), primitives, model.shape),
                                    keysOfScene(plan, compile_.plan, primitives, range.first)});
        }
        return model;
    }

    // Chooses the policy of `--alpha auto`, and reports it if a scene has surfaces that are not opaque.
    void decideAlpha() {
        using enum package::AlphaPolicy;
        const std::optional<package::AlphaPolicy> asked =
            target_.package ? std::optional(target_.package->alpha) : settings_.alpha;
        std::vector<std::string> blended;
        for (const materials::Material& material : scenes_.materials()) {
            if (material.alphaMode == materials::AlphaMode::Blend) {
                blended.push_back(material.name.empty() ? "a material without a name" : material.name);
            }
        }
        const package::AlphaPolicy needed =
            asked && blended.empty() ? *asked : neededAlphaPolicy(scenes_.materials(), scenes_.primitives());
        const package::AlphaPolicy chosen = asked.value_or(needed);
        settings_.alpha = compile_.plan.keys.alpha = chosen;
        const auto note = [this](const char* id, std::string message, const char* hint) {
            build_.messages.push_back({Severity::Note, id, "", std::move(message), hint});
        };
        if (!asked && needed == Tested) {
            note("alpha-tested", "the scene has alpha masks, so rays test them (--alpha tested)",
                 "--alpha opaque ignores masks where rays hit, which is faster");
        }
        if (needed != Stochastic || blended.empty()) {
            return;
        }
        if (chosen != Stochastic) {
            note("alpha-blend", fmt::format("alphaMode BLEND is drawn opaque: {}", base::someOf(blended)),
                 "");
        } else if (!asked) {
            note("alpha-stochastic",
                 fmt::format("alphaMode BLEND is seen with the probability alpha, which is noise at few "
                             "samples (--alpha stochastic): {}",
                             base::someOf(blended)),
                 "--alpha tested draws BLEND opaque, which is faster and free of that noise");
        }
    }

    // Adds the lobes of packs that hits keep. Their bits are known only once the packs are read.
    Status keepPackLobes() {
        const materials::MaterialModel& model = scenes_.materials().empty()
                                                    ? materials::builtinMaterialModel()
                                                    : scenes_.materials().front().model();
        for (const std::string& name : settings_.packLobes) {
            const int feature = model.findFeature(name);
            if (feature < 0 || !model.features[static_cast<std::size_t>(feature)].isLobe) {
                const std::vector<std::string> names = model.names(model.lobes);
                return makeError("hit-lobe-unknown", "",
                                 fmt::format("neither Glint nor a pack has a lobe \"{}\"{}", name,
                                             base::suggestion(name, names)),
                                 "correct --hit-lobes, or add the pack by --materials");
            }
            compile_.plan.keys.keptLobes |= model.features[static_cast<std::size_t>(feature)].mask();
        }
        return okStatus();
    }

    // Decides which effects there are, and which lights.
    Status decideLight() {
        const DecidedPackage* const known = package();
        if (known != nullptr) {
            compile_.effects = {false, known->shape.effects.all, compile_.effects.maxReflectionRoughness};
            compile_.emissiveLights = EmissiveLights::Off;
            compile_.skyLight = SkyLight::Off;
            compile_.sizedLights = SizedLights::Off;
            compile_.lightSamples = 0;
        }
        GLINT_TRY(auto light, planLight(scenes_, compile_));
        if (known != nullptr) {
            light.effects.effects = known->shape.effects;
            light.emissive = known->emissiveLights ? EmissiveLights::On : EmissiveLights::Off;
            light.sky = known->skyLight ? SkyLight::On : SkyLight::Off;
            light.sized = known->sizedLights ? SizedLights::On : SizedLights::Off;
            light.disks = known->diskLights ? DiskLights::On : DiskLights::Off;
            light.samples = known->lightSamples;
            compile_.shadowThrough = known->shadowThrough;
        }
        build_.plan.effects = std::move(light.effects);
        compile_.emissiveLights = light.emissive;
        compile_.skyLight = light.sky;
        compile_.sizedLights = light.sized;
        compile_.diskLights = light.disks;
        compile_.lightSamples = light.samples;
        return okStatus();
    }

    Status decideFirstShadows() {
        GLINT_TRY(const FirstShadowPlan planned,
                  planFirstShadows(scenes_, build_.plan, compile_, settings_.choosesFirstShadows));
        compile_.firstShadows = planned.placement;
        compile_.firstShadowRays = planned.rays;
        settings_.choosesFirstShadows = false;
        return okStatus();
    }

    // Chooses the strategy that should be fastest, and from the strategies the tracers.
    Status decideStrategy() {
        if (choosesStrategy()) {
            build_.messages.insert(build_.messages.end(), target_.warnings.begin(), target_.warnings.end());
            GLINT_TRY(compile_.strategyChoice, advise());
            const package::Strategy chosen =
                *valueNamed<package::Strategy>(compile_.strategyChoice->choice.strategy);
            if (build_.draws) {
                settings_.strategy = chosen;
            } else {
                // Not every device runs a pipeline of its own.
                compile_.strategies |=
                    chosen | (package::infoOf(chosen).ownPipeline
                                  ? std::uint32_t{package::strategyTable().front().strategy}
                                  : 0U);
            }
        }
        if (target_.package) {
            compile_.strategies = target_.package->shape.strategies;
            compile_.tracers = target_.package->shape.tracers;
            return okStatus();
        }
        if (build_.draws) {
            const bool queries = (*target_.tracers & package::kTracerRayQuery) != 0;
            compile_.strategies = *settings_.strategy | settings_.furtherStrategies;
            compile_.tracers = settings_.renderer.tracer.value_or(queries ? package::kTracerRayQuery
                                                                          : package::kTracerRayPipeline);
        }
        // Some strategies have a tracer of their own. If nothing else traces, it is the only tracer.
        if ((compile_.strategies & ~package::pipelineStrategies()) == 0) {
            compile_.tracers = package::tracersOf(compile_.strategies, compile_.tracers);
        }
        return okStatus();
    }

    bool choosesStrategy() const {
        return build_.draws ? !settings_.strategy : settings_.advisesStrategy;
    }

    std::vector<std::string> availableStrategies() const {
        return runnableStrategies(
            target_, build_.draws ? settings_.renderer.tracer : std::optional<package::Tracer>());
    }

    // Expects a frame of the picture's size, or of the usual one.
    FrameShape frameShape() const {
        FrameShape shape{.effects = build_.plan.effects.effects.all,
                         .maxReflectionRoughness = settings_.frame.maxReflectionRoughness,
                         .batchEffects = settings_.renderer.batchEffects,
                         .bounces = compile_.maxBounces};
        if (build_.draws) {
            shape.pixels = static_cast<double>(settings_.renderer.width) * settings_.renderer.height;
        }
        return shape;
    }

    Result<StrategyAdvice> advise() const {
        const FrameShape shape = frameShape();
        const std::vector<std::string> available = availableStrategies();
        const DeviceCosts& device = target_.costs.device;
        std::optional<StrategyChoice> choice = chooseStrategy(roundsOf(shape), device, available);
        if (!choice) {
            return makeError(
                "calibration-strategies", device.device,
                fmt::format("was not measured with any strategy that can be used here: {}",
                            available.empty() ? "none" : fmt::format("{}", fmt::join(available, ", "))),
                "name a --strategy, or measure the device again with glint bench --calibrate");
        }
        return StrategyAdvice{std::move(*choice), device.device, target_.costs.builtIn, shape.pixels};
    }

    // Returns the rounds of a frame of each scene, for all scenes together.
    std::vector<Round> roundsOf(const FrameShape& shape) const {
        std::vector<Round> rounds;
        for (std::size_t i = 0; i < scenes_.scenes().size(); ++i) {
            const gltf::SceneList::Range range = scenes_.primitivesOf(i);
            const auto primitives = scenes_.primitives().subspan(range.first, range.count);
            const std::vector<KeySet> cases =
                target_.package
                    ? caseKeys(target_.package->cases, target_.package->hits, *build_.plan.model)
                    : caseKeys(build_.plan, keysOfScene(build_.plan, compile_.plan, primitives, range.first));
            std::vector<Round> ofScene = frameRounds(scenes_.materials(), primitives, shape);
            setCases(ofScene, roundCases(cases), shape);
            std::ranges::move(ofScene, std::back_inserter(rounds));
        }
        return rounds;
    }

    // Warns of each effect that is asked for although the scenes can't use it.
    void warnOfEffects() {
        for (const EffectDecision& decision : build_.plan.effects.decisions) {
            if (decision.isNamed && !decision.usable) {
                build_.messages.push_back(
                    makeWarning("effect-unused", scenes_.path(),
                                fmt::format("the effect {} is {}", decision.name, decision.reason),
                                "leave it out of --effects: its passes cost time and change nothing"));
            }
        }
    }

    const DecidedPackage* package() const {
        return target_.package ? &*target_.package : nullptr;
    }

    const Target& target_;
    const gltf::SceneList& scenes_;
    Build build_;
    Settings& settings_;
    CompileSettings& compile_;
};

}  // namespace

Result<gltf::ImportOptions> importOptions(const Settings& settings, base::Memo* texels) {
    GLINT_TRY(const auto model, materials::loadMaterialModel(settings.materials));
    for (const std::string& name : settings.compile.effects.ofPacks) {
        if (findEffect(model->effects, name) == 0) {
            std::vector<std::string> names;
            for (const materials::EffectDeclaration& effect : model->effects) {
                names.push_back(effect.name);
            }
            return makeError("effect-unknown", "",
                             fmt::format("neither Glint nor a pack has an effect \"{}\"{}", name,
                                         base::suggestion(name, names)),
                             "correct --effects, or add the pack by --materials");
        }
    }
    gltf::ImportOptions options;
    options.trustTextures = trustsTextures(settings);
    options.memo = texels;
    options.memoScope = texels != nullptr ? programIdentity() : "";
    options.scene = settings.sceneInFile;
    options.variant = settings.variant;
    options.strictPaths = settings.strictPaths;
    options.jobs = settings.compile.jobs;
    options.materialModel = model;
    return options;
}

Result<Build> resolve(std::shared_ptr<const gltf::SceneList> scenes, const Settings& settings,
                      const Target& target) {
    return Resolver(std::move(scenes), settings, target).resolve();
}

Result<Build> resolve(std::span<const gltf::Scene> scenes, const Settings& settings, const Target& target) {
    return resolve(std::make_shared<const gltf::SceneList>(scenes), settings, target);
}

Result<Build> resolve(std::span<const gltf::Scene> scenes, const CompileSettings& compile) {
    Settings settings;
    settings.compile = compile;
    settings.choosesFirstShadows = compile.firstShadows == package::ShadowPlacement::Deferred;
    settings.alpha = compile.plan.keys.alpha;
    settings.frame.maxReflectionRoughness = compile.effects.maxReflectionRoughness;
    return resolve(scenes, settings);
}

bool trustsTextures(const Settings& settings, const DecidedPackage* package) {
    return package != nullptr ? package->trustsTextures
                              : settings.compile.trustTextures && !settings.compile.plan.fallback &&
                                    settings.compile.host.empty();
}

std::vector<std::string> strategyNames(std::uint32_t strategies) {
    return namesIn(strategies, package::strategies());
}

std::vector<std::string> tracerNames(std::uint32_t tracers) {
    return namesIn(tracers, package::kTracers);
}

namespace {

Change changeOf(const Descriptor& row) {
    // Settings that `glint compile` also takes change the package.
    if (isCompiled(row) || (row.commands & kOfCompile) != 0) {
        return kChangesPackage;
    }
    return row.stage == SettingStage::Scene      ? kChangesUpload
           : row.stage == SettingStage::Renderer ? kChangesRenderer
                                                 : kChangesFrame;
}

bool isOfPictures(const Descriptor& row) {
    return (row.commands & kOfRender) != 0;
}

}  // namespace

std::uint32_t changeBetween(const Settings& before, const Settings& after) {
    const bool isSame = before.environment == after.environment && before.package == after.package;
    std::uint32_t changes = isSame ? 0U : std::uint32_t{kChangesPackage};
    for (const Descriptor& row : settingsTable()) {
        if (isOfPictures(row) && row.values.text(before) != row.values.text(after)) {
            changes |= changeOf(row);
        }
    }
    return changes;
}

Settings withoutRebuilding(Settings built, const Settings& wanted) {
    for (const Descriptor& row : settingsTable()) {
        if (isOfPictures(row) && changeOf(row) < kChangesUpload) {
            row.values.set(built, row.values.text(wanted));
        }
    }
    return built;
}

}  // namespace glint::compiler
