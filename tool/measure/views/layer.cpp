// Pictures of layers.
#include "image/text.h"
#include "image/tone.h"

#include <glint/measure/layer_view.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace glint::measure {

namespace {

// Numbers from here on stand for no number: no surface, no ray, a ray that left the scene.
constexpr std::uint32_t kNoNumbers = 0xFFFFFFFD;
// The greatest half float stands for no distance and for no texture.
constexpr float kNoReal = 65504.0F;
constexpr std::uint32_t kMarkNothing = 0xFFFFFF00;
constexpr std::uint32_t kMarkBroken = 0xFFFFFF01;

// Shows the only layer of the input, one value after the other.
void showLayer(const ViewInput& input, ViewValues& values) {
    const auto& [name, layer] = *input.layers.begin();
    const bool counts = package::findLayer(name)->mean == package::LayerMean::Sum;
    values.categories = {{kMarkNothing, {"none", {100, 100, 100}}},
                         {kMarkBroken, {"not finite", {255, 0, 255}}}};
    for (const std::uint32_t number : layer.integers) {
        const bool isNothing = number >= kNoNumbers;
        values.numbers.push_back(number);
        values.marks.push_back(isNothing ? kMarkNothing : counts ? ViewValues::kNumber : number);
        if (!isNothing && !counts) {
            values.categories.try_emplace(number,
                                          ViewCategory{std::to_string(number), image::categoryColor(number)});
        }
    }
    for (const float real : layer.reals) {
        values.numbers.push_back(real);
        values.marks.push_back(!std::isfinite(real) ? kMarkBroken
                               : real == kNoReal    ? kMarkNothing
                                                    : ViewValues::kNumber);
    }
}

// A row for each layer, in the order of their table.
const ViewInfo& infoOfLayer(const package::LayerInfo& layer) {
    static const std::vector<ViewInfo> kLayers = [] {
        std::vector<ViewInfo> infos;
        for (const package::LayerInfo& one : package::layerTable()) {
            const bool isNumber =
                one.format == package::LayerFormat::Integer && one.mean != package::LayerMean::Sum;
            infos.push_back({.name = one.name,
                             .what = one.what,
                             .scale = isNumber ? ViewScale::Categories : ViewScale::Linear,
                             .unit = {},
                             .layers = {one.name},
                             .evaluate = showLayer});
        }
        return infos;
    }();
    return *std::ranges::find(kLayers, layer.name, &ViewInfo::name);
}

image::Color8 colorOfPixel(const package::LayerInfo& info, const float* value, std::size_t channels,
                           const std::array<double, 2>& scale, double exposure) {
    if (info.channels == "RGB") {
        const bool isLight = info.format == package::LayerFormat::Float4;
        return image::toDisplay({value[0], value[1], value[2]}, isLight ? exposure : 0.0);
    }
    image::Color8 color{};
    for (std::size_t i = 0; i < std::min<std::size_t>(channels, 3); ++i) {
        const double share = (static_cast<double>(value[i]) - scale[0]) / (scale[1] - scale[0]);
        color[i] = std::isfinite(share)
                       ? static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(share, 0.0, 1.0)))
                       : std::uint8_t{0};
    }
    return color;
}

}  // namespace

Result<View> makeLayerView(std::string_view name, Renderer& renderer, double exposure) {
    GLINT_TRY(auto values, renderer.readLayer(name));
    const std::vector<LayerImage> images = renderer.layers();
    const package::LayerInfo& info = *std::ranges::find(images, name, &LayerImage::name)->info;
    ViewChoice choice{&infoOfLayer(info), ""};
    if (package::hasSources(info)) {
        choice.source = name.substr(0, name.find('.'));
    }
    const std::size_t channels = info.channels.size();
    const std::uint32_t width = values.width;
    const std::uint32_t height = values.height;
    const std::uint32_t components = values.components;
    const std::vector<float> pixels = values.reals;
    if (values.integers.empty()) {
        // Components beyond the channels are 0 and would count.
        std::vector<float> packed;
        packed.reserve(std::size_t{width} * height * channels);
        for (std::size_t i = 0; i < pixels.size(); i += components) {
            packed.insert(packed.end(), pixels.begin() + static_cast<std::ptrdiff_t>(i),
                          pixels.begin() + static_cast<std::ptrdiff_t>(i + channels));
        }
        values.reals = std::move(packed);
    }
    ViewInput input;
    input.width = width;
    input.height = height;
    input.layers.emplace(std::string(info.name), std::move(values));
    View view = colorView(choice, input);
    if (channels == 1) {
        return view;
    }
    std::array<double, 2>& scale = view.statistics.scale;
    if (scale[0] < 0.0) {
        const double most = std::max(-scale[0], scale[1]);
        scale = {-most, most};
    }
    scale[1] = std::max(scale[1], scale[0] + 1e-30);
    view.picture.pixels.clear();
    for (std::size_t i = 0; i < pixels.size(); i += components) {
        view.picture.pixels.push_back(colorOfPixel(info, &pixels[i], channels, scale, exposure));
    }
    return view;
}

}  // namespace glint::measure
