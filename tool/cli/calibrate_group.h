// The scenes of one number of cases and one cost on the device, and the package that they share.
#pragma once

#include "bench/calibration_point.h"
#include "cli/bench_arguments.h"
#include "synthetic/cases_scene.h"

#include <glint/context.h>
#include <glint/package.h>
#include <glint/renderer.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace glint {

class ModuleCache;

// A scene whose rays are of one effect.
struct CalibrationScene {
    synthetic::CasesOptions options;
    std::unique_ptr<GpuScene> scene;
    CameraView camera;
    package::Effect effect{};
};

struct CalibrationGroup {
    std::unique_ptr<Package> package;  // of every strategy, with a case a key
    std::vector<CalibrationScene> scenes;
    std::vector<bench::CaseWork> work;  // by shader ID; no shares
    double compileMs = 0.0;
};

// The strategies that a device with these Tracer bits can run, uber first.
std::vector<std::string> strategiesFor(std::uint32_t tracers);

// Compiles, with the strategies of strategiesFor(), and uploads. A scene for each of `all`, which differ in
// coherence alone. Errors of each step.
Result<CalibrationGroup> makeCalibrationGroup(Context& context, const BenchArguments& arguments,
                                              std::span<const synthetic::CasesOptions> all,
                                              ModuleCache* cache);

}  // namespace glint
