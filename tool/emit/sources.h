// The GLSL files that modules are flattened from: the embedded ones, and those made for a scene.
#pragma once

#include "emit/source_set.h"
#include "gltf/scene_list.h"
#include "plan/plan.h"
#include "settings/settings.h"

#include <glint/result.h>

#include <cstdint>
#include <string>

namespace glint::compiler {

// Returns the embedded files, "generated/features.glsl", "generated/scene.glsl" and "generated/cases.glsl".
// Has the errors of addHost() and renderTemplate().
Result<SourceSet> makeSourceSet(const gltf::SceneList& scenes, const Plan& plan,
                                const CompileSettings& settings);

// Returns the C++ declarations of every structure that host and device share, flattened from shaders/interop.
Result<std::string> interopDeclarations();

// Returns a hash of the names and texts of shaders/interop.
std::uint64_t interopSourceHash();

}  // namespace glint::compiler
