// Brings a scene and a compiled package together: checks whether they match, and loads a fresh package.
#pragma once

#include "emit/package/compiled_package.h"
#include "gltf/scene.h"
#include "resolve/resolve.h"

#include <glint/package.h>
#include <glint/result.h>

#include <cstdint>
#include <optional>
#include <string>

namespace glint::compiler {
class ModuleCache;
}  // namespace glint::compiler

namespace glint::scene_view {

// Returns the index of the scene within the package: the one with the file's name, or 0 if there is only one.
// Returns nothing if the package does not know the scene.
std::optional<std::uint32_t> sceneIn(const Package& package, const gltf::Scene& scene);

// Error "package-mismatch" unless `package` has what a build of one scene asks for, and was compiled from
// this scene: it must have the same materials, and for each primitive the same material and features. Error
// "package-tracer" if it lacks the tracer. Errors name Settings::package as their place.
Status checkPackage(const Package& package, const compiler::Build& build);

// Loads a package that was just compiled, from memory. Has the errors of Package::load().
Result<Package> loadPackage(const compiler::CompiledPackage& compiled);

// Compiles a package and loads it. Modules that `cache` has are not compiled; it may be null. Has the errors
// of compilePackage().
Result<Package> compileAndLoad(const compiler::Build& build, compiler::ModuleCache* cache = nullptr);

}  // namespace glint::scene_view
