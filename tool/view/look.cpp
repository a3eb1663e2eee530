#include "view/look.h"

#include "settings/compile_settings.h"

#include <glint/measure/layer_view.h>

#include <algorithm>
#include <string_view>
#include <utility>

namespace glint::view {

namespace {

// "reflection.bounce-radiance.2" is the layer bounce-radiance of the source reflection.
struct LayerParts {
    std::string_view source;
    std::string_view layer;
};

LayerParts partsOf(std::string_view name) {
    const std::size_t dot = name.find('.');
    if (dot == std::string_view::npos) {
        return {"", name};
    }
    const std::string_view rest = name.substr(dot + 1);
    return {name.substr(0, dot), rest.substr(0, rest.find('.'))};
}

// Returns whether the word of the setting stands for one of the layers.
bool hasLayer(const std::vector<std::string>& names, std::string_view word) {
    return std::ranges::any_of(names, [&](const std::string& name) {
        const LayerParts parts = partsOf(name);
        return word.find('.') == std::string_view::npos ? parts.layer == word : layerWord(name) == word;
    });
}

// Returns the layers that the view needs, and those that it reads where a package may have them.
std::vector<std::string> wordsFor(const measure::ViewChoice& view, const Build& build) {
    std::vector<std::string> words;
    for (std::string& word : measure::layersFor(view)) {
        if (!word.ends_with(compiler::kOptionalLayer)) {
            words.push_back(std::move(word));
            continue;
        }
        word.pop_back();
        if (hasLayer(build.layers, word)) {
            words.push_back(std::move(word));
        }
    }
    return words;
}

std::vector<std::string> wordsFor(const Look& look, const Build& build) {
    if (look.isPicture()) {
        return {};
    }
    return look.view.empty() ? std::vector<std::string>{layerWord(look.layer)}
                             : wordsFor(*measure::parseView(look.view), build);
}

// Returns the effects whose rays a view may be about; the empty name if it is about none.
std::vector<std::string> sourcesOf(const measure::ViewInfo& view, const Build& build) {
    if (!measure::isOfRays(view)) {
        return {""};
    }
    std::vector<std::string> sources;
    for (const package::EffectInfo& effect : build.package->effects()) {
        if (effect.kind == package::EffectKind::Rays) {
            sources.emplace_back(effect.name);
        }
    }
    return sources;
}

}  // namespace

std::string layerWord(const std::string& layer) {
    const LayerParts parts = partsOf(layer);
    return parts.source.empty() ? layer : std::string(parts.source) + "." + std::string(parts.layer);
}

std::vector<Look> looksOf(const Build& build) {
    std::vector<Look> looks;
    for (const measure::ViewInfo& view : measure::viewTable()) {
        if (view.readsReference) {
            continue;
        }
        for (const std::string& source : sourcesOf(view, build)) {
            const measure::ViewChoice choice{&view, source};
            const std::vector<std::string> words = wordsFor(choice, build);
            if (std::ranges::all_of(words, [&](const auto& word) { return hasLayer(build.layers, word); })) {
                looks.push_back({choice.name(), ""});
            }
        }
    }
    for (const std::string& layer : build.layers) {
        looks.push_back({"", layer});
    }
    return looks;
}

std::string describe(const Look& look) {
    if (look.isPicture()) {
        return "the picture itself";
    }
    return std::string(look.view.empty() ? package::findLayer(partsOf(look.layer).layer)->what
                                         : measure::parseView(look.view)->info->what);
}

bool askFor(const Look& look, const Build& build, compiler::Settings& settings) {
    std::vector<std::string> there;
    for (const package::PackageLayer& layer : build.package->layers()) {
        there.push_back(layer.name);
    }
    bool isNew = false;
    for (std::string& word : wordsFor(look, build)) {
        std::vector<std::string>& layers = settings.compile.layers;
        if (!hasLayer(there, word) && std::ranges::find(layers, word) == layers.end()) {
            layers.push_back(std::move(word));
            isNew = true;
        }
    }
    return isNew;
}

Result<measure::View> makeLook(const Look& look, Picture& picture, double exposure) {
    if (look.view.empty()) {
        return measure::makeLayerView(look.layer, picture.renderer(), exposure);
    }
    measure::ViewInput input;
    input.samples = picture.samples();
    input.dispatchesCases = package::infoOf(*picture.settings().strategy).dispatchesCases;
    input.package = picture.build().package.get();
    input.scene = picture.data().packageScene;
    for (const materials::Material& material : picture.scene().materials) {
        input.materialNames.push_back(material.name);
        input.model = &material.model();
    }
    return measure::makeView(*measure::parseView(look.view), picture.renderer(), std::move(input));
}

Result<image::ExrLayer> layerForFile(const Look& look, Picture& picture) {
    GLINT_TRY(auto values, picture.renderer().readLayer(look.layer));
    const package::LayerInfo& info = *package::findLayer(partsOf(look.layer).layer);
    return image::ExrLayer{look.layer, std::string(info.channels), info.format == package::LayerFormat::Half4,
                           std::move(values)};
}

}  // namespace glint::view
