// Which lights a surface takes: all of them, or some that a hierarchy chooses; whether triangles that emit
// light and the sky are among them; and what shadow rays pass.
#pragma once

#include "gltf/scene.h"
#include "gltf/scene_list.h"
#include "plan/light_samples.h"
#include "settings/compile_settings.h"

#include <glint/result.h>

#include <cstdint>
#include <span>

namespace glint::compiler {

// `--emissive-lights=auto` takes no more triangles of a scene as lights.
inline constexpr std::size_t kMostEmitters = std::size_t{1} << 18;

// Returns the number of triangles of all instances of a scene that emit light, now or at a time of an
// animation.
std::size_t countEmitters(const gltf::Scene& scene);

// Returns what a hierarchy over the lights of a scene may choose: point and spot lights, and the emissive
// triangles where these are lights. emissiveLights must be decided.
LightCounts countLights(const gltf::Scene& scene, const CompileSettings& settings);

// Returns EmissiveLights::On or Off for a package of `scenes`. It is Off where nothing emits light. Error
// "emissive-lights" if the settings demand what a host with lights of its own, or a package without shadow
// rays, can't have.
Result<EmissiveLights> emissiveLightsOf(std::span<const gltf::Scene> scenes, const CompileSettings& settings);

// Returns SkyLight::On or Off for a package of `scenes`. Error "sky-light" if the settings demand what a host
// with a sky or lights of its own, or a package without shadow rays, can't have.
Result<SkyLight> skyLightOf(std::span<const gltf::Scene> scenes, const CompileSettings& settings);

// Returns SizedLights::On or Off for a package of `scenes`. Error "sized-lights" if the settings demand what
// a host with lights of its own, or a package without shadow rays, can't have.
Result<SizedLights> sizedLightsOf(std::span<const gltf::Scene> scenes, const CompileSettings& settings);

// Returns the features that decide what the triangles emit: those that all of them have, and those that some
// have. If a layer covers the emission of one, they are all features. In a package with a fallback any
// material of the plan's features may become a light, so none is taken for granted.
struct EmitterFeatures {
    materials::FeatureMask read = 0;  // that emission may depend on
    materials::FeatureMask always = 0;
    materials::FeatureMask sometimes = 0;
    bool coveredByLayers = false;
};
EmitterFeatures emitterFeatures(const gltf::SceneList& scenes, const Plan& plan, bool fallback);

// Returns CompileSettings::shadowThrough for a package, or Alpha if it would change nothing: without shadows,
// and where no material has what light would pass otherwise.
package::ShadowThrough shadowThroughOf(const gltf::SceneList& scenes, const Plan& plan,
                                       const CompileSettings& settings);

// Returns CompileSettings::lightSamples for a package of `scenes`. Without a number in the settings it is the
// most of lightSamplesFor() over the scenes. emissiveLights must be decided. A host that has its own lights,
// or that sends its own rays, has no hierarchy. Error "lights" if the settings demand one nevertheless.
Result<std::uint32_t> lightSamplesOf(std::span<const gltf::Scene> scenes, const CompileSettings& settings);

}  // namespace glint::compiler
