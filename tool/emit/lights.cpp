#include "emit/lights.h"

#include "emit/host.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

namespace glint::compiler {

Result<std::uint32_t> lightSamplesOf(std::span<const gltf::Scene> scenes, const CompileSettings& settings) {
    Result<std::vector<std::string>> replaced = replacedHostFiles(settings.host);
    if (!replaced) {
        return replaced.error();
    }
    const bool ofHost = settings.passes == package::Passes::Steps ||
                        std::ranges::find(*replaced, "lights.glsl") != replaced->end();
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
    const auto tooMany = [&](const gltf::Scene& scene) {
        return scene.lights.size() + (settings.addsLight ? 1 : 0) > kFewLights;
    };
    return !ofHost && std::ranges::any_of(scenes, tooMany) ? kSamplesOfManyLights : 0U;
}

}  // namespace glint::compiler
