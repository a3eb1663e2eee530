#include "oracle/device.h"

#include <cstdlib>

namespace glint::oracle {
namespace {

std::array<float, 3> toFloats(const Vec3& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace

std::uint32_t samplesOf(std::uint32_t samples) {
    const char* factor = std::getenv("GLINT_ORACLE_SAMPLES");
    return factor == nullptr ? samples : samples * static_cast<std::uint32_t>(std::atoi(factor));
}

testing::RenderSetup setupOf(const gltf::Scene& scene, std::uint32_t width, std::uint32_t height,
                             std::uint32_t samples, const GradientSky& sky) {
    testing::RenderSetup setup = testing::defaultSetup(scene, width, height);
    setup.samples = samplesOf(samples);
    setup.frame.sky = {toFloats(sky.zenith), toFloats(sky.horizon), toFloats(sky.ground)};
    return setup;
}

LinearImage renderEffect(const gltf::Scene& scene, const EffectOptions& options, testing::RenderSetup setup) {
    compiler::CompileSettings settings;
    settings.effects = {false, options.effects, options.maxRoughness};
    settings.energyCompensation = options.energyCompensation;
    settings.sizedLights = options.findsLights ? compiler::SizedLights::On : compiler::SizedLights::Off;
    const testing::LoadedScene loaded(scene, settings, [&](session::SceneViewData& data) {
        for (LightView& light : data.lights) {
            const bool sun = light.type == LightView::Type::Directional;
            light.size = static_cast<float>(sun ? 0.5 * options.lights.sunDiameter : options.lights.radius);
        }
    });
    if (options.occlusion.radius > 0.0) {
        setup.frame.occlusionRadius = static_cast<float>(options.occlusion.radius);
    }
    setup.frame.occlusionFalloff = options.occlusion.linear;
    setup.frame.occlusionSamples = options.occlusionRays;
    setup.frame.shadowSamples = options.shadowRays;
    setup.frame.maxReflectionRoughness = options.maxRoughness;
    return loaded.render(package::kStrategyVisibility, setup);
}

}  // namespace glint::oracle
