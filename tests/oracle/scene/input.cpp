#include "oracle/scene/input.h"

#include "gltf/import.h"
#include "oracle/scene/picture.h"

#include <glint/session/camera.h>
#include <glint/session/scene_view.h>

#include <algorithm>
#include <charconv>

namespace glint::oracle {
namespace {

// The sun of glint render.
gltf::Light sun() {
    const LightView view = session::sunLight();
    gltf::Light light;
    light.name = "sun";
    light.color = view.intensity;
    light.direction = view.direction;
    return light;
}

bool moves(const gltf::Scene& scene) {
    return std::ranges::any_of(scene.nodes, [&](const gltf::Node& node) {
        if (node.mesh < 0) {
            return false;
        }
        const gltf::Mesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
        return std::ranges::any_of(mesh.primitives, [&](const gltf::Primitive& primitive) {
            return !primitive.targets.empty() || (node.skin >= 0 && primitive.influences.count > 0);
        });
    });
}

}  // namespace

Result<OracleInput> readOracleInput(const SceneChoice& choice, std::uint32_t width, std::uint32_t height) {
    gltf::ImportOptions options;
    options.decodeImages = true;
    options.variant = choice.variant;
    GLINT_TRY(auto scene, gltf::importScene(choice.path, options));
    if (moves(scene)) {
        return makeError("oracle-moves", choice.path.string(), "has skins or morph targets",
                         "the oracle renders rigid meshes only: use another scene");
    }
    const session::SceneViewData data = session::makeSceneView(scene);
    GLINT_TRY(const auto camera,
              session::chooseCamera(scene, data, choice.camera, static_cast<double>(width) / height));
    if (scene.lights.empty()) {
        scene.lights.push_back(sun());
    }
    return OracleInput{std::move(scene), camera.view, viewOf(camera.view, width, height)};
}

GradientSky defaultSky() {
    const SkyView sky;
    const auto toVec = [](const std::array<float, 3>& v) { return Vec3(v[0], v[1], v[2]); };
    return {toVec(sky.zenith), toVec(sky.horizon), toVec(sky.ground)};
}

Result<ImageSize> parseSize(const std::string& text) {
    constexpr std::uint32_t kMost = 4096;
    ImageSize size;
    const char* const end = text.data() + text.size();
    const auto [across, widthError] = std::from_chars(text.data(), end, size.width);
    const bool between = widthError == std::errc() && across != end && *across == 'x';
    const auto [last, heightError] = between ? std::from_chars(across + 1, end, size.height)
                                             : std::from_chars_result{end, std::errc::invalid_argument};
    const auto fits = [](std::uint32_t pixels) { return pixels >= 1 && pixels <= kMost; };
    if (heightError != std::errc() || last != end || !fits(size.width) || !fits(size.height)) {
        return makeError("oracle-size", "", "\"" + text + "\" is no size",
                         "give WxH, 1 to 4096 pixels each way");
    }
    return size;
}

}  // namespace glint::oracle
