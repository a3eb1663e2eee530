// Everything that decides about a picture, as values that people write: the settings of `glint render`, their
// conversion to settings of compiler and runtime, and to the configurations that a bench compares.
#pragma once

#include "emit/compile.h"
#include "gltf/scene.h"

#include <glint/measure/settings.h>
#include <glint/renderer.h>
#include <glint/scene_view/scene_view.h>
#include <glint/scene_view/sky.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glint::measure {

// The strategy that a cost model replaces by a real one (strategy_advice.h).
inline constexpr const char* kAutoStrategy = "auto";
inline constexpr double kMaxSky = 1e9;  // times the default sky
// Returns the lobes that hits keep with "base": the base models, and what is declared as part of the base.
FeatureMask baseLobes();

// The capabilities of a package. Strategies and tracers are lists for a package, and one value each for a
// picture.
struct TracingSettings {
    std::vector<std::string> strategies;
    std::vector<std::string> tracers;
    std::string shadows = "inline";
    std::string hitRecord = "full";
    bool positionFetch = false;
    std::optional<StrategyAdvice> advice{};  // where a strategy was auto, which has been resolved
    // `available` has the Tracer bits among which "auto" chooses, ray queries first.
    void apply(CompileSettings& settings, std::uint32_t available = package::kTracerRayQuery) const;
};

// The settings that a renderer chooses.
struct FrameSettings {
    std::string ordering = "auto";
    std::string binning = "none";
    std::string ssr = "off";  // or a number of steps
    double ssrThickness = 0.02;
    double mirrorRoughness = 0.05;
    double clamp = 0.0;  // 0: no limit
    void apply(RendererOptions& options) const;
    void apply(FrameOptions& frame) const;
};

struct EnvironmentSettings {
    std::string file;       // empty: no environment map
    double rotation = 0.0;  // degrees
    double intensity = 1.0;
    void apply(FrameOptions& frame) const;
};

// How scenes are read.
struct ReadingSettings {
    std::string variant;  // of KHR_materials_variants; empty: none
    bool strictPaths = false;
    std::vector<std::string> materials;  // folders of packs: material features of a user's own
};

// Which permutations a scene has, and which of them share code.
struct PlanSettings {
    std::string merge = "family";
    std::string alpha = "auto";
    std::vector<std::string> hitLobes{"all"};
    std::int64_t maxShaders = 0;
    std::string profile;  // file of hit counts, for the policies profile and auto
    // Returns everything except what choosePlan() finds out: the hits of a profile, and the alpha policy if
    // it is `auto`.
    PlanOptions options() const;
};

// How exact shaders are.
struct AccuracySettings {
    std::string energyCompensation = "on";
    std::string textureLod = "cones";
    std::string precision = "32";
    // Returns whether shaders also compute in 16-bit float.
    bool halves() const {
        return precision == "16";
    }
    void apply(CompileSettings& settings) const;
};

// The effects of a package.
struct EffectSettings {
    std::vector<std::string> effects{"auto"};
    double maxRoughness = 0.3;
    void apply(CompileSettings& settings) const;
};

// How a renderer runs effects.
struct EffectFrameSettings {
    double skipBelow = 0.0;
    std::int64_t shadowSamples = 1;
    double lightRadius = 0.0;  // metres
    double sunAngle = 0.0;     // degrees
    std::int64_t occlusionSamples = 4;
    double occlusionRadius = 0.0;  // metres; 0: unlimited
    std::string occlusionFalloff = "none";
    std::int64_t maxInterfaces = 8;
    bool batch = false;
    void apply(RendererOptions& options) const;
    void apply(FrameOptions& frame) const;
    void apply(scene_view::SceneViewData& scene) const;
};

struct RenderSettings {
    TracingSettings tracing;
    FrameSettings frame;
    EnvironmentSettings environment;
    ReadingSettings reading;
    PlanSettings plan;
    AccuracySettings accuracy;
    EffectSettings effects;
    EffectFrameSettings effectFrame;
    std::string package;  // a folder; empty: one is compiled
    std::string size = "960x540";
    std::int64_t samples = 1;
    std::int64_t seed = 0;
    std::string camera;  // see scene_view::chooseCamera()
    std::string sun = "auto";
    std::string sky = "auto";  // or a factor of the radiance of the default sky
    bool validate = false;
    std::string device;
    std::string traversalOrder = "auto";
    std::int64_t pipelineThreads = 0;  // 0: one a core
    std::string calibration;           // a device file; empty: constants that are built in

    // Returns whether the picture gets a light that the scene lacks.
    bool addsSun(const Scene& given) const {
        const bool isUnlit = given.lights.empty() && environment.file.empty();
        return sun == "on" || (sun == "auto" && isUnlit);
    }
};

// Returns the settings of glint render if no option is given.
RenderSettings usualSettings();

// Returns the value of every setting of settingNames().
Configuration configurationOf(const RenderSettings& render);
// Returns `render` with the values of `configuration`, which come from Setting::values or configurationOf().
RenderSettings withSettings(RenderSettings render, const Configuration& configuration);
// Returns the facts of the scene and the request on which the values worth trying depend. Facts of the device
// are left out.
Facts factsOf(const RenderSettings& render, const Scene& scene, const PlanOptions& plan);
// Returns the words of a command line: {"--spp", "4"}. A switch that is off is left out.
std::vector<std::string> wordsOf(const Configuration& configuration);
// Returns whether a setting is given by a single word, such as --position-fetch.
bool isSwitch(std::string_view setting);

TraversalOrder traversalOrderOf(const RenderSettings& render);
package::Strategy strategyOf(const RenderSettings& render);
// Returns nothing if any tracer will do.
std::optional<package::Tracer> tracerOf(const RenderSettings& render);

// Returns the scene as it is uploaded, with the light that it may lack and the sizes of lights.
scene_view::SceneViewData sceneView(const RenderSettings& render, const Scene& scene);
// Returns the settings of the package that is compiled if none is given. `tracers` are those of the device.
CompileSettings compileSettings(const RenderSettings& render, const PlanOptions& plan, std::uint32_t tracers,
                                const Scene& scene);
RendererOptions rendererOptions(const RenderSettings& render);
// Returns the sky that `sky` asks for. With `auto` it follows the lights at the pose of `scene`, from which
// `view` was made. A scene without lights of its own keeps the default sky, to which the sun belongs.
scene_view::SkyChoice chooseSky(const RenderSettings& render, const Scene& scene,
                                const scene_view::SceneViewData& view);
// `environment` may be null.
FrameOptions frameOptions(const RenderSettings& render, const CameraView& camera,
                          const scene_view::SkyChoice& sky, const Environment* environment);

// These convert a strategy's or tracer's name; an unknown one gives all of them.
package::Strategy strategyNamed(const std::string& name);
package::Tracer tracerNamed(const std::string& name);
// Parses the whole of `text` as a number within [min, max]. NaN is outside of every range.
bool parseReal(const std::string& text, double min, double max, double& value);
// Parses "960x540". Returns false unless it is two numbers that checkImageSize() accepts.
bool parseSize(const std::string& text, std::uint32_t& width, std::uint32_t& height);
// Returns 0 if the text is "off", and -1 if it is neither that nor a number of steps.
std::int64_t screenStepsOf(const std::string& text);

}  // namespace glint::measure
