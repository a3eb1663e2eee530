// All decisions about a package and its pictures. resolve() of resolve/resolve.h makes them, once; later
// steps take the Build as it is.
#pragma once

#include "gltf/scene_list.h"
#include "plan/frame_rounds.h"
#include "plan/gpu_costs.h"
#include "plan/plan.h"
#include "plan/strategy_cost.h"
#include "settings/settings.h"

#include <glint/internal/package_modules.h>
#include <glint/result.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace glint::compiler {

// The constants on which an estimate of a strategy's time is based.
struct KnownCosts {
    DeviceCosts device = builtInCosts(false);
    bool builtIn = true;
    std::optional<GpuCosts> gpu{};  // `device` is what withGpu() makes of the measured one
};

// The decisions of a package that exists already.
struct DecidedPackage {
    package::PackageShape shape;
    package::AlphaPolicy alpha{};
    package::ShadowThrough shadowThrough{};
    bool trustsTextures = false;
    bool emissiveLights = false;
    bool skyLight = false;
    bool sizedLights = false;
    bool diskLights = false;
    std::uint32_t lightSamples = 0;
    std::vector<CaseFeatures> cases;  // by shader ID
    std::vector<CaseHits> hits;       // of the scene, as they are expected
};

// The place where shaders will run.
struct Target {
    KnownCosts costs{};
    // The tracers (bits) of the device that draws pictures. No value is a package for any device.
    std::optional<std::uint32_t> tracers{};
    // The package of the pictures. No value compiles one.
    std::optional<DecidedPackage> package{};
    std::vector<Diagnostic> warnings{};  // about the device
};

struct Build {
    std::shared_ptr<const gltf::SceneList> scenes;
    // As the user gave them.
    Settings asked;
    // The same without `auto`: strategies, tracers, alpha, textures, effects, lights and layers are those of
    // the package. compile.strategyChoice says why a strategy was chosen, and plan.effects why an effect was.
    Settings settings;
    Plan plan;
    // The times of frames with other cases: with --merge auto, and for `explain`.
    std::vector<std::string> mergedFor{};   // strategies
    std::vector<MergeEstimate> merges{};    // the times are by strategy of mergedFor
    std::optional<std::string> excess{};    // why the plan has too many cases
    std::optional<std::string> lockText{};  // what is to be written to the lock file, if that changes
    std::vector<Diagnostic> messages{};     // warnings and notes about the decisions
    bool draws = false;                     // for pictures on a device
    double milliseconds = 0.0;              // wall clock that deciding took
};

// Returns the facts of a package from which the list of its modules follows.
package::PackageShape shapeOf(const gltf::SceneList& scenes, const Plan& plan,
                              const CompileSettings& settings);

}  // namespace glint::compiler
