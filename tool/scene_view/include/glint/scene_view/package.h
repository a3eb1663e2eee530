// Brings a scene and a compiled package together: whether they match, and how a fresh one is loaded.
#pragma once

#include "emit/compile.h"
#include "gltf/scene.h"

#include <glint/package.h>
#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace glint::scene_view {

// Returns the index of the scene within the package: the one with the file's name, or 0 if there is only one.
// Returns nothing if the package does not know the scene.
std::optional<std::uint32_t> sceneIn(const Package& package, const gltf::Scene& scene);

// The requirements on a package that was compiled earlier.
struct PackageDemand {
    package::Strategy strategy = package::kDefaultStrategy;
    std::optional<package::Tracer> tracer;  // absent: any
    bool environmentMap = false;
};

// Error "package-mismatch" unless `package` was compiled with what is required, and from this scene: it must
// have the same materials, and for each primitive the same material and features. Error "package-tracer" if
// it lacks the tracer. `folder` is the place that errors name.
Status checkPackage(const Package& package, const std::filesystem::path& folder, const PackageDemand& demand,
                    const gltf::Scene& scene);

// Loads a package that was just compiled, from memory. Has the errors of Package::load().
Result<Package> loadPackage(const compiler::CompiledPackage& compiled);

// Compiles a package and loads it. Modules that `cache` has are not compiled; it may be null. Has the errors
// of compilePackage().
Result<Package> compileAndLoad(const compiler::Build& build, compiler::ModuleCache* cache = nullptr);
// Resolves the settings for `scene` before, without files that the runtime does not read.
Result<Package> compileAndLoad(const gltf::Scene& scene, compiler::CompileSettings settings,
                               compiler::ModuleCache* cache = nullptr);

}  // namespace glint::scene_view
