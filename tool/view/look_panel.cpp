#include "view/look_panel.h"

#include "image/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <imgui.h>

namespace glint::view {

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
        if (ImGui::Selectable((label + "##" + name).c_str(), look == chosen)) {
            clicked = look;
        }
        controls.mark(name);
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
        ImGui::PushStyleColor(ImGuiCol_Text, {1.0F, 0.75F, 0.45F, 1.0F});
        ImGui::TextWrapped("%s", note.c_str());
        ImGui::PopStyleColor();
    }
    if (shown != nullptr) {
        drawLegend(*shown, chosen);
    }
    ImGui::EndChild();
    return clicked;
}

}  // namespace glint::view
