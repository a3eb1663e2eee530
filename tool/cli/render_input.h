// What glint render works on: a scene with its pixels, and the package that shades it.
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

// Which of the package's scenes it is: that of the file's name, or the only one there is.
std::optional<std::uint32_t> sceneIn(const Package& package, const Scene& scene);

// What is asked of a package that was compiled before.
struct PackageDemand {
    package::Strategy strategy = package::kStrategyVisibility;
    std::optional<package::Tracer> tracer;  // absent: any
    bool environmentMap = false;
};

// Error "package-mismatch" unless `package` was compiled for what is asked, and from this scene: the same
// materials, and for each primitive of it the same material and features. Error "package-tracer" where it
// lacks the tracer.
Status checkPackage(const Package& package, const std::filesystem::path& folder, const PackageDemand& demand,
                    const Scene& scene);

// By way of a temporary folder, which is gone on return.
Result<Package> loadTemporary(const CompiledPackage& compiled);

// Compiles `scene` likewise; leaves out what the runtime does not read. Modules that `cache` has are not
// compiled; null: there is none.
Result<Package> compileTemporary(const Scene& scene, CompileSettings settings, ModuleCache* cache = nullptr);

}  // namespace glint
