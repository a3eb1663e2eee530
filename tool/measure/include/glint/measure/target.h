// The place where shaders will run, for resolve(): the costs of a device, its tracers, and the decisions of a
// package.
#pragma once

#include "gltf/scene.h"
#include "resolve/build.h"

#include <glint/context.h>
#include <glint/package.h>
#include <glint/result.h>

namespace glint::measure {

// Returns a target for any device. Its costs are those in the file of --calibration, if a strategy is to be
// chosen, or the built-in costs of a GPU, with what the table of --gpu says. Has the errors of
// readDeviceFile() and readGpuCosts().
Result<compiler::Target> targetOf(const compiler::Settings& settings);

// Returns the target of pictures on a device: of `package` if it is not null, else of a package that is to be
// compiled. Warns "calibration-device" if the calibration is for another device, and "gpu-device" if the
// device can't say what --gpu device asks for.
Result<compiler::Target> targetOf(const compiler::Settings& settings, Context& context,
                                  const Package* package, const gltf::Scene& scene);

}  // namespace glint::measure
