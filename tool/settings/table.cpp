#include "settings/bench_rules.h"
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
                                             std::string_view quick = {}, Against against = nullptr) {
    SettingBench bench = approximates(exact, tried, quick, against);
    bench.isTransport = true;
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

// To add a setting, add its row here, and use its member where it acts.
constexpr Descriptor kRows[] = {
    {.name = "size",
     .commands = kOfRender,
     .stage = SettingStage::Renderer,
     .group = kPicture,
     .what = "pixels, 1 to 16384 each way, 67108864 in all",
     .values = kSize},
    {.name = "spp",
     .commands = kOfRender,
     .group = kPicture,
     .what = "samples per pixel",
     .values = number<&Settings::samples>(1, 65536),
     .bench = approximates("", "1 2 4 8 16 32 64", "1 2 4 8")},
    {.name = "seed",
     .commands = kOfRender,
     .group = kPicture,
     .what = "seed of the random numbers",
     .values = number<&Settings::frame, &FrameOptions::seed>(0, 4294967295.0),
     .bench = kNoPicture},
    {.name = "sky",
     .commands = kOfRender,
     .group = kPicture,
     .what = "factor of the default sky's radiance; excludes --environment",
     .values = kSky,
     .document = "cli.md#sky-and-exposure"},
    {.name = "sun",
     .commands = kOfRender,
     .stage = SettingStage::Scene,
     .group = kPicture,
     .what = "add a directional light of 3 lux",
     .values = enumerator<&Settings::sun>()},
    {.name = "environment-rotation",
     .commands = kOfRender,
     .group = "Environment",
     .what = "degrees about +Y, counter-clockwise as seen from above; needs --environment",
     .values = number<&Settings::environmentRotation>(-360.0, 360.0)},
    {.name = "environment-intensity",
     .commands = kOfRender,
     .group = "Environment",
     .what = "factor of the map's radiance; needs --environment",
     .values = number<&Settings::frame, &FrameOptions::environmentIntensity>(0.0, 1e9)},
    {.name = "shadow-spp",
     .commands = kOfRender,
     .group = kEffectOptions,
     .what = "shadow rays per sample to each light that has a size",
     .values = number<&Settings::frame, &FrameOptions::shadowSamples>(1, 4096),
     .bench = approximates(
         "", "1 2 4 8 16", "1 4",
         [](std::string_view value, const BenchFacts& facts, const Configuration&) {
             return std::string(!value.empty() || facts.sizedLights
                                    ? ""
                                    : "no light has a size (--light-radius, --sun-angle): one ray is exact");
         })},
    {.name = "light-radius",
     .commands = kOfRender,
     .stage = SettingStage::Scene,
     .group = kEffectOptions,
     .what = "radius of point and spot lights in metres, for soft shadows; 0: hard shadows",
     .values = number<&Settings::lightRadius>(0.0, kMaxMetres),
     .idle = idleLightRadius},
    {.name = "sun-angle",
     .commands = kOfRender,
     .stage = SettingStage::Scene,
     .group = kEffectOptions,
     .what = "angular diameter of directional lights in degrees; the sun has 0.53; 0: hard shadows",
     .values = number<&Settings::sunAngle>(0.0, 90.0),
     .idle = idleSunAngle},
    {.name = "ao-spp",
     .commands = kOfRender,
     .group = kEffectOptions,
     .what = "rays per sample of ambient-occlusion",
     .values = number<&Settings::frame, &FrameOptions::occlusionSamples>(1, 4096),
     .bench = approximates("", "1 2 4 8 16", "1 4")},
    {.name = "ao-radius",
     .commands = kOfRender,
     .group = kEffectOptions,
     .what = "how far ambient-occlusion looks, in metres; 0: without a limit",
     .values = limit<&Settings::frame, &FrameOptions::occlusionRadius>(kMaxMetres)},
    {.name = "ao-falloff",
     .commands = kOfRender,
     .group = kEffectOptions,
     .what = "how much the occluders of ambient-occlusion count",
     .values = named<kFalloffNames, &Settings::frame, &FrameOptions::occlusionFalloff>()},
    {.name = "effects",
     .commands = kMakers,
     .stage = SettingStage::Package,
     .group = kEffectOptions,
     .what = "which effects the package has, separated by commas",
     .values = kEffects,
     .bench = {.use = BenchUse::Swept,
               .exact = "auto,indirect-diffuse",
               .isTransport = true,
               .against =
                   [](std::string_view value, const BenchFacts& facts, const Configuration&) {
                       const bool isIdle = facts.effects.empty() && !facts.fullTransport;
                       return std::string(value.empty() && isIdle ? "there are no effects" : "");
                   },
               .triedFor = effectsToTry,
               .exactFor = [](const BenchFacts& facts) { return facts.rayEffects; }},
     .document = "effects.md",
     .idle = neverIdle},
    {.name = "max-roughness",
     .commands = kMakers,
     .group = kEffectOptions,
     .what = "rougher surfaces send no reflection ray; compile uses it only for --effects auto",
     .values = number<&Settings::frame, &FrameOptions::maxReflectionRoughness>(0.0, 1.0),
     .bench = approximates("1", "0.1 0.2 0.3 0.6 1", "0.1 0.3 1"),
     .idle = idleReflections},
    {.name = "mirror-roughness",
     .commands = kOfRender,
     .group = kReflections,
     .what = "smoother surfaces reflect as mirrors",
     .values = number<&Settings::frame, &FrameOptions::mirrorRoughness>(0.0, 1.0),
     .bench = approximates("0", "0 0.05 0.1 0.2", "0.05 0.2")},
    {.name = "skip-below",
     .commands = kOfRender,
     .group = kEffectOptions,
     .what = "do not send rays whose weight is below X; their light is lost; 0: every ray is sent",
     .values = number<&Settings::frame, &FrameOptions::faintWeight>(0.0, 1.0),
     .bench = approximates("0", "0 0.01 0.05 0.2", "0 0.05", withoutRays),
     .document = "effects.md#skipping-what-hardly-counts"},
    {.name = "clamp",
     .commands = kOfRender,
     .group = kReflections,
     .what =
         "the maximum luminance that a ray adds to a sample: less noise, but some light is lost; 0: no limit",
     .values = limit<&Settings::frame, &FrameOptions::maxSampleRadiance>(1e9),
     .bench = {.use = BenchUse::Swept, .exact = "0", .against = withoutRays, .triedFor = clampsToTry}},
    {.name = "ssr",
     .commands = kOfRender,
     .stage = SettingStage::Renderer,
     .group = kReflections,
     .what = "march N steps in screen space before a ray is sent",
     .values = kScreenSteps,
     .bench = approximates("off", "off 8 16 32 64", "off 16"),
     .document = "reflections.md#screen-space-before-rays"},
    {.name = "ssr-thickness",
     .commands = kOfRender,
     .group = kReflections,
     .what = "thickness of a surface in the march of --ssr, as a share of its distance",
     .values = number<&Settings::frame, &FrameOptions::screenThickness>(0.0, 1.0),
     .idle = idleMarch},
    {.name = "max-interfaces",
     .commands = kOfRender,
     .group = kEffectOptions,
     .what =
         "the maximum number of surfaces that a refraction ray meets; after that it takes the sky's light",
     .values = number<&Settings::frame, &FrameOptions::maxInterfaces>(1, 64),
     .bench = approximates("64", "2 4 8 16 32", "2 8")},
    {.name = "bounces",
     .commands = kPlanners,
     .stage = SettingStage::Choice,
     .group = kEffectOptions,
     .what = "the maximum number of bounces of a path",
     .values = kBounces,
     .bench = approximatesTransport("unlimited", "1 2 4 8 unlimited", "1 2 4 unlimited", withoutPaths),
     .document = "paths.md",
     .recorded = true},
    {.name = "hit-lobes",
     .commands = kPlanners,
     .stage = SettingStage::Package,
     .group = kShaders,
     .what = "which lobes of materials hits keep, separated by commas; primary surfaces keep all",
     .values = kHitLobes,
     .bench = approximates("all", "all base", {},
                           [](std::string_view value, const BenchFacts& facts, const Configuration&) {
                               return std::string(value.empty() && !facts.furtherLobes
                                                      ? "no material has a lobe that hits could lose"
                                                      : "");
                           })},
    {.name = "lights",
     .commands = kMakers,
     .stage = SettingStage::Package,
     .group = kShaders,
     .what = "how many lights a surface chooses by a hierarchy, besides directional ones",
     .values = kLights,
     // All values have the same mean. The reference uses the one that converges soonest.
     .bench = approximates("auto", "all 1 2 4 8 16 32 64", "all 1 8", withoutChoice),
     .document = "lights.md",
     .recorded = true,
     .idle = idleChoice},
    {.name = "emissive-lights",
     .commands = kMakers,
     .stage = SettingStage::Package,
     .group = kShaders,
     .what = "whether triangles that emit light are lights, with multiple importance sampling",
     .values = enumerator<&Settings::compile, &CompileSettings::emissiveLights>(),
     .bench = {.use = BenchUse::Swept,
               .exact = "on",
               .isTransport = true,
               .tried = "off on",
               .against = withoutEmission,
               .exactFor = [](const BenchFacts& facts) { return std::string(facts.emits ? "on" : ""); }},
     .document = "lights.md#emissive-triangles",
     .recorded = true},
    {.name = "sky-light",
     .commands = kMakers,
     .stage = SettingStage::Package,
     .group = kShaders,
     .what = "whether sky and environment map are a light, with multiple importance sampling",
     .values = enumerator<&Settings::compile, &CompileSettings::skyLight>(),
     .bench = {.use = BenchUse::Swept,
               .exact = "on",
               .isTransport = true,
               .tried = "off on",
               .against = withoutSkyLight,
               .exactFor =
                   [](const BenchFacts& facts) { return std::string(facts.skyMayLight ? "on" : ""); }},
     .document = "lights.md#the-sky",
     .recorded = true},
    {.name = "sized-lights",
     .commands = kMakers,
     .stage = SettingStage::Package,
     .group = kShaders,
     .what = "whether rays of lobes find punctual lights with a size, with multiple importance sampling",
     .values = enumerator<&Settings::compile, &CompileSettings::sizedLights>(),
     .bench = {.use = BenchUse::Swept,
               .exact = "on",
               .isTransport = true,
               .tried = "off on",
               .against = withoutSizedLights,
               .exactFor =
                   [](const BenchFacts& facts) {
                       return std::string(facts.sizedLights && facts.sizedMayShow ? "on" : "");
                   }},
     .document = "lights.md#lights-with-a-size",
     .recorded = true},
    {.name = "energy-compensation",
     .commands = kMakers,
     .stage = SettingStage::Package,
     .group = kShaders,
     .what = "add the light that bounces between microfacets more than once, which rough surfaces otherwise "
             "lose",
     .values = named<kEnergyNames, &Settings::compile, &CompileSettings::energyCompensation>(),
     .bench = approximates("on"),
     .document = "numerics.md",
     .recorded = true},
    {.name = "texture-lod",
     .commands = kMakers,
     .stage = SettingStage::Package,
     .group = kShaders,
     .what = "which level of a texture is read",
     .values = enumerator<&Settings::compile, &CompileSettings::textureLod>(),
     .bench = approximates("mip0", {}, {},
                           [](std::string_view value, const BenchFacts& facts, const Configuration&) {
                               return std::string(value.empty() && !facts.textures ? "there are no textures"
                                                                                   : "");
                           }),
     .recorded = true},
    {.name = "trust-textures",
     .commands = kPlanners,
     .stage = SettingStage::Package,
     .group = kShaders,
     .what = "leave out features that the values of textures make unnecessary",
     .values = named<kTrustNames, &Settings::compile, &CompileSettings::trustTextures>(),
     .bench = kNoPicture,
     .document = "materials.md#what-textures-hold",
     .recorded = true,
     .idle = idleTextures},
    {.name = "texture-levels",
     .commands = kMakers,
     .stage = SettingStage::Package,
     .group = kShaders,
     .what = "record the finest level of each texture that a frame reads, for streaming and --stats",
     .values = flag<&Settings::compile, &CompileSettings::textureLevels>(),
     .bench = kNoPicture,
     .document = "textures.md#which-levels-a-frame-reads",
     .recorded = true,
     .idle = idleTextures},
    {.name = "layers",
     .commands = kMakers,
     .stage = SettingStage::Package,
     .group = kShaders,
     .what = "images beside the picture, separated by commas: of render -o FILE.exr, for denoisers and views",
     .values = kLayers,
     .bench = kNoPicture,
     .document = "layers.md",
     .recorded = true},
    {.name = "alpha",
     .commands = kPlanners,
     .stage = SettingStage::Package,
     .group = kShaders,
     .what = "alpha of hits",
     .values = optional<&Settings::alpha>("stochastic if the scene has BLEND, tested if it has masks"),
     .bench = approximates("stochastic", "stochastic tested opaque", {},
                           [](std::string_view value, const BenchFacts& facts, const Configuration&) {
                               return std::string(value.empty() && !facts.masks ? "no material has alpha"
                                                                                : "");
                           })},
    {.name = "shadow-through",
     .commands = kMakers,
     .stage = SettingStage::Package,
     .group = kShaders,
     .what = "how the light of lights passes through alpha and glass on shadow rays",
     .values = enumerator<&Settings::compile, &CompileSettings::shadowThrough>(),
     .bench = {
         .use = BenchUse::Swept,
         .exact = "glass",
         .against =
             [](std::string_view value, const BenchFacts& facts, const Configuration&) {
                 return std::string(!value.empty() || facts.passesLight ? ""
                                                                        : "no material lets light through");
             },
         // Paths find all light of the sky and of emissive triangles, in glass that bends and spreads it.
         .exactFor =
             [](const BenchFacts& facts) {
                 return std::string(facts.fullTransport && !facts.punctualLights ? "alpha" : "glass");
             }},
     .document = "shadows.md",
     .recorded = true},
    {.name = "precision",
     .commands = kMakers,
     .stage = SettingStage::Package,
     .group = kShaders,
     .what = "bits of float in shading",
     .values = decided<&Settings::choosesPrecision, &Settings::compile, &CompileSettings::precision>(
         "16 if the table of --gpu says that it is worth it and --precision-error accepts it, else 32"),
     .bench = approximates("32", "32 16", {},
                           [](std::string_view value, const BenchFacts& facts, const Configuration&) {
                               return std::string(
                                   value == "16" && !facts.float16
                                       ? "the device has no 16-bit floating point (shaderFloat16)"
                                       : "");
                           }),
     .document = "numerics.md#shading-in-16-bits",
     .recorded = true},
    {.name = "precision-error",
     .commands = kPlanners,
     .stage = SettingStage::Package,
     .group = kShaders,
     .what = "the relMSE that --precision auto may cost; 16 bits need 4e-6; 0: none",
     .values = number<&Settings::precisionError>(0.0, 1.0),
     .bench = kNoPicture,
     .document = "numerics.md#shading-in-16-bits",
     .idle = neverIdle},
    {.name = "shadows",
     .commands = kMakers,
     .stage = SettingStage::Package,
     .group = kShaders,
     .what = "where shadow rays of hits are traced",
     .values = decided<&Settings::choosesShadows, &Settings::compile, &CompileSettings::shadows>(
         "deferred if the table of --gpu says that it is worth it, else inline"),
     .bench = changesTime(withoutRays, "inline deferred"),
     .document = "performance.md#the-code-of-a-gpu",
     .recorded = true},
    {.name = "first-shadows",
     .commands = kMakers,
     .stage = SettingStage::Package,
     .group = kShaders,
     .what = "where shadow rays of what the camera sees are traced",
     .values = decided<&Settings::choosesFirstShadows, &Settings::compile, &CompileSettings::firstShadows>(
         "deferred, unless surfaces send many or layers show the light of lights"),
     .bench = kNoPicture,
     .document = "shadows.md#where-shadow-rays-are-traced",
     .recorded = true,
     .idle = neverIdle},
    {.name = "hit-record",
     .commands = kMakers,
     .stage = SettingStage::Package,
     .group = kShaders,
     .what = "data of a hit that strategies which sort hits keep between passes",
     .values = enumerator<&Settings::compile, &CompileSettings::hitRecord>(),
     .bench = approximates("full", {}, {}, withoutOrder),
     .document = "reflections.md",
     .recorded = true},
    {.name = "sample-record",
     .commands = kMakers,
     .stage = SettingStage::Package,
     .group = kShaders,
     .what = "data of an effect's ray and of its light between passes",
     .values = enumerator<&Settings::compile, &CompileSettings::sampleRecord>(),
     .bench = approximates("full", {}, {}, withoutRays),
     .document = "memory.md#samples",
     .recorded = true},
    {.name = "passes",
     .commands = kOfCompile,
     .stage = SettingStage::Package,
     .group = kShaders,
     .what = "which passes the package has",
     .values = enumerator<&Settings::compile, &CompileSettings::passes>(),
     .bench = kNoPicture,
     .document = "engine.md",
     .recorded = true},
    {.name = "answer",
     .commands = kOfCompile,
     .stage = SettingStage::Package,
     .group = kShaders,
     .what = "what RaySteps returns for each ray; surface needs --passes steps",
     .values = enumerator<&Settings::compile, &CompileSettings::answer>(),
     .bench = kNoPicture,
     .document = "engine.md#surfaces-instead-of-light",
     .recorded = true},
    {.name = "bindings",
     .commands = kOfCompile,
     .stage = SettingStage::Package,
     .group = kShaders,
     .what = "where shaders find the engine's bindings; needs --passes steps",
     .values = kBindings,
     .bench = kNoPicture,
     .document = "engine.md#bindings",
     .recorded = true},
    {.name = "position-fetch",
     .commands = kMakers,
     .stage = SettingStage::Package,
     .group = kShaders,
     .what =
         "read positions from the acceleration structure instead of from vertices, in strategies that shade "
         "hits where they find them (with ray queries, or in hit shaders)",
     .values = flag<&Settings::compile, &CompileSettings::positionFetch>(),
     .bench =
         changesTime(
             [](std::string_view value, const BenchFacts& facts, const Configuration& base) {
                 return value == "on" && !facts.positionFetch
                            ? std::string(
                                  "the device lacks VK_KHR_ray_tracing_position_fetch, or this glint's "
                                  "glslang GLSL for it")
                            : withoutRays(value, facts, base);
             },
             "off on"),
     .recorded = true},
    {.name = "strategy",
     .commands = kOfCompile,
     .stage = SettingStage::Choice,
     .group = kShaders,
     .what = "how hits can be shaded, separated by commas",
     .values =
         bits<package::Strategy, &Settings::advisesStrategy, &Settings::compile,
              &CompileSettings::strategies>("the one that should be fastest at 1920x1080, by --calibration"),
     .document = "cli.md#which-strategy"},
    {.name = "strategy",
     .commands = kOfRender,
     .stage = SettingStage::Choice,
     .group = kShaders,
     .what = "how hits are shaded",
     .values = optional<&Settings::strategy>("the one that should be fastest, by --calibration"),
     .bench = {.use = BenchUse::Swept,
               .against =
                   [](std::string_view value, const BenchFacts& facts, const Configuration& base) {
                       const package::StrategyInfo* const info = package::findStrategy(value);
                       return info != nullptr && info->ownPipeline && !facts.rayPipeline
                                  ? std::string("the device has no ray tracing pipelines")
                                  : withoutRays(value, facts, base);
                   },
               .triedFor = strategiesToTry},
     .document = "cli.md#which-strategy"},
    {.name = "tracer",
     .commands = kOfCompile,
     .stage = SettingStage::Choice,
     .group = kShaders,
     .what = "what traces rays, separated by commas; strategies of hit shaders always have their own",
     .values = bits<package::Tracer, nullptr, &Settings::compile, &CompileSettings::tracers>()},
    {.name = "tracer",
     .commands = kOfRender,
     .stage = SettingStage::Choice,
     .group = kShaders,
     .what = "what traces rays; strategies of hit shaders always use ray-pipeline",
     .values = optional<&Settings::renderer, &RendererOptions::tracer>(
         "ray-query where package and device have it, else ray-pipeline"),
     .idle = idleTracer},
    {.name = "merge",
     .commands = kPlanners,
     .stage = SettingStage::Package,
     .group = kShaders,
     .what = "which permutations share a shader; FILE: hits that --profile counted",
     .values = kMerge,
     .bench = changesTime(nullptr, "none family all auto"),
     .document = "merging.md"},
    {.name = "max-shaders",
     .commands = kPlanners,
     .stage = SettingStage::Package,
     .group = kShaders,
     .what = "limit of shaders: --merge auto and profile stay within it, the others fail above it; 0: no "
             "limit, or 32 for auto and profile",
     .values = number<&Settings::compile, &CompileSettings::plan, &PlanOptions::maxShaders>(0, 1000000)},
    {.name = "fallback",
     .commands = kMakers,
     .stage = SettingStage::Package,
     .group = kShaders,
     .what =
         "add a shader that can shade every material, in place of shaders that are not compiled yet and for "
         "materials that the package does not know",
     .values = flag<&Settings::compile, &CompileSettings::plan, &PlanOptions::fallback>(),
     .bench = kNoPicture,
     .document = "live.md",
     .recorded = true},
    {.name = "ordering",
     .commands = kOfRender,
     .stage = SettingStage::Renderer,
     .group = kReflections,
     .what = "how strategies that sort hits by shader do so",
     .values = optional<&Settings::renderer, &RendererOptions::ordering>(
         "by the device and the number of shaders", "auto|NAME"),
     .bench = changesTime(withoutOrder, {}, "auto local-histogram"),
     .document = "reflections.md#orderings"},
    {.name = "binning",
     .commands = kOfRender,
     .group = kReflections,
     .what = "sort the rays of a workgroup by direction",
     .values = enumerator<&Settings::frame, &FrameOptions::binning>(),
     .bench = changesTime(withoutRays),
     .document = "reflections.md#ray-binning"},
    {.name = "batch-effects",
     .commands = kOfRender,
     .stage = SettingStage::Renderer,
     .group = kEffectOptions,
     .what = "shade the hits of all effects together: fewer and larger dispatches, more memory",
     .values = flag<&Settings::renderer, &RendererOptions::batchEffects>(),
     .bench = changesTime(withoutRays, "off on"),
     .document = "effects.md#one-list-for-all"},
    {.name = "picture",
     .commands = kOfRender,
     .stage = SettingStage::Renderer,
     .group = kEffectOptions,
     .what = "floats of the picture's channels; pictures of several samples have 32 bits",
     .values = enumerator<&Settings::renderer, &RendererOptions::picture>(),
     .bench = kNoPicture,
     .document = "memory.md#the-picture"},
    {.name = "bands",
     .commands = kOfRender,
     .stage = SettingStage::Renderer,
     .group = kEffectOptions,
     .what = "light the picture in N bands of rows, one after the other: less memory, more dispatches; 0: "
             "one on a discrete GPU, elsewhere bands of at most 2^19 pixels",
     .values = number<&Settings::renderer, &RendererOptions::bands>(0, 1024),
     .bench = changesTime(withoutRays, "1 4"),
     .document = "memory.md#bands"},
    {.name = "compress-textures",
     .commands = kOfRender,
     .stage = SettingStage::Scene,
     .group = kPicture,
     .what = "compress PNG, JPEG and WebP textures to BC7, BC5 and BC4; the result is kept in the cache",
     .values = flag<&Settings::compressTextures>(),
     .bench = approximates("off", "off on", {},
                           [](std::string_view value, const BenchFacts& facts, const Configuration&) {
                               const bool isNeedless = value.empty() && !facts.textures;
                               const bool isMissing = value == "on" && !facts.packsTextures;
                               return std::string(
                                   isNeedless ? "there are no textures"
                                   : isMissing
                                       ? "the device reads no BC formats, or this glint can't pack them"
                                       : "");
                           }),
     .document = "textures.md#compressing-textures"},
    {.name = "traversal-order",
     .commands = kOfRender,
     .stage = SettingStage::Scene,
     .group = "Device",
     .what = "order of triangles and instances in acceleration structures",
     .values = enumerator<&Settings::traversalOrder>(),
     .document = "performance.md#traversal-on-a-cpu-driver"},
    {.name = "opacity",
     .commands = kOfRender,
     .stage = SettingStage::Scene,
     .group = "Device",
     .what = "when alpha tests of alphaMode MASK are decided",
     .values = enumerator<&Settings::opacity>(),
     .document = "alpha.md",
     .idle = idleAlpha},
    {.name = "vertices",
     .commands = kOfRender,
     .stage = SettingStage::Scene,
     .group = "Device",
     .what = "how vertices are stored",
     .values = enumerator<&Settings::vertices>(),
     .bench = approximates("full"),
     .document = "memory.md#vertices"},
    {.name = "pipeline-threads",
     .commands = kOfRender,
     .stage = SettingStage::Renderer,
     .group = "Device",
     .what = "threads that create pipelines; 0: as many as --jobs",
     .values = number<&Settings::renderer, &RendererOptions::pipelineThreads>(0, 1024),
     .bench = kNoPicture},
};

}  // namespace

std::span<const Descriptor> settingsTable() {
    return kRows;
}

const Descriptor* sweptSetting(std::string_view name) {
    const auto* const row = std::ranges::find_if(kRows, [name](const Descriptor& one) {
        return one.name == name && one.bench.use == BenchUse::Swept;
    });
    return row == std::end(kRows) ? nullptr : row;
}

}  // namespace glint::compiler
