// The input of glint render: a scene with its pixels, and the package that shades it.
#pragma once

#include "emit/compile.h"
#include "gltf/scene.h"

#include <glint/package.h>
#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace glint {

// Returns which of the package's scenes it is: the one with the file's name, or the only one.
std::optional<std::uint32_t> sceneIn(const Package& package, const Scene& scene);

// The requirements on a package that was compiled earlier.
struct PackageDemand {
    package::Strategy strategy = package::kStrategyVisibility;
    std::optional<package::Tracer> tracer;  // absent: any
    bool environmentMap = false;
};

// Error "package-mismatch" unless `package` was compiled with what is required, and from this scene: it must
// have the same materials, and for each primitive the same material and features. Error "package-tracer" if
// it lacks the tracer.
Status checkPackage(const Package& package, const std::filesystem::path& folder, const PackageDemand& demand,
                    const Scene& scene);

// Loads it through a temporary folder, which is removed on return.
Result<Package> loadTemporary(const CompiledPackage& compiled);

// Compiles `scene` and loads the package in the same way, without files that the runtime does not read.
// Modules that `cache` has are not compiled; it may be null.
Result<Package> compileTemporary(const Scene& scene, CompileSettings settings, ModuleCache* cache = nullptr);

}  // namespace glint
