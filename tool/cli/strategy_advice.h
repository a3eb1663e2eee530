// --strategy auto and --calibration: from scenes, a package and a device to the strategy that is expected to
// be fastest.
#pragma once

#include "cli/render_arguments.h"
#include "gltf/scene_list.h"
#include "plan/frame_rounds.h"
#include "plan/plan.h"
#include "plan/strategy_choice.h"

#include <glint/context.h>
#include <glint/package.h>
#include <glint/result.h>

#include <optional>
#include <string>
#include <vector>

namespace glint {

// The constants that an estimate stands on.
struct KnownCosts {
    DeviceCosts device;
    bool builtIn = true;
};
// Of the file, else those that are built in for the type of device. Errors of readDeviceFile().
Result<KnownCosts> knownCosts(const std::string& file, bool onCpu);

// Those that can be chosen for a device with these tracers (bits), traced by `tracer` if it is given, of the
// package if there is one. Names, in the order of kStrategyNames.
std::vector<std::string> runnableStrategies(std::uint32_t deviceTracers,
                                            std::optional<package::Tracer> tracer, const Package* package);

// The rounds of a frame of each scene, of all of them. `plan`: of the scenes.
std::vector<Round> roundsOf(const SceneList& scenes, const Plan& plan, const PlanOptions& options,
                            const FrameShape& shape);

// The choice among `available`. Error "calibration-strategies" where the constants are of none of them.
Result<StrategyAdvice> adviseStrategy(const KnownCosts& costs, const std::vector<Round>& rounds,
                                      const std::vector<std::string>& available, double pixels);

// For one scene, before anything is rendered: what the device can run, of the package that is named if there
// is one, else of one that would be compiled by `plan`. Warns "calibration-device" where the calibration is
// of another device. Errors of Package::load(), knownCosts(), adviseStrategy().
Result<StrategyAdvice> adviseRender(const RenderArguments& arguments, const PlanOptions& plan,
                                    const Context& context, const Scene& scene,
                                    std::vector<Diagnostic>& warnings);

}  // namespace glint
