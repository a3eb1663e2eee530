#include "render/layered_scene.h"

#include "support/must.h"

#include <glint/session/camera.h>
#include <glint/session/scene_view.h>

#include <utility>

namespace glint::testing {

LayerSet::LayerSet(Renderer& renderer) {
    for (const Renderer::LayerImage& layer : renderer.layers()) {
        LayerValues values = must(renderer.readLayer(layer.name));
        width = values.width;
        height = values.height;
        layers_.emplace(layer.name, std::move(values));
    }
}

const LayerValues& LayerSet::find(const std::string& layer) const {
    static const LayerValues kNone;
    const auto found = layers_.find(layer);
    if (found == layers_.end()) {
        ADD_FAILURE() << "there is no layer " << layer;
        return kNone;
    }
    return found->second;
}

float LayerSet::at(const std::string& layer, std::size_t pixel, std::size_t component) const {
    const LayerValues& values = find(layer);
    const std::size_t index = pixel * values.components + component;
    return index < values.reals.size() ? values.reals[index] : 0.0F;
}

std::uint32_t LayerSet::integer(const std::string& layer, std::size_t pixel) const {
    const LayerValues& values = find(layer);
    return pixel < values.integers.size() ? values.integers[pixel] : 0U;
}

double LayerSet::sum(const std::string& layer) const {
    double sum = 0.0;
    for (const float value : find(layer).reals) {
        sum += value;
    }
    return sum;
}

LayeredScene::LayeredScene(const gltf::Scene& posed, const compiler::CompileSettings& settings,
                           std::uint32_t width, std::uint32_t height)
    : PosedScene(posed, std::make_shared<const LoadedScene>(posed, settings)),
      aspect_(static_cast<double>(width) / height) {
    RendererOptions options;
    options.width = width;
    options.height = height;
    options.accumulate = false;
    renderer_ = makeRenderer(options);
}

LinearImage LayeredScene::render() {
    update();
    frame.camera = must(session::sceneCamera(scene, 0, aspect_));
    return drawn(*renderer_, frame);
}

}  // namespace glint::testing
