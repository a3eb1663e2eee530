// Makes views of a renderer's frames.
#include "base/fields.h"
#include "image/tone.h"
#include "settings/settings.h"

#include <glint/measure/views.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace glint::measure {

using base::output;

namespace {

constexpr std::size_t kViewBins = 16;

// Returns the place of a number on the scale, from 0 to 1.
double shareOf(double value, ViewScale scale, const std::array<double, 2>& ends) {
    const auto place = [scale](double number) {
        return scale == ViewScale::Logarithmic ? std::log(std::max(number, 1e-300)) : number;
    };
    const double length = place(ends[1]) - place(ends[0]);
    return length > 0.0 ? std::clamp((place(value) - place(ends[0])) / length, 0.0, 1.0) : 0.0;
}

double quantile(const std::vector<double>& sorted, double share) {
    return sorted[static_cast<std::size_t>(std::lround(share * static_cast<double>(sorted.size() - 1)))];
}

void measureNumbers(const ViewValues& values, ViewStatistics& statistics) {
    std::vector<double> sorted;
    double sum = 0.0;
    for (std::size_t i = 0; i < values.marks.size(); ++i) {
        if (values.marks[i] == ViewValues::kNumber) {
            sorted.push_back(values.numbers[i]);
            sum += values.numbers[i];
        }
    }
    statistics.numbers = sorted.size();
    if (sorted.empty()) {
        return;
    }
    std::ranges::sort(sorted);
    statistics.least = sorted.front();
    statistics.greatest = sorted.back();
    statistics.mean = sum / static_cast<double>(sorted.size());
    statistics.median = quantile(sorted, 0.5);
    statistics.percentile99 = quantile(sorted, 0.99);
    statistics.percentileHalf = quantile(sorted, 0.005);
    statistics.percentile99Half = quantile(sorted, 0.995);
}

void countCategories(const ViewValues& values, ViewStatistics& statistics) {
    std::map<std::uint32_t, std::uint64_t> pixels;
    for (const std::uint32_t mark : values.marks) {
        ++pixels[mark];
    }
    pixels.erase(ViewValues::kNumber);
    for (const auto& [mark, count] : pixels) {
        statistics.categories.push_back({values.categories.at(mark), count});
    }
    std::ranges::stable_sort(statistics.categories, std::greater(), &ViewStatistics::Category::pixels);
}

// A few pixels far away from all others would leave these a single colour, so they share the colour of an
// end.
std::array<double, 2> scaleOf(ViewScale scale, const ViewStatistics& statistics) {
    // Counts keep their few large values, which people look for; a clock is off by more when its thread has
    // to wait.
    constexpr double kFar = 2.0;
    constexpr double kFarOfCounts = 16.0;
    const double low = statistics.percentileHalf;
    const double high = statistics.percentile99Half;
    const bool isLogarithmic = scale == ViewScale::Logarithmic;
    const bool isFarAbove = isLogarithmic
                                ? statistics.greatest > kFar * high
                                : statistics.greatest - low > kFarOfCounts * (high - low) && high > low;
    const double last = isFarAbove ? high : statistics.greatest;
    switch (scale) {
        case ViewScale::FromZero:
            return {std::min(0.0, statistics.least), last};
        case ViewScale::FromOne:
            return {std::min(1.0, statistics.least), last};
        case ViewScale::Logarithmic:
            return {kFar * statistics.least < low ? low : statistics.least, last};
        default:
            return {statistics.least, last};
    }
}

Diagnostic missingLayer(const ViewChoice& choice, std::string_view layer) {
    return makeError(
        "view-layer", "",
        fmt::format("the view {} reads the layer {}, which the package lacks", choice.name(), layer),
        fmt::format("compile the package with --layers {}", layer));
}

// Returns the effect that the view is about: the named one, or the first with rays.
Result<package::Effect> effectOf(const ViewChoice& choice, const Package& package) {
    std::vector<std::string_view> known;
    for (const package::EffectInfo& effect : package.effects()) {
        if (effect.kind == package::EffectInfo::Kind::Rays) {
            if (choice.source.empty() || choice.source == effect.name) {
                return effect.effect;
            }
            known.push_back(effect.name);
        }
    }
    return makeError(
        "view-source", "",
        choice.source.empty()
            ? fmt::format("the view {} is about rays, and the package has no effect with rays", choice.name())
            : fmt::format("the package has no effect {} with rays, so there is no view {}", choice.source,
                          choice.name()),
        "--effects decides which effects the package has");
}

// Reads the layer ViewInfo::everySource of each effect with rays.
Status readEverySource(const ViewChoice& choice, Renderer& renderer, ViewInput& input) {
    const std::string_view wanted = choice.info->everySource;
    if (wanted.empty()) {
        return okStatus();
    }
    for (const package::EffectInfo& effect : input.package->effects()) {
        if (effect.kind != package::EffectInfo::Kind::Rays) {
            continue;
        }
        const std::string name = package::layerName(*package::findLayer(wanted), effect.name, 0);
        if (std::ranges::find(input.package->layers(), name, &package::PackageLayer::name) ==
            input.package->layers().end()) {
            return missingLayer(choice, name);
        }
        GLINT_TRY(auto values, renderer.readLayer(name));
        input.layers.insert_or_assign(name, std::move(values));
    }
    return okStatus();
}

}  // namespace

std::string ViewChoice::name() const {
    return source.empty() ? std::string(info->name) : source + "." + std::string(info->name);
}

std::optional<ViewChoice> parseView(std::string_view text) {
    const std::size_t dot = text.find('.');
    const bool hasSource = dot != std::string_view::npos;
    const ViewInfo* const info = findView(hasSource ? text.substr(dot + 1) : text);
    if (info == nullptr || (hasSource && (!isOfRays(*info) || dot == 0))) {
        return std::nullopt;
    }
    return ViewChoice{info, std::string(text.substr(0, hasSource ? dot : 0))};
}

std::vector<std::string> layersFor(const ViewChoice& view) {
    std::vector<std::string> words;
    for (const std::string_view layer : view.info->layers) {
        const bool ofSource = package::hasSources(*package::findLayer(layer)) && !view.source.empty();
        words.push_back(ofSource ? view.source + "." + std::string(layer) : std::string(layer));
    }
    if (!view.info->everySource.empty()) {
        words.push_back(std::string(view.info->everySource) + compiler::kOptionalLayer);
    }
    return words;
}

View colorView(const ViewChoice& choice, const ViewInput& input, std::optional<std::array<double, 2>> range) {
    ViewValues values;
    choice.info->evaluate(input, values);
    View view;
    view.choice = choice;
    ViewStatistics& statistics = view.statistics;
    measureNumbers(values, statistics);
    countCategories(values, statistics);
    const ViewScale scale = choice.info->scale;
    statistics.scale = range.value_or(scaleOf(scale, statistics));
    if (scale != ViewScale::Categories) {
        statistics.histogram.assign(kViewBins, 0);
    }
    view.picture = {input.width, input.height, {}};
    view.picture.pixels.reserve(values.marks.size());
    for (std::size_t i = 0; i < values.marks.size(); ++i) {
        if (values.marks[i] != ViewValues::kNumber) {
            view.picture.pixels.push_back(values.categories.at(values.marks[i]).color);
            continue;
        }
        const double share = shareOf(values.numbers[i], scale, statistics.scale);
        view.picture.pixels.push_back(image::quantityColor(share));
        const auto bin = static_cast<std::size_t>(share * kViewBins);
        ++statistics.histogram[std::min(bin, kViewBins - 1)];
    }
    return view;
}

Result<View> makeView(const ViewChoice& choice, Renderer& renderer, ViewInput input,
                      std::optional<std::array<double, 2>> range) {
    const Package& package = *input.package;
    const bool ofRaysAlone = std::ranges::any_of(choice.info->layers, [](std::string_view layer) {
        return package::findLayer(layer)->subject == package::LayerInfo::Subject::Ray;
    });
    package::Effect effect = 0;
    if (ofRaysAlone) {
        GLINT_TRY(effect, effectOf(choice, package));
    }
    for (const std::string_view wanted : choice.info->layers) {
        const package::LayerInfo& info = *package::findLayer(wanted);
        const auto layer = std::ranges::find_if(package.layers(), [&](const package::PackageLayer& one) {
            return one.info == &info && (!package::hasSources(info) || one.effect == effect);
        });
        if (layer == package.layers().end()) {
            return missingLayer(choice, wanted);
        }
        GLINT_TRY(auto values, renderer.readLayer(layer->name));
        input.width = values.width;
        input.height = values.height;
        input.layers.insert_or_assign(std::string(wanted), std::move(values));
    }
    GLINT_TRY_DO(readEverySource(choice, renderer, input));
    if (choice.info->readsReference) {
        if (input.picture == nullptr || input.reference == nullptr) {
            return makeError(
                "view-reference", "",
                fmt::format("the view {} compares with another picture, and there is none", choice.name()),
                "give one by --view-reference FILE");
        }
        if (input.picture->width != input.reference->width ||
            input.picture->height != input.reference->height) {
            return makeError(
                "view-reference", "",
                fmt::format("the reference has {}x{} pixels, and the picture {}x{}", input.reference->width,
                            input.reference->height, input.picture->width, input.picture->height),
                "render both with the same --size");
        }
        input.width = input.picture->width;
        input.height = input.picture->height;
    }
    return colorView(choice, input, range);
}

static base::Fields fieldsOf(const ViewStatistics::Category*) {
    using T = ViewStatistics::Category;
    return {output<&T::category, &ViewCategory::name>("name", "As the legend has it."),
            output("color", "In the picture, sRGB, hexadecimal.",
                   [](const T& one) {
                       const image::Color8& color = one.category.color;
                       return fmt::format("#{:02x}{:02x}{:02x}", color[0], color[1], color[2]);
                   }),
            output<&T::pixels>("pixels", "How many pixels are of it.")};
}

namespace {

// Returns nothing if no pixel has a number.
template <double ViewStatistics::*Member>
std::optional<double> number(const View& view) {
    return view.statistics.numbers > 0 ? std::optional(view.statistics.*Member) : std::nullopt;
}
template <std::size_t End>
std::optional<double> histogramEnd(const View& view) {
    return view.statistics.numbers > 0 ? std::optional(view.statistics.scale[End]) : std::nullopt;
}

}  // namespace

base::Fields fieldsOf(const View*) {
    using T = View;
    using Statistics = ViewStatistics;
    return {
        output("name", "As --view names it.", [](const T& view) { return view.choice.name(); }),
        output("what", "What it shows.", [](const T& view) { return view.choice.info->what; }),
        output("unit", "Of the numbers, or what a category is.",
               [](const T& view) { return view.choice.info->unit; }),
        output("scale", "How numbers become colours.",
               [](const T& view) {
                   constexpr std::string_view kScales[] = {"categories", "linear", "linear", "linear",
                                                           "logarithmic"};
                   return kScales[static_cast<std::size_t>(view.choice.info->scale)];
               },
               {.names = {"categories", "linear", "logarithmic"}}),
        output<&T::statistics, &Statistics::numbers>(
            "numbers", "How many pixels have a number; if none has, the next five are null."),
        output<number<&Statistics::least>>("least", "Least number."),
        output<number<&Statistics::greatest>>("greatest", "Greatest number."),
        output<number<&Statistics::mean>>("mean", "Mean of the numbers."),
        output<number<&Statistics::median>>("median", "Half of the pixels have no more."),
        output<number<&Statistics::percentile99>>("percentile99", "99 % of the pixels have no more."),
        base::group(
            "histogram", "Pixels in steps of equal length, of their logarithm if the scale is logarithmic.",
            {output<histogramEnd<0>>("from", "Where the first step begins; null without numbers."),
             output<histogramEnd<1>>("to", "Where the last step ends; null without numbers."),
             output<&T::statistics, &Statistics::histogram>("pixels", "By step; empty for categories.")}),
        output<&T::statistics, &Statistics::categories>(
            "categories", "Kinds of pixels, the most frequent first. Pixels with a number are of none.")};
}

// --- Layers ---

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
    const bool counts = package::findLayer(name)->mean == package::LayerInfo::Mean::Sum;
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
            const bool isNumber = one.format == package::LayerInfo::Format::Integer &&
                                  one.mean != package::LayerInfo::Mean::Sum;
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
        const bool isLight = info.format == package::LayerInfo::Format::Float4;
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
    const std::vector<Renderer::LayerImage> images = renderer.layers();
    const package::LayerInfo& info = *std::ranges::find(images, name, &Renderer::LayerImage::name)->info;
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
