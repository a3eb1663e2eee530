#include "emit/lights.h"

#include "emit/effects.h"
#include "emit/host.h"

#include <fmt/format.h>

#include <algorithm>
#include <interop/lights.h>
#include <string>
#include <string_view>
#include <vector>

namespace glint::compiler {

namespace {

// The files of a host that decide where emissive triangles and their materials are, those that decide what
// the sky is and who samples it, and that of punctual lights.
constexpr std::string_view kEmitterFiles[] = {"lights.glsl", "geometry.glsl", "material.glsl"};
constexpr std::string_view kSkyFiles[] = {"lights.glsl", "sky.glsl"};
constexpr std::string_view kLightFiles[] = {"lights.glsl"};

// The effects of a package with a light.
package::EffectSet effectsOfLit(const gltf::SceneList& scenes, CompileSettings settings) {
    settings.addsLight = true;
    return planEffects(scenes, settings).effects;
}

// Whether rays bring the sky's light, and that of surfaces in front of it, to surfaces that scatter it. Where
// none do, the ambient term stands for both: samples of the sky would replace it by the first alone.
bool tracesScattered(std::span<const gltf::Scene> scenes, const CompileSettings& settings) {
    const gltf::SceneList list(scenes);
    if (list.materials().empty()) {
        return false;
    }
    const std::uint32_t rays = effectsOfLit(list, settings).rays;
    const std::vector<materials::EffectDeclaration>& declared = list.materials().front().model().effects;
    return std::ranges::any_of(declared, [&](const materials::EffectDeclaration& effect) {
        return (rays & materials::findEffect(declared, effect.name)) != 0 && !effect.refines.empty();
    });
}

// Returns why the package can't have lights that Glint samples by `files` of the host, or an empty text.
// `whose` says what these are.
Result<std::string> hindrance(std::span<const gltf::Scene> scenes, const CompileSettings& settings,
                              std::span<const std::string_view> files, std::string_view whose) {
    GLINT_TRY(auto replaced, replacedHostFiles(settings.host));
    const bool ofHost =
        settings.passes == package::Passes::Steps || std::ranges::any_of(files, [&](std::string_view file) {
            return std::ranges::find(replaced, file) != replaced.end();
        });
    if (ofHost) {
        return fmt::format("{} are the host's", whose);
    }
    return std::string(effectsOfLit(gltf::SceneList(scenes), settings).lights != 0
                           ? ""
                           : "the package has no effect shadow");
}

}  // namespace

std::size_t countEmitters(const gltf::Scene& scene) {
    const gltf::SceneList list({&scene, 1});
    std::vector<std::size_t> ofMeshes(scene.meshes.size());
    for (const materials::PrimitiveInputs& primitive : list.primitives()) {
        if (isEmitter(list.materials()[static_cast<std::size_t>(primitive.material)], primitive)) {
            const auto mesh = static_cast<std::size_t>(primitive.mesh);
            ofMeshes[mesh] +=
                scene.meshes[mesh].primitives[static_cast<std::size_t>(primitive.primitive)].indices.size() /
                3;
        }
    }
    std::size_t count = 0;
    for (const gltf::Node& node : scene.nodes) {
        if (node.mesh >= 0 && node.canShow) {
            const std::size_t copies =
                node.instancing < 0 ? 1 : scene.instancings[static_cast<std::size_t>(node.instancing)].count;
            count += copies * ofMeshes[static_cast<std::size_t>(node.mesh)];
        }
    }
    return count;
}

LightCounts countLights(const gltf::Scene& scene, const CompileSettings& settings) {
    const auto hasPosition = [](const gltf::Light& light) {
        return light.type != gltf::LightType::Directional;
    };
    LightCounts counts;
    counts.positions = static_cast<std::size_t>(std::ranges::count_if(scene.lights, hasPosition));
    counts.emitters = settings.emissiveLights == EmissiveLights::On ? countEmitters(scene) : 0;
    counts.areApart = counts.emitters > 0 && counts.positions <= gpu::kMostLightsApart;
    return counts;
}

Result<EmissiveLights> emissiveLightsOf(std::span<const gltf::Scene> scenes,
                                        const CompileSettings& settings) {
    const bool isOn = settings.emissiveLights == EmissiveLights::On;
    if (settings.emissiveLights == EmissiveLights::Off || (!isOn && settings.maxBounces == 1)) {
        return EmissiveLights::Off;
    }
    std::size_t most = 0;
    for (const gltf::Scene& scene : scenes) {
        most = std::max(most, countEmitters(scene));
    }
    if (most == 0 || (!isOn && most > kMostEmitters)) {
        return EmissiveLights::Off;
    }
    GLINT_TRY(const auto why, hindrance(scenes, settings, kEmitterFiles, "the lights or the geometry"));
    if (isOn && !why.empty()) {
        return makeError("emissive-lights", "",
                         fmt::format("--emissive-lights needs shadow rays of Glint's own: {}", why),
                         "add the effect shadow, or leave out --emissive-lights");
    }
    return why.empty() ? EmissiveLights::On : EmissiveLights::Off;
}

Result<SkyLight> skyLightOf(std::span<const gltf::Scene> scenes, const CompileSettings& settings) {
    const bool isOn = settings.skyLight == SkyLight::On;
    if (settings.skyLight == SkyLight::Off ||
        (!isOn && (settings.maxBounces == 1 || !tracesScattered(scenes, settings)))) {
        return SkyLight::Off;
    }
    GLINT_TRY(const auto why, hindrance(scenes, settings, kSkyFiles, "the lights or the sky"));
    if (isOn && !why.empty()) {
        return makeError("sky-light", "",
                         fmt::format("--sky-light needs shadow rays and a sky of Glint's own: {}", why),
                         "add the effect shadow, or leave out --sky-light");
    }
    return why.empty() ? SkyLight::On : SkyLight::Off;
}

Result<SizedLights> sizedLightsOf(std::span<const gltf::Scene> scenes, const CompileSettings& settings) {
    const bool isOn = settings.sizedLights == SizedLights::On;
    if (settings.sizedLights == SizedLights::Off ||
        (!isOn && (settings.maxBounces == 1 || !settings.sizesLights))) {
        return SizedLights::Off;
    }
    GLINT_TRY(const auto why, hindrance(scenes, settings, kLightFiles, "the lights"));
    if (isOn && !why.empty()) {
        return makeError("sized-lights", "",
                         fmt::format("--sized-lights needs shadow rays of Glint's own: {}", why),
                         "add the effect shadow, or leave out --sized-lights");
    }
    return why.empty() ? SizedLights::On : SizedLights::Off;
}

EmitterFeatures emitterFeatures(const gltf::SceneList& scenes, const Plan& plan, bool fallback) {
    const materials::MaterialModel& model = *plan.model;
    materials::FeatureMask covers = 0;
    for (const materials::FeatureCode& code : model.code) {
        covers |= code.coversEmission ? model.features[static_cast<std::size_t>(code.feature)].mask() : 0;
    }
    std::vector<materials::FeatureMask> masks;
    EmitterFeatures result;
    for (std::size_t i = 0; i < scenes.primitives().size(); ++i) {
        const materials::PrimitiveInputs& primitive = scenes.primitives()[i];
        if (isEmitter(scenes.materials()[static_cast<std::size_t>(primitive.material)], primitive)) {
            masks.push_back(plan.primaryMaskOfPrimitive[i]);
            result.coveredByLayers = result.coveredByLayers || (masks.back() & covers) != 0;
        }
    }
    if (fallback) {
        masks = {0, plan.primaryAlways | plan.primarySometimes};
        result.coveredByLayers = (masks.back() & covers) != 0;
    }
    result.read = covers;
    for (const char* const name :
         {"emissiveTexture", "emissiveStrength", "texCoord0", "texCoord1", "textureTransform"}) {
        result.read |= model.mask(name);
    }
    if (result.coveredByLayers) {
        result.read = ~materials::FeatureMask{0};
    }
    materials::FeatureMask any = 0;
    result.always = masks.empty() ? 0 : result.read;
    for (const materials::FeatureMask mask : masks) {
        any |= mask & result.read;
        result.always &= mask;
    }
    result.sometimes = any & ~result.always;
    return result;
}

Result<std::uint32_t> lightSamplesOf(std::span<const gltf::Scene> scenes, const CompileSettings& settings) {
    GLINT_TRY(auto replaced, replacedHostFiles(settings.host));
    const bool ofHost = settings.passes == package::Passes::Steps ||
                        std::ranges::find(replaced, "lights.glsl") != replaced.end();
    if (settings.lightSamples) {
        if (ofHost && *settings.lightSamples > 0) {
            return makeError(
                "lights", "",
                fmt::format("--lights {} needs the hierarchy of Glint's renderer, and the lights are "
                            "the host's",
                            *settings.lightSamples),
                "leave out --lights, and let the host's hostLight() choose");
        }
        return *settings.lightSamples;
    }
    std::uint32_t samples = 0;
    if (!ofHost) {
        for (const gltf::Scene& scene : scenes) {
            samples = std::max(samples, lightSamplesFor(countLights(scene, settings)));
        }
    }
    return samples;
}

package::ShadowThrough shadowThroughOf(const gltf::SceneList& scenes, const Plan& plan,
                                       const CompileSettings& settings) {
    using enum package::ShadowThrough;
    if (settings.shadowThrough == Alpha || plan.effects.effects.lights == 0) {
        return Alpha;
    }
    const bool passesBlended = settings.plan.keys.alpha == package::AlphaPolicy::Stochastic;
    const auto asked = [&](const materials::PrimitiveInputs& primitive) {
        const materials::Material& material =
            scenes.materials()[static_cast<std::size_t>(primitive.material)];
        return (passesBlended && material.alphaMode == materials::AlphaMode::Blend) ||
               (settings.shadowThrough == Glass && passesLight(material, primitive));
    };
    return std::ranges::any_of(scenes.primitives(), asked) ? settings.shadowThrough : Alpha;
}

}  // namespace glint::compiler
