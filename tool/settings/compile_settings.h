// The settings with which a package is compiled.
#pragma once

#include "plan/effects.h"
#include "plan/plan.h"
#include "plan/strategy_choice.h"

#include <glint/package_modules.h>
#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glint::compiler {

// The choice of the level of a texture that hits read.
enum class TextureLod : std::uint8_t {
    Cones,  // by the width of a ray cone
    Mip0    // always the finest level
};
inline constexpr Named<TextureLod> kTextureLodNames[] = {
    {TextureLod::Cones, "cones", "by the footprint of the ray"},
    {TextureLod::Mip0, "mip0", "the finest"},
};
constexpr std::span<const Named<TextureLod>> namesOf(TextureLod /*type*/) {
    return kTextureLodNames;
}

// The choice whether triangles that emit light are lights.
enum class EmissiveLights : std::uint8_t { Auto, Off, On };
inline constexpr Named<EmissiveLights> kEmissiveLightsNames[] = {
    {EmissiveLights::Auto, "auto", "in packages for several bounces, with up to 262,144 such triangles"},
    {EmissiveLights::Off, "off", "rays find them by chance"},
    {EmissiveLights::On, "on", "surfaces send shadow rays to them"},
};
constexpr std::span<const Named<EmissiveLights>> namesOf(EmissiveLights /*type*/) {
    return kEmissiveLightsNames;
}

// The choice whether the sky is a light that surfaces sample.
enum class SkyLight : std::uint8_t { Auto, Off, On };
inline constexpr Named<SkyLight> kSkyLightNames[] = {
    {SkyLight::Auto, "auto", "in packages for several bounces with the effects shadow and indirect-diffuse"},
    {SkyLight::Off, "off", "rays find its light, and without occlusion it stands in for further ones"},
    {SkyLight::On, "on", "surfaces send shadow rays to it"},
};
constexpr std::span<const Named<SkyLight>> namesOf(SkyLight /*type*/) {
    return kSkyLightNames;
}

// The choice whether rays of lobes find area lights (LightView::size).
enum class SizedLights : std::uint8_t { Auto, Off, On };
inline constexpr Named<SizedLights> kSizedLightsNames[] = {
    {SizedLights::Auto, "auto",
     "in packages for several bounces with the effect shadow, if --light-radius or --sun-angle is given"},
    {SizedLights::Off, "off", "light samples alone find them, and mirrors do not show them"},
    {SizedLights::On, "on", "rays of lobes find them, too, with multiple importance sampling"},
};
constexpr std::span<const Named<SizedLights>> namesOf(SizedLights /*type*/) {
    return kSizedLightsNames;
}

struct CompileSettings {
    std::uint32_t strategies = package::kDefaultStrategies;
    std::uint32_t tracers = package::kTracerRayQuery;
    package::ShadowPlacement shadows = package::ShadowPlacement::Inline;
    package::ShadowThrough shadowThrough = package::ShadowThrough::Alpha;
    package::HitRecordFormat hitRecord = package::HitRecordFormat::Full;
    package::SampleRecordFormat sampleRecord = package::SampleRecordFormat::Full;
    std::uint32_t maxBounces = 1;  // of paths: 1 to package::kMaxBounces
    package::Passes passes = package::Passes::Frame;
    package::HitAnswer answer = package::HitAnswer::Radiance;
    package::Bindings bindings{};  // Passes::Steps alone may have other than the default's
    bool environmentMap = false;   // Rays that leave the scene read an environment map instead of a gradient.
    // With this, strategies that shade a hit where they find it read the positions of its triangle from the
    // acceleration structure instead of the vertex buffer: with ray queries, or in a pipeline of their own.
    bool positionFetch = false;
    PlanOptions plan;
    EffectRequest effects{false, builtinEffects({"shadow", "reflection"})};
    // True if the renderer adds a light to those of the scenes. --effects auto takes that into account.
    bool addsLight = false;
    // True if the renderer gives lights a size. --sized-lights=auto takes that into account.
    bool sizesLights = false;
    // How many lights a surface chooses by a hierarchy; 0: it takes all. No value leaves it to the number of
    // lights (resolve/light.h).
    std::optional<std::uint32_t> lightSamples{};
    EmissiveLights emissiveLights = EmissiveLights::Auto;
    SkyLight skyLight = SkyLight::Auto;
    SizedLights sizedLights = SizedLights::Auto;
    bool energyCompensation = true;  // Compensates light that bounces between microfacets more than once.
    TextureLod textureLod = TextureLod::Cones;
    // True if planning reads the contents of textures (gltf::ImportOptions::trustTextures). Packages with a
    // fallback or a host do not, because their textures may change at run time.
    bool trustTextures = true;
    bool textureLevels = false;         // shaders note the finest level that they read of each texture
    std::vector<std::string> layers{};  // images beside the picture, as --layers names them
    package::ShadingPrecision precision = package::ShadingPrecision::Single;
    int jobs = 0;  // threads; 0 means one for each core
    // Gets how many modules and parts are done, and how many there are to do. Any thread may call it, one at
    // a time.
    std::function<void(std::size_t done, std::size_t all)> progress{};
    bool emitHeader = true;     // glint_tables.h
    bool emitGlsl = false;      // writes the flattened sources, in glsl/
    bool emitLibrary = false;   // writes shading as functions in GLSL, in library/
    bool emitLinkable = false;  // writes the same functions as a SPIR-V module that can be linked, there
    bool debugInfo = false;     // keeps names in the SPIR-V
    // A folder with files that stand in for those of shaders/host; empty: none (resolve/host.h).
    std::string host{};
    // The choice that led to `strategies`, for the manifest. Empty if the user named the strategies.
    std::optional<StrategyAdvice> strategyChoice{};
    // The folder in which `glint compile-module` left the modules. If it is empty, modules are compiled here.
    std::filesystem::path modules{};
};

// Found by their arguments from other namespaces.
using glint::nameOf;

}  // namespace glint::compiler
