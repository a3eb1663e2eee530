// All settings of a package and of its pictures, as the values of compiler and runtime. Each setting has a
// row in the table of settings/descriptor.h, which gives its name, its text and its help.
#pragma once

#include "plan/effects.h"
#include "plan/plan.h"
#include "plan/strategy_cost.h"

#include <glint/internal/package_modules.h>
#include <glint/renderer_options.h>
#include <glint/result.h>
#include <glint/scene_view.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::compiler {

// Ends a word of CompileSettings::layers whose layer a package may lack, because it has no effect with such a
// layer: "hit-shader?".
inline constexpr char kOptionalLayer = '?';

// The choice of the level of a texture that hits read.
enum class TextureLod : std::uint8_t {
    Cones,  // by the width of a ray cone
    Mip0    // always the finest level
};
inline constexpr Named<TextureLod> kTextureLodNames[] = {
    {TextureLod::Cones, "cones", "by the footprint of the ray"},
    {TextureLod::Mip0, "mip0", "the finest"},
};
constexpr std::span<const Named<TextureLod>> namesOf(TextureLod /*type*/) {
    return kTextureLodNames;
}

// The choice whether triangles that emit light are lights.
enum class EmissiveLights : std::uint8_t { Auto, Off, On };
inline constexpr Named<EmissiveLights> kEmissiveLightsNames[] = {
    {EmissiveLights::Auto, "auto", "in packages for several bounces, with up to 262,144 such triangles"},
    {EmissiveLights::Off, "off", "rays find them by chance"},
    {EmissiveLights::On, "on", "surfaces send shadow rays to them"},
};
constexpr std::span<const Named<EmissiveLights>> namesOf(EmissiveLights /*type*/) {
    return kEmissiveLightsNames;
}

// The choice whether the sky is a light that surfaces sample.
enum class SkyLight : std::uint8_t { Auto, Off, On };
inline constexpr Named<SkyLight> kSkyLightNames[] = {
    {SkyLight::Auto, "auto", "in packages for several bounces with the effects shadow and indirect-diffuse"},
    {SkyLight::Off, "off", "rays find its light, and without occlusion it stands in for further ones"},
    {SkyLight::On, "on", "surfaces send shadow rays to it"},
};
constexpr std::span<const Named<SkyLight>> namesOf(SkyLight /*type*/) {
    return kSkyLightNames;
}

// The choice whether rays of lobes find area lights (LightView::size).
enum class SizedLights : std::uint8_t { Auto, Off, On };
inline constexpr Named<SizedLights> kSizedLightsNames[] = {
    {SizedLights::Auto, "auto",
     "in packages for several bounces with the effect shadow, if --light-radius or --sun-angle is given"},
    {SizedLights::Off, "off", "light samples alone find them, and mirrors do not show them"},
    {SizedLights::On, "on", "rays of lobes find them, too, with multiple importance sampling"},
};
constexpr std::span<const Named<SizedLights>> namesOf(SizedLights /*type*/) {
    return kSizedLightsNames;
}

// The choice whether shaders know disks among the lights (LightView::Type::Disk), which only programs have.
enum class DiskLights : std::uint8_t { Auto, Off, On };
inline constexpr Named<DiskLights> kDiskLightsNames[] = {
    {DiskLights::Auto, "auto", "in packages with emissive or sized lights, and with --passes steps"},
    {DiskLights::Off, "off", "a program that gives a disk gets an error"},
    {DiskLights::On, "on", "a program may have disks"},
};
constexpr std::span<const Named<DiskLights>> namesOf(DiskLights /*type*/) {
    return kDiskLightsNames;
}

// The way in which shaders are compiled that neither the cache nor the memory of the process has.
enum class NewShaders : std::uint8_t {
    Optimized,
    // They are compiled as without CompileSettings::optimize, in a third of the time, unless they are joined
    // from parts.
    Folded,
};

struct CompileSettings {
    std::uint32_t strategies = package::kDefaultStrategies;
    std::uint32_t tracers = package::kTracerRayQuery;
    package::ShadowPlacement shadows = package::ShadowPlacement::Inline;
    // The same for first hits. Where something speaks against Deferred, resolve() makes it Inline.
    package::ShadowPlacement firstShadows = package::ShadowPlacement::Deferred;
    // The rays of a first hit that wait at once, if they are deferred (resolve() counts them).
    std::uint32_t firstShadowRays = 1;
    package::ShadowThrough shadowThrough = package::ShadowThrough::Alpha;
    package::HitRecordFormat hitRecord = package::HitRecordFormat::Full;
    package::SampleRecordFormat sampleRecord = package::SampleRecordFormat::Full;
    std::uint32_t maxBounces = 1;  // of paths: 1 to package::kMaxBounces
    package::Passes passes = package::Passes::Frame;
    package::HitAnswer answer = package::HitAnswer::Radiance;
    package::Bindings bindings{};  // Passes::Steps alone may have other than the default's
    bool environmentMap = false;   // Rays that leave the scene read an environment map instead of a gradient.
    // With this, strategies that shade a hit where they find it read the positions of its triangle from the
    // acceleration structure instead of the vertex buffer: with ray queries, or in a pipeline of their own.
    bool positionFetch = false;
    PlanOptions plan;
    EffectRequest effects{false, builtinEffects({"shadow", "reflection"})};
    // True if the renderer adds a light to those of the scenes. --effects auto takes that into account.
    bool addsLight = false;
    // True if the renderer gives lights a size. --sized-lights=auto takes that into account.
    bool sizesLights = false;
    // How many lights a surface chooses by a hierarchy; 0: it takes all. No value leaves it to the number of
    // lights (resolve/light.h).
    std::optional<std::uint32_t> lightSamples{};
    EmissiveLights emissiveLights = EmissiveLights::Auto;
    SkyLight skyLight = SkyLight::Auto;
    SizedLights sizedLights = SizedLights::Auto;
    DiskLights diskLights = DiskLights::Auto;
    bool energyCompensation = true;  // Compensates light that bounces between microfacets more than once.
    TextureLod textureLod = TextureLod::Cones;
    // True if planning reads the contents of textures (gltf::ImportOptions::trustTextures). Packages with a
    // fallback or a host do not, because their textures may change at run time.
    bool trustTextures = true;
    bool textureLevels = false;         // shaders note the finest level that they read of each texture
    std::vector<std::string> layers{};  // images beside the picture, as --layers names them
    package::ShadingPrecision precision = package::ShadingPrecision::Single;
    int jobs = 0;  // threads; 0 means one for each core
    // Gets how many modules and parts are done, and how many there are to do. Any thread may call it, one at
    // a time.
    std::function<void(std::size_t done, std::size_t all)> progress{};
    bool emitHeader = true;     // glint_tables.h
    bool emitGlsl = false;      // writes the flattened sources, in glsl/
    bool emitLibrary = false;   // writes shading as functions in GLSL, in library/
    bool emitLinkable = false;  // writes the same functions as a SPIR-V module that can be linked, there
    bool debugInfo = false;     // keeps names in the SPIR-V
    bool optimize = true;       // as in ShaderCompileOptions
    NewShaders newShaders = NewShaders::Optimized;
    // A folder with files that stand in for those of shaders/host; empty: none (resolve/host.h).
    std::string host{};
    // The choice that led to `strategies`, for the manifest. Empty if the user named the strategies.
    std::optional<StrategyAdvice> strategyChoice{};
    // The folder in which `glint compile-module` left the modules. If it is empty, modules are compiled here.
    std::filesystem::path modules{};
};

// Found by their arguments from other namespaces.
using glint::nameOf;

// The choice whether a picture gets a light that the scene lacks.
enum class Sun : std::uint8_t { Auto, On, Off };
inline constexpr Named<Sun> kSunNames[] = {
    {Sun::Auto, "auto", "only if the scene has no light and there is no --environment"},
    {Sun::On, "on"},
    {Sun::Off, "off"},
};
constexpr std::span<const Named<Sun>> namesOf(Sun /*type*/) {
    return kSunNames;
}

// A request to keep shader IDs from build to build.
struct LockRequest {
    std::string file{};      // empty: they aren't
    bool frozen = false;     // error rather than change the file
    bool prune = false;      // keys that no scene has go
    bool isWritten = false;  // by the command; else the file must be there
};

// The settings that a user asks for. resolve() (resolve/resolve.h) decides those that depend on the scene or
// the device.
struct Settings {
    Settings();  // the settings of `glint render` without options

    CompileSettings compile;
    RendererOptions renderer;
    FrameOptions frame;

    // The strategy of a picture. No value takes the one that should be fastest.
    std::optional<package::Strategy> strategy = package::kDefaultStrategy;
    // A package also gets the strategy that should be fastest, besides compile.strategies.
    bool advisesStrategy = false;
    // The table of `gpu` decides about the member of `compile`, which has the usual value until then.
    bool choosesShadows = false;
    bool choosesFirstShadows = true;
    bool choosesPrecision = false;
    double precisionError = 0.0;  // relMSE that the choice of a precision may cost
    // A package that is compiled for pictures has these strategies, too, so that a renderer of one of them
    // can switch to it.
    std::uint32_t furtherStrategies = 0;
    // Layers that a package that is compiled for pictures has besides compile.layers, as a view or a denoiser
    // reads them.
    std::vector<std::string> readLayers{};
    // Hits are counted for a profile, so every key has a case of its own.
    bool countsHits = false;
    std::optional<package::AlphaPolicy> alpha{};  // none: as the scene needs
    Sun sun = Sun::Auto;
    std::optional<double> sky{};       // factor of the default sky's radiance; none: as bright as the lights
    std::uint32_t samples = 1;         // for each pixel
    double lightRadius = 0.0;          // of point and spot lights, metres
    double sunAngle = 0.0;             // angular diameter of directional lights, degrees
    double environmentRotation = 0.0;  // degrees
    SceneView::TraversalOrder traversalOrder = SceneView::TraversalOrder::Auto;
    SceneView::OpacityUse opacity = SceneView::OpacityUse::Proved;
    SceneView::VertexForm vertices = SceneView::VertexForm::Compact;
    bool compressTextures = false;

    // Names and files. They are options of their own, without rows in the table.
    std::string environment;  // a map; empty: a gradient
    std::string camera;       // see session::chooseCamera()
    std::string device;
    std::string package;  // a folder; empty: one is compiled
    std::string profile;  // hit counts, for the merge policies profile and auto
    LockRequest lock{};
    std::string calibration;  // a device file; empty: constants that are built in
    std::string sceneInFile;  // ImportOptions::scene; empty: the file's default
    std::string gpu;          // name or file of a table of a GPU's code, or kThisDevice; empty: none
    std::string variant;      // of KHR_materials_variants; empty: none
    bool strictPaths = false;
    std::vector<std::string> materials;  // folders of packs: material features of a user's own
    std::vector<std::string> packLobes;  // lobes of these that hits keep besides those of compile.plan.keys
    bool validate = false;

    // The names of the settings that have another value than usual because the user gave it.
    std::vector<std::string> given;
};

// The value of Settings::gpu that stands for the device that renders.
inline constexpr std::string_view kThisDevice = "device";

// Returns the lobes that hits keep with "base": the base models, and lobes that are declared as part of the
// base.
materials::FeatureMask baseLobes();

// Parses the whole of `text` as a number within [min, max]. NaN is outside of every range.
bool parseReal(std::string_view text, double min, double max, double& value);
bool parseWhole(std::string_view text, std::int64_t min, std::int64_t max, std::int64_t& value);
// Parses "960x540". Returns false unless it is the size of a picture that can be made.
bool parseSize(std::string_view text, std::uint32_t& width, std::uint32_t& height);
// The value of --merge: a policy, and the file of `POLICY:FILE`, which policies that use hits may name.
struct MergeChoice {
    MergePolicy policy{};
    std::string_view file;
};
std::optional<MergeChoice> parseMerge(std::string_view text);
constexpr bool takesHits(MergePolicy policy) {
    return policy == MergePolicy::Auto || policy == MergePolicy::Profile;
}

// Found by their arguments from other namespaces.
using glint::nameOf;

}  // namespace glint::compiler
