// What glint render works on: a scene with its pixels, and the package that shades it.
#pragma once

#include "cli/options.h"
#include "gltf/scene.h"

#include <glint/package.h>
#include <glint/result.h>

#include <filesystem>
#include <string>

namespace glint {

// Error "package-mismatch" unless `package` was compiled for the strategy and from this scene: the same
// materials, and for each primitive of it the same material and features.
Status checkPackage(const Package& package, const std::filesystem::path& folder, package::Strategy strategy,
                    const Scene& scene);

// Compiles `scene` for one strategy into a temporary folder, which is gone on return.
Result<Package> compileTemporary(const Scene& scene, package::Strategy strategy, const PlanOptions& plan);

}  // namespace glint
