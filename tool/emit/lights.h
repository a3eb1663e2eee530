// How many lights a surface takes: all of them, or some that a hierarchy chooses.
#pragma once

#include "gltf/scene.h"
#include "settings/compile_settings.h"

#include <glint/result.h>

#include <cstdint>
#include <span>

namespace glint::compiler {

// `--lights auto` takes all lights of scenes with up to as many, and so many samples of more. docs/lights.md
// says how both were measured.
inline constexpr std::size_t kFewLights = 256;
inline constexpr std::uint32_t kSamplesOfManyLights = 8;

// Returns CompileSettings::lightSamples for a package of `scenes`, which decides by the scene with the most
// lights. A host that has its own lights, or that sends its own rays, has no hierarchy. Error "lights" if the
// settings demand one nevertheless.
Result<std::uint32_t> lightSamplesOf(std::span<const gltf::Scene> scenes, const CompileSettings& settings);

}  // namespace glint::compiler
