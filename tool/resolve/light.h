// The effects of a package, and the lights that its surfaces take: all of them, or some that a hierarchy
// chooses; with or without triangles that emit light, the sky and area lights. Effects depend
// on lights, which need the effect `shadow`, so both are decided together.
#pragma once

#include "gltf/scene_list.h"
#include "plan/effects.h"
#include "plan/light_constants.h"
#include "plan/plan.h"
#include "settings/settings.h"

#include <glint/layers.h>
#include <glint/result.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace glint::compiler {

// --- The model behind --lights auto, which chooses how many samples a surface takes of a scene's lights ---
//
// A surface has n lights that have a position. It can take all of them, or K samples that the hierarchy
// chooses. The time of a sample of a pixel is linear in constants:
//
//     all:        R + A n
//     K samples:  R + K (S + L log2 n)
//
// R is the time without lights. All lights are taken as long as they cost no more than fitted::kLightSamples
// samples in each scene that was measured. So a further light does not make the default faster. Where it
// changes, the samples are most of the lights, so that they have little noise.
//
// The constants are fitted to measurements (plan/light_constants.h), which also have the noise: with K, the
// product of time and error is near its minimum (docs/lights.md). A package is made without a device, so
// there is one set of them.

// Returns the time of a sample of a pixel, in nanoseconds. `samples` is 0 for all lights, of which there are
// some.
double lightTime(const fitted::LightTimes& scene, std::size_t lights, std::uint32_t samples);

// The lights of a scene that a hierarchy may choose.
struct LightCounts {
    std::size_t positions = 0;  // point and spot lights
    std::size_t emitters = 0;   // emissive triangles
    bool areApart = false;      // beside the triangles, every surface takes all point and spot lights
};

// Returns the choice of --lights auto: a number of samples, or 0 for all lights.
std::uint32_t lightSamplesFor(const LightCounts& counts);

// --- The decision ---

// `--emissive-lights=auto` takes no more triangles of a scene as lights.
inline constexpr std::size_t kMostEmitters = std::size_t{1} << 18;

// None of the values is Auto.
struct LightPlan {
    EffectPlan effects;
    EmissiveLights emissive = EmissiveLights::Off;  // Off where nothing emits light
    SkyLight sky = SkyLight::Off;
    SizedLights sized = SizedLights::Off;
    DiskLights disks = DiskLights::Off;
    std::uint32_t samples = 0;  // CompileSettings::lightSamples
};

// Returns the effects of a package, where `isLit` says whether it has a light.
EffectPlan planEffects(const gltf::SceneList& scenes, const CompileSettings& settings, bool isLit);

// Decides by the materials that primitives use, by the lights of the scenes, and by the files of shaders/host
// that the host replaces. Errors: those of hostFiles(); "emissive-lights", "sky-light", "sized-lights" and
// "lights" if the settings demand what a host with lights of its own, a package without shadow rays, or steps
// can't have. `ofLit` is planEffects() with a light.
Result<LightPlan> planLight(const gltf::SceneList& scenes, const CompileSettings& settings,
                            const EffectPlan& ofLit);
inline Result<LightPlan> planLight(const gltf::SceneList& scenes, const CompileSettings& settings) {
    return planLight(scenes, settings, planEffects(scenes, settings, true));
}

// Returns the number of triangles of all instances of a scene that emit light, now or at a time of an
// animation.
std::size_t countEmitters(const gltf::SceneList& scenes, std::size_t scene);

// Returns what a hierarchy over the lights of a scene may choose: point and spot lights, and the emissive
// triangles where these are lights.
LightCounts countLights(const gltf::SceneList& scenes, std::size_t scene, EmissiveLights emissive);

// Where shadow rays of first hits are traced. A pass of their own leaves the shaders of cases without the
// code of a traversal, so that they take fewer registers and less time to compile.
struct FirstShadowPlan {
    package::ShadowPlacement placement = package::ShadowPlacement::Inline;
    std::uint32_t rays = 1;  // CompileSettings::firstShadowRays
};
// Requires that `plan` has its effects and layers, and that lights are decided. `chooses`: nobody asks for
// CompileSettings::firstShadows. Error "first-shadows" if rays are to be deferred that can't be.
Result<FirstShadowPlan> planFirstShadows(const gltf::SceneList& scenes, const Plan& plan,
                                         const CompileSettings& compile, bool chooses);

// Returns whether a picture gets a light that its scene lacks.
bool addsSun(const Settings& settings, const gltf::Scene& scene);

EmitterFeatures emitterFeatures(const gltf::SceneList& scenes, const Plan& plan, bool fallback);

// Returns CompileSettings::shadowThrough for a package, or Alpha if it would change nothing: without shadows,
// and where no material has what light would pass otherwise.
package::ShadowThrough shadowThroughOf(const gltf::SceneList& scenes, const Plan& plan,
                                       const CompileSettings& settings);

// --- The layers of a package ---

// Returns the layers that CompileSettings::layers names, with those that they are computed from, in the order
// of their images: that of the table, then that of effects. Errors: "layer-effect" (a layer of an effect that
// the package lacks), "passes" (the package draws no frame). Requires plan.effects.
Result<std::vector<package::LayerInfo::Entry>> resolveLayers(const Plan& plan,
                                                             const CompileSettings& settings,
                                                             const std::string& where);

// Returns the name of a layer of a package: "depth", "reflection.radiance".
std::string layerNameOf(const package::LayerInfo::Entry& entry, const materials::MaterialModel& model);

const package::LayerInfo& infoOf(const package::LayerInfo::Entry& entry);
const materials::EffectDeclaration& declarationOf(const materials::MaterialModel& model,
                                                  package::Effect effect);
// Returns the albedo that the light of a source is divided by: that of the lobes that bring it.
const package::LayerInfo& albedoOf(package::Effect effect, const materials::MaterialModel& model);
bool demodulates(const package::LayerInfo& info);

}  // namespace glint::compiler
