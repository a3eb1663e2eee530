#include "base/lists.h"
#include "settings/descriptor.h"
#include "settings/values.h"

namespace glint::compiler {

namespace {

using namespace values;

constexpr double kMaxMetres = 1e6;

constexpr SettingBench kNoPicture{.use = BenchUse::None};
using Against = decltype(SettingBench::against);

constexpr SettingBench approximates(std::string_view exact, std::string_view tried = {},
                                    std::string_view quick = {}, Against against = nullptr) {
    return {.use = BenchUse::Swept, .exact = exact, .tried = tried, .quick = quick, .against = against};
}

// An approximation of light transport. Only the full reference has the exact value.
constexpr SettingBench approximatesTransport(std::string_view exact, std::string_view tried = {},
                                             std::string_view quick = {}, Against against = nullptr,
                                             decltype(SettingBench::exactFor) exactFor = nullptr) {
    SettingBench bench = approximates(exact, tried, quick, against);
    bench.isTransport = true;
    bench.exactFor = exactFor;
    return bench;
}

constexpr SettingBench changesTime(Against against = nullptr, std::string_view tried = {},
                                   std::string_view quick = {}) {
    return {.use = BenchUse::Swept, .tried = tried, .quick = quick, .against = against};
}

constexpr std::string_view kPicture = "Picture";
constexpr std::string_view kEffectOptions = "Effects";
constexpr std::string_view kReflections = "Reflections";
constexpr std::string_view kShaders = "Shaders";

constexpr std::uint32_t kMakers = kOfCompile | kOfRender;
constexpr std::uint32_t kPlanners = kOfCompile | kOfExplain | kOfRender;

// The members of a row besides its place, its text and its values.
struct Further {
    SettingBench bench{};
    std::string_view document{};
    bool recorded = false;
    decltype(Descriptor::idle) idle = nullptr;
};

constexpr Descriptor row(std::string_view name, std::uint32_t commands, SettingStage stage,
                         std::string_view group, std::string_view what, const SettingValues& values,
                         const Further& further = {}) {
    Descriptor made{name, commands, stage, group, what, values, further.bench, further.document};
    made.recorded = further.recorded;
    made.idle = further.idle;
    return made;
}

// --- When a setting matters: the members `idle`, `against`, `triedFor` and `exactFor` of rows. Reasons
// against it are empty where it does ---

// A setting that is about something which a scene or a device may lack.
template <bool BenchFacts::*Fact, const auto& Reason>
std::string idleWithout(const BenchFacts& facts, const Configuration& /*base*/) {
    return facts.*Fact ? "" : Reason;
}

template <bool BenchFacts::*Fact, const auto& Reason>
std::string without(std::string_view value, const BenchFacts& facts, const Configuration& base) {
    return value.empty() ? idleWithout<Fact, Reason>(facts, base) : "";
}

constexpr char kNoTextures[] = "there are no textures";
constexpr char kNoAlpha[] = "no material has alpha";
constexpr char kNoPlacedLight[] = "the picture has no point or spot light";
constexpr char kNoDirectionalLight[] = "the picture has no directional light";
constexpr char kOneRayIsExact[] = "no light has a size (--light-radius, --sun-angle): one ray is exact";
constexpr char kNoFurtherLobe[] = "no material has a lobe that hits could lose";
constexpr char kNothingPassesLight[] = "no material lets light through";

template <bool BenchFacts::*Fact>
std::string onWith(const BenchFacts& facts) {
    return facts.*Fact ? "on" : "";
}

bool ordersHits(const Configuration& base) {
    const std::optional<package::Strategy> strategy =
        valueNamed<package::Strategy>(base.find("strategy")->second);
    return strategy && (*strategy & package::orderedStrategies()) != 0;
}

std::string withoutRays(std::string_view value, const BenchFacts& facts, const Configuration& /*base*/) {
    return value.empty() && !facts.sendsRays ? "no effect sends rays whose hits are shaded" : "";
}

// The effects of a full reference send rays, even if those of the default don't. Some lights are there in
// packages for several bounces alone.
std::string withoutPaths(std::string_view value, const BenchFacts& facts, const Configuration& base) {
    return facts.fullTransport || facts.bouncesLight ? std::string() : withoutRays(value, facts, base);
}

std::string withoutOrder(std::string_view value, const BenchFacts& facts, const Configuration& base) {
    const std::string reason = withoutRays(value, facts, base);
    return !reason.empty() || !value.empty() || ordersHits(base)
               ? reason
               : fmt::format("--strategy {} sorts no hits and keeps no records",
                             base.find("strategy")->second);
}

// A hierarchy that may choose every light has nothing to choose.
std::string withoutChoice(std::string_view value, const BenchFacts& facts, const Configuration& base) {
    const std::string& own = base.find("lights")->second;
    if (value == kAll) {
        return own == kAuto && !facts.manyLights ? "auto takes all of so few lights" : "";
    }
    std::int64_t chosen = 1;
    if (!value.empty() && !parseWhole(value, 1, package::kMaxLightSamples, chosen)) {
        return "";
    }
    return static_cast<std::size_t>(chosen) < facts.lights
               ? ""
               : fmt::format("there are no more lights with a position: {}", facts.lights);
}

std::string neverIdle(const BenchFacts& /*facts*/, const Configuration& /*base*/) {
    return "";
}

// A higher limit of roughness may call for reflections itself, and a lower one may have removed them.
std::string idleReflections(const BenchFacts& facts, const Configuration& /*base*/) {
    BenchFacts any = facts;
    any.effects = facts.effectsOfAnyRoughness;
    return withoutEffect("max-roughness", any);
}

std::string idleMarch(const BenchFacts& facts, const Configuration& base) {
    const std::string reason = withoutEffect("ssr", facts);
    return reason.empty() && base.find("ssr")->second == "off" ? "--ssr is off" : reason;
}

// A number of samples above the number of lights takes every light, and so does any number if there is one
// light.
std::string idleChoice(const BenchFacts& facts, const Configuration& base) {
    const std::string& own = base.find("lights")->second;
    return own == kAll ? "" : withoutChoice(own, facts, base);
}

std::string idleTracer(const BenchFacts& facts, const Configuration& /*base*/) {
    return facts.effects.empty() ? "no effect traces rays" : "";
}

std::string withoutEmission(std::string_view value, const BenchFacts& facts, const Configuration& /*base*/) {
    if (!facts.emits) {
        return "no material emits light";
    }
    return value == "on" && !facts.lightsMayEmit ? "the default has no shadow rays" : "";
}

std::string withoutSkyLight(std::string_view value, const BenchFacts& facts, const Configuration& /*base*/) {
    return value == "on" && !facts.skyMayLight ? "the default has no shadow rays" : "";
}

std::string withoutSizedLights(std::string_view value, const BenchFacts& facts,
                               const Configuration& /*base*/) {
    if (!facts.sizedLights) {
        return "no light has a size (--light-radius, --sun-angle)";
    }
    return value == "on" && !facts.sizedMayShow ? "the default has no shadow rays" : "";
}

std::string withoutEffects(std::string_view value, const BenchFacts& facts, const Configuration& /*base*/) {
    return value.empty() && facts.effects.empty() && !facts.fullTransport ? "there are no effects" : "";
}

std::string withoutFloat16(std::string_view value, const BenchFacts& facts, const Configuration& /*base*/) {
    return value == "16" && !facts.float16 ? "the device has no 16-bit floating point (shaderFloat16)" : "";
}

std::string withoutPositionFetch(std::string_view value, const BenchFacts& facts, const Configuration& base) {
    return value == "on" && !facts.positionFetch
               ? "the device lacks VK_KHR_ray_tracing_position_fetch, or this glint's glslang GLSL for it"
               : withoutRays(value, facts, base);
}

std::string withoutRayPipeline(std::string_view value, const BenchFacts& facts, const Configuration& base) {
    const package::StrategyInfo* const info = package::findStrategy(value);
    return info != nullptr && info->ownPipeline && !facts.rayPipeline
               ? "the device has no ray tracing pipelines"
               : withoutRays(value, facts, base);
}

std::string withoutPacking(std::string_view value, const BenchFacts& facts, const Configuration& base) {
    return value == "on" && !facts.packsTextures
               ? "the device reads no BC formats, or this glint can't pack them"
               : without<&BenchFacts::textures, kNoTextures>(value, facts, base);
}

std::string exactEffects(const BenchFacts& facts) {
    return facts.rayEffects;
}

std::string exactSizedLights(const BenchFacts& facts) {
    return facts.sizedLights && facts.sizedMayShow ? "on" : "";
}

// Paths find all light of the sky and of emissive triangles, in glass that bends and spreads it.
std::string exactShadowThrough(const BenchFacts& facts) {
    return facts.fullTransport && !facts.punctualLights ? "alpha" : "glass";
}

std::vector<std::string> strategiesToTry(const BenchFacts& /*facts*/, const std::string& /*base*/,
                                         bool /*quick*/) {
    return base::mapped<std::string>(package::strategyTable(), &package::StrategyInfo::name);
}

// Returns the default's effects, those of a reference of all transport, and values that leave out one effect
// each.
std::vector<std::string> effectsToTry(const BenchFacts& facts, const std::string& base, bool /*quick*/) {
    std::vector<std::string> values{base};
    if (facts.fullTransport && facts.rayEffects != base) {
        values.push_back(facts.rayEffects);
    }
    for (const std::string& effect : facts.effects) {
        std::vector<std::string> rest(facts.effects.begin(), facts.effects.end());
        std::erase(rest, effect);
        values.push_back(rest.empty() ? std::string(kNone) : fmt::format("{}", fmt::join(rest, ",")));
    }
    return values;
}

// Returns multiples of white, rounded to three digits.
std::vector<std::string> clampsToTry(const BenchFacts& facts, const std::string& /*base*/, bool quick) {
    std::vector<std::string> values{"0"};
    for (const double times : {16.0, 4.0, 1.0}) {
        if (facts.white > 0.0 && (!quick || times == 1.0)) {
            values.push_back(fmt::format("{:.3g}", times * facts.white));
        }
    }
    return values;
}

}  // namespace

// To add a setting, add its row here, and use its member where it acts.
std::span<const Descriptor> settingsTable() {
    using enum SettingStage;
    static constexpr Descriptor kRows[] = {
        row("size", kOfRender, Renderer, kPicture, "pixels, 1 to 16384 each way, 67108864 in all", kSize),
        row("spp", kOfRender, Frame, kPicture, "samples per pixel", number<&Settings::samples>(1, 65536),
            {.bench = approximates("", "1 2 4 8 16 32 64", "1 2 4 8")}),
        row("seed", kOfRender, Frame, kPicture, "seed of the random numbers",
            number<&Settings::frame, &FrameOptions::seed>(0, 4294967295.0), {.bench = kNoPicture}),
        row("sky", kOfRender, Frame, kPicture, "factor of the default sky's radiance; excludes --environment",
            kSky, {.document = "cli.md#sky-and-exposure"}),
        row("sun", kOfRender, Scene, kPicture, "add a directional light of 3 lux",
            enumerator<&Settings::sun>()),
        row("environment-rotation", kOfRender, Frame, "Environment",
            "degrees about +Y, counter-clockwise as seen from above; needs --environment",
            number<&Settings::environmentRotation>(-360.0, 360.0)),
        row("environment-intensity", kOfRender, Frame, "Environment",
            "factor of the map's radiance; needs --environment",
            number<&Settings::frame, &FrameOptions::environmentIntensity>(0.0, 1e9)),
        row("shadow-spp", kOfRender, Frame, kEffectOptions,
            "shadow rays per sample to each light that has a size",
            number<&Settings::frame, &FrameOptions::shadowSamples>(1, 4096),
            {.bench =
                 approximates("", "1 2 4 8 16", "1 4", without<&BenchFacts::sizedLights, kOneRayIsExact>)}),
        row("light-radius", kOfRender, Scene, kEffectOptions,
            "radius of point and spot lights in metres, for soft shadows; 0: hard shadows",
            number<&Settings::lightRadius>(0.0, kMaxMetres),
            {.idle = idleWithout<&BenchFacts::placedLights, kNoPlacedLight>}),
        row("sun-angle", kOfRender, Scene, kEffectOptions,
            "angular diameter of directional lights in degrees; the sun has 0.53; 0: hard shadows",
            number<&Settings::sunAngle>(0.0, 90.0),
            {.idle = idleWithout<&BenchFacts::directionalLights, kNoDirectionalLight>}),
        row("ao-spp", kOfRender, Frame, kEffectOptions, "rays per sample of ambient-occlusion",
            number<&Settings::frame, &FrameOptions::occlusionSamples>(1, 4096),
            {.bench = approximates("", "1 2 4 8 16", "1 4")}),
        row("ao-radius", kOfRender, Frame, kEffectOptions,
            "how far ambient-occlusion looks, in metres; 0: without a limit",
            limit<&Settings::frame, &FrameOptions::occlusionRadius>(kMaxMetres)),
        row("ao-falloff", kOfRender, Frame, kEffectOptions,
            "how much the occluders of ambient-occlusion count",
            named<kFalloffNames, &Settings::frame, &FrameOptions::occlusionFalloff>()),
        row("effects", kMakers, Package, kEffectOptions, "which effects the package has, separated by commas",
            kEffects,
            {.bench = {.use = BenchUse::Swept,
                       .exact = "auto,indirect-diffuse",
                       .isTransport = true,
                       .against = withoutEffects,
                       .triedFor = effectsToTry,
                       .exactFor = exactEffects},
             .document = "effects.md",
             .idle = neverIdle}),
        row("max-roughness", kMakers, Frame, kEffectOptions,
            "rougher surfaces send no reflection ray; compile uses it only for --effects auto",
            number<&Settings::frame, &FrameOptions::maxReflectionRoughness>(0.0, 1.0),
            {.bench = approximates("1", "0.1 0.2 0.3 0.6 1", "0.1 0.3 1"), .idle = idleReflections}),
        row("mirror-roughness", kOfRender, Frame, kReflections, "smoother surfaces reflect as mirrors",
            number<&Settings::frame, &FrameOptions::mirrorRoughness>(0.0, 1.0),
            {.bench = approximates("0", "0 0.05 0.1 0.2", "0.05 0.2")}),
        row("skip-below", kOfRender, Frame, kEffectOptions,
            "do not send rays whose weight is below X; their light is lost; 0: every ray is sent",
            number<&Settings::frame, &FrameOptions::faintWeight>(0.0, 1.0),
            {.bench = approximates("0", "0 0.01 0.05 0.2", "0 0.05", withoutRays),
             .document = "effects.md#skipping-what-hardly-counts"}),
        row("clamp", kOfRender, Frame, kReflections,
            "the maximum luminance that a ray adds to a sample: less noise, but some light is lost; 0: no "
            "limit",
            limit<&Settings::frame, &FrameOptions::maxSampleRadiance>(1e9),
            {.bench =
                 {.use = BenchUse::Swept, .exact = "0", .against = withoutRays, .triedFor = clampsToTry}}),
        row("ssr", kOfRender, Renderer, kReflections, "march N steps in screen space before a ray is sent",
            kScreenSteps,
            {.bench = approximates("off", "off 8 16 32 64", "off 16"),
             .document = "reflections.md#screen-space-before-rays"}),
        row("ssr-thickness", kOfRender, Frame, kReflections,
            "thickness of a surface in the march of --ssr, as a share of its distance",
            number<&Settings::frame, &FrameOptions::screenThickness>(0.0, 1.0), {.idle = idleMarch}),
        row("max-interfaces", kOfRender, Frame, kEffectOptions,
            "the maximum number of surfaces that a refraction ray meets; after that it takes the sky's light",
            number<&Settings::frame, &FrameOptions::maxInterfaces>(1, 64),
            {.bench = approximates("64", "2 4 8 16 32", "2 8")}),
        row("bounces", kPlanners, Choice, kEffectOptions, "the maximum number of bounces of a path", kBounces,
            {.bench =
                 approximatesTransport("unlimited", "1 2 4 8 unlimited", "1 2 4 unlimited", withoutPaths),
             .document = "paths.md",
             .recorded = true}),
        row("hit-lobes", kPlanners, Package, kShaders,
            "which lobes of materials hits keep, separated by commas; primary surfaces keep all", kHitLobes,
            {.bench =
                 approximates("all", "all base", {}, without<&BenchFacts::furtherLobes, kNoFurtherLobe>)}),
        // All values have the same mean. The reference uses the one that converges soonest.
        row("lights", kMakers, Package, kShaders,
            "how many lights a surface chooses by a hierarchy, besides directional ones", kLights,
            {.bench = approximates("auto", "all 1 2 4 8 16 32 64", "all 1 8", withoutChoice),
             .document = "lights.md",
             .recorded = true,
             .idle = idleChoice}),
        row("emissive-lights", kMakers, Package, kShaders,
            "whether triangles that emit light are lights, with multiple importance sampling",
            enumerator<&Settings::compile, &CompileSettings::emissiveLights>(),
            {.bench = approximatesTransport("on", "off on", {}, withoutEmission, onWith<&BenchFacts::emits>),
             .document = "lights.md#emissive-triangles",
             .recorded = true}),
        row("sky-light", kMakers, Package, kShaders,
            "whether sky and environment map are a light, with multiple importance sampling",
            enumerator<&Settings::compile, &CompileSettings::skyLight>(),
            {.bench =
                 approximatesTransport("on", "off on", {}, withoutSkyLight, onWith<&BenchFacts::skyMayLight>),
             .document = "lights.md#the-sky",
             .recorded = true}),
        row("sized-lights", kMakers, Package, kShaders,
            "whether rays of lobes find punctual lights with a size, with multiple importance sampling",
            enumerator<&Settings::compile, &CompileSettings::sizedLights>(),
            {.bench = approximatesTransport("on", "off on", {}, withoutSizedLights, exactSizedLights),
             .document = "lights.md#lights-with-a-size",
             .recorded = true}),
        row("disk-lights", kOfCompile, Package, kShaders,
            "whether a program's lights may be disks (LightView::Type::Disk)",
            enumerator<&Settings::compile, &CompileSettings::diskLights>(),
            {.bench = kNoPicture, .document = "lights.md#lights-with-a-size", .recorded = true}),
        row("energy-compensation", kMakers, Package, kShaders,
            "add the light that bounces between microfacets more than once, which rough surfaces otherwise "
            "lose",
            named<kEnergyNames, &Settings::compile, &CompileSettings::energyCompensation>(),
            {.bench = approximates("on"), .document = "numerics.md", .recorded = true}),
        row("texture-lod", kMakers, Package, kShaders, "which level of a texture is read",
            enumerator<&Settings::compile, &CompileSettings::textureLod>(),
            {.bench = approximates("mip0", {}, {}, without<&BenchFacts::textures, kNoTextures>),
             .recorded = true}),
        row("trust-textures", kPlanners, Package, kShaders,
            "leave out features that the values of textures make unnecessary",
            named<kTrustNames, &Settings::compile, &CompileSettings::trustTextures>(),
            {.bench = kNoPicture,
             .document = "materials.md#what-textures-hold",
             .recorded = true,
             .idle = idleWithout<&BenchFacts::textures, kNoTextures>}),
        row("texture-levels", kMakers, Package, kShaders,
            "record the finest level of each texture that a frame reads, for streaming and --stats",
            flag<&Settings::compile, &CompileSettings::textureLevels>(),
            {.bench = kNoPicture,
             .document = "textures.md#which-levels-a-frame-reads",
             .recorded = true,
             .idle = idleWithout<&BenchFacts::textures, kNoTextures>}),
        row("layers", kMakers, Package, kShaders,
            "images beside the picture, separated by commas: of render -o FILE.exr, for denoisers and views",
            kLayers, {.bench = kNoPicture, .document = "layers.md", .recorded = true}),
        row("alpha", kPlanners, Package, kShaders, "alpha of hits",
            optional<&Settings::alpha>("stochastic if the scene has BLEND, tested if it has masks"),
            {.bench = approximates("stochastic", "stochastic tested opaque", {},
                                   without<&BenchFacts::masks, kNoAlpha>)}),
        row("shadow-through", kMakers, Package, kShaders,
            "how the light of lights passes through alpha and glass on shadow rays",
            enumerator<&Settings::compile, &CompileSettings::shadowThrough>(),
            {.bench = {.use = BenchUse::Swept,
                       .exact = "glass",
                       .against = without<&BenchFacts::passesLight, kNothingPassesLight>,
                       .exactFor = exactShadowThrough},
             .document = "shadows.md",
             .recorded = true}),
        row("precision", kMakers, Package, kShaders, "bits of float in shading",
            decided<&Settings::choosesPrecision, &Settings::compile, &CompileSettings::precision>(
                "16 if the table of --gpu says that it is worth it and --precision-error accepts it, else "
                "32"),
            {.bench = approximates("32", "32 16", {}, withoutFloat16),
             .document = "numerics.md#shading-in-16-bits",
             .recorded = true}),
        row("precision-error", kPlanners, Package, kShaders,
            "the relMSE that --precision auto may cost; 16 bits need 4e-6; 0: none",
            number<&Settings::precisionError>(0.0, 1.0),
            {.bench = kNoPicture, .document = "numerics.md#shading-in-16-bits", .idle = neverIdle}),
        row("shadows", kMakers, Package, kShaders, "where shadow rays of hits are traced",
            decided<&Settings::choosesShadows, &Settings::compile, &CompileSettings::shadows>(
                "deferred if the table of --gpu says that it is worth it, else inline"),
            {.bench = changesTime(withoutRays, "inline deferred"),
             .document = "performance.md#the-code-of-a-gpu",
             .recorded = true}),
        row("first-shadows", kMakers, Package, kShaders,
            "where shadow rays of what the camera sees are traced",
            decided<&Settings::choosesFirstShadows, &Settings::compile, &CompileSettings::firstShadows>(
                "deferred, unless surfaces send many or layers show the light of lights"),
            {.bench = kNoPicture,
             .document = "shadows.md#where-shadow-rays-are-traced",
             .recorded = true,
             .idle = neverIdle}),
        row("hit-record", kMakers, Package, kShaders,
            "data of a hit that strategies which sort hits keep between passes",
            enumerator<&Settings::compile, &CompileSettings::hitRecord>(),
            {.bench = approximates("full", {}, {}, withoutOrder),
             .document = "reflections.md",
             .recorded = true}),
        row("sample-record", kMakers, Package, kShaders,
            "data of an effect's ray and of its light between passes",
            enumerator<&Settings::compile, &CompileSettings::sampleRecord>(),
            {.bench = approximates("full", {}, {}, withoutRays),
             .document = "memory.md#samples",
             .recorded = true}),
        row("passes", kOfCompile, Package, kShaders, "which passes the package has",
            enumerator<&Settings::compile, &CompileSettings::passes>(),
            {.bench = kNoPicture, .document = "engine.md", .recorded = true}),
        row("answer", kOfCompile, Package, kShaders,
            "what RaySteps returns for each ray; surface needs --passes steps",
            enumerator<&Settings::compile, &CompileSettings::answer>(),
            {.bench = kNoPicture, .document = "engine.md#surfaces-instead-of-light", .recorded = true}),
        row("bindings", kOfCompile, Package, kShaders,
            "where shaders find the engine's bindings; needs --passes steps", kBindings,
            {.bench = kNoPicture, .document = "engine.md#bindings", .recorded = true}),
        row("position-fetch", kMakers, Package, kShaders,
            "read positions from the acceleration structure instead of from vertices, in strategies that "
            "shade "
            "hits where they find them (with ray queries, or in hit shaders)",
            flag<&Settings::compile, &CompileSettings::positionFetch>(),
            {.bench = changesTime(withoutPositionFetch, "off on"), .recorded = true}),
        row("optimize", kMakers, Package, kShaders,
            "inline and simplify shaders; otherwise compiling takes a third of the time, and that is left to "
            "drivers",
            flag<&Settings::compile, &CompileSettings::optimize>(),
            {.bench = changesTime(nullptr, "on off"), .document = "compile_times.md#without-the-optimiser"}),
        row("strategy", kOfCompile, Choice, kShaders, "how hits can be shaded, separated by commas",
            bits<package::Strategy, &Settings::advisesStrategy, &Settings::compile,
                 &CompileSettings::strategies>(
                "the one that should be fastest at 1920x1080, by --calibration"),
            {.document = "cli.md#which-strategy"}),
        row("strategy", kOfRender, Choice, kShaders, "how hits are shaded",
            optional<&Settings::strategy>("the one that should be fastest, by --calibration"),
            {.bench = {.use = BenchUse::Swept, .against = withoutRayPipeline, .triedFor = strategiesToTry},
             .document = "cli.md#which-strategy"}),
        row("tracer", kOfCompile, Choice, kShaders,
            "what traces rays, separated by commas; strategies of hit shaders always have their own",
            bits<package::Tracer, nullptr, &Settings::compile, &CompileSettings::tracers>()),
        row("tracer", kOfRender, Choice, kShaders,
            "what traces rays; strategies of hit shaders always use ray-pipeline",
            optional<&Settings::renderer, &RendererOptions::tracer>(
                "ray-query where package and device have it, else ray-pipeline"),
            {.idle = idleTracer}),
        row("merge", kPlanners, Package, kShaders,
            "which permutations share a shader; FILE: hits that --profile counted", kMerge,
            {.bench = changesTime(nullptr, "none family all auto"), .document = "merging.md"}),
        row("max-shaders", kPlanners, Package, kShaders,
            "limit of shaders: --merge auto and profile stay within it, the others fail above it; 0: no "
            "limit, or 32 for auto and profile",
            number<&Settings::compile, &CompileSettings::plan, &PlanOptions::maxShaders>(0, 1000000)),
        row("fallback", kMakers, Package, kShaders,
            "add a shader that can shade every material, in place of shaders that are not compiled yet and "
            "for "
            "materials that the package does not know",
            flag<&Settings::compile, &CompileSettings::plan, &PlanOptions::fallback>(),
            {.bench = kNoPicture, .document = "live.md", .recorded = true}),
        row("ordering", kOfRender, Renderer, kReflections, "how strategies that sort hits by shader do so",
            optional<&Settings::renderer, &RendererOptions::ordering>(
                "by the device and the number of shaders", "auto|NAME"),
            {.bench = changesTime(withoutOrder, {}, "auto local-histogram"),
             .document = "reflections.md#orderings"}),
        row("binning", kOfRender, Frame, kReflections, "sort the rays of a workgroup by direction",
            enumerator<&Settings::frame, &FrameOptions::binning>(),
            {.bench = changesTime(withoutRays), .document = "reflections.md#ray-binning"}),
        row("batch-effects", kOfRender, Renderer, kEffectOptions,
            "shade the hits of all effects together: fewer and larger dispatches, more memory",
            flag<&Settings::renderer, &RendererOptions::batchEffects>(),
            {.bench = changesTime(withoutRays, "off on"), .document = "effects.md#one-list-for-all"}),
        row("picture", kOfRender, Renderer, kEffectOptions,
            "floats of the picture's channels; pictures of several samples have 32 bits",
            enumerator<&Settings::renderer, &RendererOptions::picture>(),
            {.bench = kNoPicture, .document = "memory.md#the-picture"}),
        row("bands", kOfRender, Renderer, kEffectOptions,
            "light the picture in N bands of rows, one after the other: less memory, more dispatches; 0: "
            "one on a discrete GPU, elsewhere bands of at most 2^19 pixels, and as many as keep a frame of "
            "1920 x 1080 within 64 bytes a pixel, and 16 more for each effect with rays beyond the first",
            number<&Settings::renderer, &RendererOptions::bands>(0, 1024),
            {.bench = changesTime(withoutRays, "1 4"), .document = "memory.md#bands"}),
        row("compress-textures", kOfRender, Scene, kPicture,
            "compress PNG, JPEG and WebP textures to BC7, BC5 and BC4; the result is kept in the cache",
            flag<&Settings::compressTextures>(),
            {.bench = approximates("off", "off on", {}, withoutPacking),
             .document = "textures.md#compressing-textures"}),
        row("traversal-order", kOfRender, Scene, "Device",
            "order of triangles and instances in acceleration structures",
            enumerator<&Settings::traversalOrder>(),
            {.document = "performance.md#traversal-on-a-cpu-driver"}),
        row("opacity", kOfRender, Scene, "Device", "when alpha tests of alphaMode MASK are decided",
            enumerator<&Settings::opacity>(),
            {.document = "alpha.md", .idle = idleWithout<&BenchFacts::masks, kNoAlpha>}),
        row("vertices", kOfRender, Scene, "Device", "how vertices are stored",
            enumerator<&Settings::vertices>(),
            {.bench = approximates("full"), .document = "memory.md#vertices"}),
        row("pipeline-threads", kOfRender, Renderer, "Device",
            "threads that create pipelines; 0: as many as --jobs",
            number<&Settings::renderer, &RendererOptions::pipelineThreads>(0, 1024), {.bench = kNoPicture}),
    };
    return kRows;
}

const Descriptor* sweptSetting(std::string_view name) {
    const std::span<const Descriptor> table = settingsTable();
    const auto row = std::ranges::find_if(table, [name](const Descriptor& one) {
        return one.name == name && one.bench.use == BenchUse::Swept;
    });
    return row == table.end() ? nullptr : &*row;
}

}  // namespace glint::compiler
