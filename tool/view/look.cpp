#include "view/look.h"

#include "gltf/import.h"
#include "gltf/scene_list.h"
#include "image/text.h"
#include "image/tone.h"
#include "plan/plan_cost.h"
#include "settings/settings.h"

#include <glint/measure/views.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <imgui.h>
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
        if (effect.kind == package::EffectInfo::Kind::Rays) {
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
    return image::ExrLayer{look.layer, std::string(info.channels),
                           info.format == package::LayerInfo::Format::Half4, std::move(values)};
}

// --- The tab in which a view or a layer is chosen ---

namespace {

using measure::ViewScale;
using measure::ViewStatistics;

constexpr std::size_t kMostCategories = 40;  // the most that the legend lists

ImU32 packed(const image::Color8& color) {
    return IM_COL32(color[0], color[1], color[2], 255);
}

double percentOf(std::uint64_t pixels, const measure::View& view) {
    const double all = static_cast<double>(view.picture.width) * view.picture.height;
    return all > 0.0 ? 100.0 * static_cast<double>(pixels) / all : 0.0;
}

// Returns whether the look shows the channels of vectors, which have no colour of their own.
bool showsChannels(const measure::View& view, const Look& look) {
    return look.view.empty() && view.choice.info->scale != ViewScale::Categories &&
           package::findLayer(view.choice.info->name)->channels.size() > 1;
}

// The colours from least to greatest, as shares of a bar.
void drawScale(const measure::View& view) {
    const ViewStatistics& statistics = view.statistics;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    const float height = ImGui::GetFontSize();
    constexpr int kSteps = 64;
    for (int i = 0; i < kSteps; ++i) {
        const float left = at.x + width * static_cast<float>(i) / kSteps;
        const float right = at.x + width * static_cast<float>(i + 1) / kSteps;
        ImGui::GetWindowDrawList()->AddRectFilled({left, at.y}, {right, at.y + height},
                                                  packed(image::quantityColor((i + 0.5) / kSteps)));
    }
    ImGui::Dummy({width, height});
    const double first = statistics.scale[0];
    const double last = statistics.scale[1];
    const bool isLogarithmic = view.choice.info->scale == ViewScale::Logarithmic;
    const std::string middle =
        fmt::format("{:.4g}", isLogarithmic ? std::sqrt(first * last) : (first + last) / 2.0);
    const std::string greatest = fmt::format("{:.4g} {}", last, view.choice.info->unit);
    const float left = ImGui::GetCursorPosX();
    ImGui::TextUnformatted(fmt::format("{:.4g}", first).c_str());
    ImGui::SameLine(left + 0.5F * (width - ImGui::CalcTextSize(middle.c_str()).x));
    ImGui::TextUnformatted(middle.c_str());
    ImGui::SameLine(left + width - ImGui::CalcTextSize(greatest.c_str()).x);
    ImGui::TextUnformatted(greatest.c_str());
}

void drawNumbers(const measure::View& view, const Look& look) {
    const ViewStatistics& statistics = view.statistics;
    if (statistics.numbers == 0) {
        ImGui::TextDisabled("no pixel has a number");
        return;
    }
    if (showsChannels(view, look)) {
        const package::LayerInfo& layer = *package::findLayer(view.choice.info->name);
        if (layer.channels == "RGB") {
            ImGui::TextWrapped("shown as the picture is; %.4g to %.4g", statistics.least,
                               statistics.greatest);
            return;
        }
        ImGui::TextWrapped("%s as red, green, blue: black is %.4g, full is %.4g",
                           std::string(layer.channels).c_str(), statistics.scale[0], statistics.scale[1]);
        return;
    }
    drawScale(view);
    ImGui::TextWrapped("mean %.4g, median %.4g, 99 %% up to %.4g, greatest %.4g", statistics.mean,
                       statistics.median, statistics.percentile99, statistics.greatest);
}

void drawLegend(const measure::View& view, const Look& look) {
    if (view.choice.info->scale != ViewScale::Categories) {
        drawNumbers(view, look);
    }
    const std::vector<ViewStatistics::Category>& all = view.statistics.categories;
    const std::size_t count = std::min(all.size(), kMostCategories);
    for (std::size_t i = 0; i < count; ++i) {
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const float side = ImGui::GetFontSize() * 0.8F;
        ImGui::GetWindowDrawList()->AddRectFilled({at.x, at.y + 2.0F}, {at.x + side, at.y + 2.0F + side},
                                                  packed(all[i].category.color));
        ImGui::Dummy({side, side});
        ImGui::SameLine();
        fittedText(fmt::format("{:5.1f} %  {}", percentOf(all[i].pixels, view), all[i].category.name));
        tip(all[i].category.name);
    }
    if (count < all.size()) {
        ImGui::TextDisabled("%zu more", all.size() - count);
    }
}

}  // namespace

std::optional<Look> drawLooks(Controls& controls, const Build& build, const Look& chosen,
                              const measure::View* shown, const std::string& note) {
    std::optional<Look> clicked;
    const auto row = [&](const Look& look, const std::string& label, const std::string& name) {
        if (controls.mark(name, ImGui::Selectable((label + "##" + name).c_str(), look == chosen))) {
            clicked = look;
        }
        tip(describe(look));
    };
    // The list keeps its place under the mouse when a legend comes below it.
    const float height = chosen.isPicture() ? 0.0F : 0.5F * ImGui::GetContentRegionAvail().y;
    ImGui::BeginChild("looks", {0.0F, height});
    row({}, "picture", "picture");
    std::string above;
    for (const Look& look : looksOf(build)) {
        const std::string title = look.view.empty() ? "layers" : "views";
        if (above != title) {
            ImGui::TextDisabled("%s", title.c_str());
            above = title;
        }
        row(look, look.name(), (look.view.empty() ? "layer " : "view ") + look.name());
    }
    ImGui::EndChild();
    if (chosen.isPicture()) {
        return clicked;
    }
    ImGui::Separator();
    ImGui::BeginChild("legend");
    ImGui::TextColored({0.55F, 0.80F, 1.0F, 1.0F}, "%s", chosen.name().c_str());
    ImGui::TextWrapped("%s", describe(chosen).c_str());
    if (!note.empty()) {
        coloredText({1.0F, 0.75F, 0.45F}, note);
    }
    if (shown != nullptr) {
        drawLegend(*shown, chosen);
    }
    ImGui::EndChild();
    return clicked;
}

// --- A pixel ---

namespace {

std::string describePath(Renderer::PixelPath path) {
    switch (path) {
        case Renderer::PixelPath::NoSurface:
            return "no surface";
        case Renderer::PixelPath::NoRay:
            return "no ray: rough, unlit, or the sample would bring no light";
        case Renderer::PixelPath::Screen:
            return "found on the screen, without a ray";
        case Renderer::PixelPath::Hit:
            return "a ray, which hit";
        case Renderer::PixelPath::Miss:
            return "a ray, which left the scene";
    }
    return "";
}

void addRays(Picture& picture, std::size_t pixel, std::vector<Field>& fields) {
    for (const package::EffectInfo& effect : picture.build().package->effects()) {
        if (effect.kind != package::EffectInfo::Kind::Rays) {
            continue;
        }
        const Result<std::vector<Renderer::PixelPath>> paths = picture.renderer().readCoverage(effect.effect);
        fields.push_back({"rays of " + std::string(effect.name),
                          paths ? describePath((*paths)[pixel]) : paths.error().message});
    }
}

// Adds the case's cost by the model, and the length of its code.
void addCost(const Picture& picture, std::uint32_t shaderId, std::vector<Field>& fields) {
    const compiler::Build& build = *picture.build().resolved;
    const compiler::PlanCost cost = costPlan(build.plan, build.settings.compile.plan);
    const auto found =
        std::ranges::find(cost.cases, static_cast<int>(shaderId), &compiler::CaseCost::shaderId);
    if (found != cost.cases.end()) {
        fields.push_back({"cost by the model",
                          fmt::format("{:.0f} instructions, {:.0f} fetches; {:.2f} of an average hit in vain",
                                      found->code.instructions, found->code.fetches, found->inVain)});
    }
    const std::vector<std::uint32_t>& counts = picture.build().instructions;
    if (shaderId < counts.size() && counts[shaderId] > 0) {
        fields.push_back({"SPIR-V of the case", fmt::format("{} instructions", counts[shaderId])});
    }
}

}  // namespace

Result<Pick> pickPixel(const Request& request, Picture& picture, std::uint32_t x, std::uint32_t y,
                       double exposure) {
    Pick pick{x, y, {}, -1};
    GLINT_TRY(const auto place, picture.renderer().readPlace(x, y));
    const Result<LinearImage> image = picture.renderer().readOutput();
    if (!image) {
        return image.error();
    }
    const std::size_t pixel = std::size_t{y} * image->width + x;
    const std::array<float, 4>& value = image->pixels[pixel];
    const std::array<std::uint8_t, 3> shown = image::toDisplay({value[0], value[1], value[2]}, exposure);
    pick.fields.push_back({"radiance", fmt::format("{:.5g} {:.5g} {:.5g}", value[0], value[1], value[2])});
    pick.fields.push_back({"shown as", fmt::format("{} {} {}", shown[0], shown[1], shown[2])});
    if (!place) {
        pick.fields.push_back({"surface", "none: the pixel sees the sky"});
        addRays(picture, pixel, pick.fields);
        return pick;
    }
    const gltf::Scene& scene = picture.scene();
    const Renderer::SurfacePlace& surface = *place;
    const std::optional<std::size_t> instance = picture.instanceAt(surface);
    pick.node = instance ? static_cast<int>(picture.data().sources[*instance].node) : -1;
    const int mesh = instance ? scene.nodes[static_cast<std::size_t>(pick.node)].mesh : -1;
    if (mesh >= 0) {
        const gltf::Primitive& primitive =
            scene.meshes[static_cast<std::size_t>(mesh)].primitives[surface.primitive];
        pick.fields.push_back({"instance", fmt::format("{} (/nodes/{})", *instance, pick.node)});
        pick.fields.push_back({"primitive", primitive.pointer});
        pick.material = primitive.material;
        const compiler::Build& build = *picture.build().resolved;
        const std::string& name = scene.materials[static_cast<std::size_t>(pick.material)].name;
        // Materials that edits have added are those of the second scene of the package.
        const std::size_t known = build.scenes->materialsOf(0).count;
        const bool isAdded = static_cast<std::size_t>(pick.material) >= known;
        const std::size_t planned = static_cast<std::size_t>(pick.material) + (isAdded ? known : 0);
        pick.fields.push_back(
            {"material", fmt::format("{}: {}", pick.material,
                                     isAdded ? name : build.scenes->materialName(pick.material))});
        if (planned < build.scenes->materials().size()) {
            const std::vector<Field> why = request.explain(build, static_cast<int>(planned));
            pick.fields.insert(pick.fields.end(), why.begin(), why.end());
        }
    }
    const std::span<const package::CaseEntry> cases = picture.build().package->cases();
    pick.fields.push_back(
        {"bucket", surface.shaderId < cases.size()
                       ? fmt::format("{}: hits of case {} {}", surface.shaderId + 1, surface.shaderId,
                                     picture.build().package->string(cases[surface.shaderId].name))
                       : fmt::format("{}: no case", surface.shaderId + 1)});
    addRays(picture, pixel, pick.fields);
    addCost(picture, surface.shaderId, pick.fields);
    return pick;
}

}  // namespace glint::view
