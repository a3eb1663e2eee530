// The scenes of one number of cases and one cost on the device, and the package that they share.
#pragma once

#include "emit/compile.h"
#include "synthetic/cases_scene.h"

#include <glint/context.h>
#include <glint/measure/calibration_report.h>
#include <glint/measure/strategy_fit.h>
#include <glint/package.h>
#include <glint/renderer.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace glint::measure {

// A scene whose rays belong to one effect.
struct CalibrationScene {
    synthetic::CasesOptions options;
    std::unique_ptr<GpuScene> scene;
    CameraView camera;
    package::Effect effect{};
};

// The scenes and their package on the host, before the upload.
struct CompiledGroup {
    std::vector<synthetic::CasesOptions> options;  // of each scene
    std::vector<gltf::Scene> scenes;
    compiler::CompiledPackage package;  // of every strategy, with a case a key
};

struct CalibrationGroup {
    std::unique_ptr<Package> package;
    std::vector<CalibrationScene> scenes;
    std::vector<CaseWork> work;  // by shader ID; no shares
};

// Returns the strategies that a device with these Tracer bits can run, uber first.
std::vector<std::string> strategiesFor(std::uint32_t tracers);

// Makes a scene for each of `options`, which differ in coherence alone, and compiles their package with the
// strategies of strategiesFor(). Has the errors of compilePackage().
Result<CompiledGroup> compileGroup(const CalibrationSettings& settings, std::uint32_t tracers,
                                   std::vector<synthetic::CasesOptions> options,
                                   compiler::ModuleCache* cache);

// Has the errors of each step.
Result<CalibrationGroup> uploadGroup(Context& context, const CompiledGroup& compiled);

}  // namespace glint::measure
