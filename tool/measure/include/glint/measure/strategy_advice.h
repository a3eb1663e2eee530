// The strategy `auto`: chooses the strategy that is expected to be fastest, from scenes, a
// package and a device.
#pragma once

#include "gltf/scene_list.h"
#include "plan/frame_rounds.h"
#include "plan/gpu_costs.h"
#include "plan/plan.h"
#include "plan/strategy_choice.h"

#include <glint/context.h>
#include <glint/measure/render_settings.h>
#include <glint/package.h>
#include <glint/result.h>

#include <optional>
#include <string>
#include <vector>

namespace glint::measure {

// The constants on which an estimate is based.
struct KnownCosts {
    compiler::DeviceCosts device;
    bool builtIn = true;
    std::optional<compiler::GpuCosts> gpu{};  // if set, withGpu() has adapted `device` to it
};
// Returns the costs in the file of --calibration, or the built-in costs for the type of device if none is
// named, with the values of --gpu's table. Has the errors of readDeviceFile() and readGpuCosts().
Result<KnownCosts> knownCosts(const compiler::Settings& settings, bool onCpu);

// Returns the strategies that can be chosen for a device with these tracers (bits), traced by `tracer` if it
// is given, and contained in the package if there is one. The names are in the order of simplestFirst().
std::vector<std::string> runnableStrategies(std::uint32_t deviceTracers,
                                            std::optional<package::Tracer> tracer, const Package* package);

// Returns the rounds of a frame of each scene, for all scenes together. `plan` is that of the scenes.
std::vector<compiler::Round> roundsOf(const gltf::SceneList& scenes, const compiler::Plan& plan,
                                      const compiler::PlanOptions& options,
                                      const compiler::FrameShape& shape);

// Returns the choice among `available`. Error "calibration-strategies" if there are constants for none of
// them.
Result<compiler::StrategyAdvice> adviseStrategy(const KnownCosts& costs,
                                                const std::vector<compiler::Round>& rounds,
                                                const std::vector<std::string>& available, double pixels);

// Advises for one scene, before anything is rendered. The candidates are the strategies that the device can
// run, of `package` if it is not null, else of a package that would be compiled by `plan`. Warns
// "calibration-device" if the calibration is for another device. Has the errors of knownCosts() and
// adviseStrategy().
Result<compiler::StrategyAdvice> adviseRender(const compiler::Settings& arguments,
                                              const compiler::PlanOptions& plan, Context& context,
                                              const gltf::Scene& scene, const Package* package,
                                              std::vector<Diagnostic>& warnings);

}  // namespace glint::measure
