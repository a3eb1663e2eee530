#include "view/passes_panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <imgui.h>
#include <numeric>

namespace glint::view {

namespace {

// Okabe and Ito's colours, "Color Universal Design" (2008), and the same darker: colour-blind people can tell
// neighbours apart.
ImU32 colorOfPass(std::size_t pass) {
    constexpr std::array<std::array<int, 3>, 7> kColors{{{86, 180, 233},
                                                         {230, 159, 0},
                                                         {0, 158, 115},
                                                         {240, 228, 66},
                                                         {204, 121, 167},
                                                         {0, 114, 178},
                                                         {213, 94, 0}}};
    const std::array<int, 3>& color = kColors[pass % kColors.size()];
    const int share = pass / kColors.size() % 2 == 0 ? 100 : 60;  // percent
    return IM_COL32(color[0] * share / 100, color[1] * share / 100, color[2] * share / 100, 255);
}

double medianOf(std::vector<double> values) {
    if (values.empty()) {
        return 0.0;
    }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

double sumOf(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

void drawChart(const PassHistory& history) {
    const ImVec2 origin = ImGui::GetCursorScreenPos();
    const ImVec2 size{ImGui::GetContentRegionAvail().x, ImGui::GetFontSize() * 11.0F};
    ImGui::InvisibleButton("chart", size);
    ImDrawList* const list = ImGui::GetWindowDrawList();
    list->AddRectFilled(origin, {origin.x + size.x, origin.y + size.y}, IM_COL32(24, 24, 26, 255));
    double most = 1e-3;
    for (const std::vector<double>& frame : history.frames()) {
        most = std::max(most, sumOf(frame));
    }
    const double step = size.x / static_cast<double>(PassHistory::kFrames);
    const std::size_t first = PassHistory::kFrames - history.frames().size();
    for (std::size_t i = 0; i < history.frames().size(); ++i) {
        const auto left = static_cast<float>(origin.x + static_cast<double>(first + i) * step);
        const auto right = static_cast<float>(origin.x + static_cast<double>(first + i + 1) * step);
        double below = 0.0;
        for (std::size_t pass = 0; pass < history.frames()[i].size(); ++pass) {
            const double above = below + history.frames()[i][pass];
            const auto y = [&](double value) {
                return static_cast<float>(origin.y + size.y - value / most * 0.94 * size.y);
            };
            list->AddRectFilled({left, y(above)}, {right, y(below)}, colorOfPass(pass));
            below = above;
        }
    }
    const std::string top = fmt::format("{:.2f} ms", most);
    list->AddText({origin.x + 4.0F, origin.y + 2.0F}, IM_COL32(220, 220, 220, 255), top.c_str());
}

void drawRays(const FrameCounters& counters) {
    if (counters.effects.empty() ||
        !ImGui::BeginTable("rays", 4, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp)) {
        return;
    }
    for (const char* const title : {"effect", "rays", "hits", "misses"}) {
        ImGui::TableSetupColumn(title);
    }
    ImGui::TableHeadersRow();
    for (const EffectCounters& effect : counters.effects) {
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(effect.name.c_str());
        for (const std::uint32_t count : {effect.rays, effect.hits, effect.misses}) {
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(std::to_string(count).c_str());
        }
    }
    ImGui::EndTable();
}

}  // namespace

void PassHistory::add(const std::vector<PassTiming>& passes) {
    std::vector<double> frame(names_.size());
    for (const PassTiming& pass : passes) {
        auto found = std::ranges::find(names_, pass.name);
        if (found == names_.end()) {
            names_.push_back(pass.name);
            frame.push_back(0.0);
            found = names_.end() - 1;
        }
        frame[static_cast<std::size_t>(found - names_.begin())] += pass.milliseconds;
    }
    frames_.push_back(std::move(frame));
    if (frames_.size() > kFrames) {
        frames_.pop_front();
    }
}

void PassHistory::clear() {
    names_.clear();
    frames_.clear();
}

double PassHistory::median(std::size_t pass) const {
    std::vector<double> values;
    for (const std::vector<double>& frame : frames_) {
        if (pass < frame.size()) {
            values.push_back(frame[pass]);
        }
    }
    return medianOf(std::move(values));
}

double PassHistory::medianFrame() const {
    std::vector<double> values;
    for (const std::vector<double>& frame : frames_) {
        values.push_back(sumOf(frame));
    }
    return medianOf(std::move(values));
}

void drawPasses(Controls& controls, const PassHistory& history, const FrameCounters& counters) {
    ImGui::TextWrapped("Device time of the last %d samples. While this tab is open, passes do not overlap.",
                       static_cast<int>(history.frames().size()));
    drawChart(history);
    controls.mark("chart");
    ImGui::BeginChild("passes");
    if (ImGui::BeginTable("passes", 3, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp)) {
        ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, ImGui::GetFontSize());
        ImGui::TableSetupColumn("pass");
        ImGui::TableSetupColumn("ms, median", ImGuiTableColumnFlags_WidthFixed, ImGui::GetFontSize() * 6.0F);
        ImGui::TableHeadersRow();
        for (std::size_t pass = 0; pass < history.names().size(); ++pass) {
            ImGui::TableNextColumn();
            const ImVec2 at = ImGui::GetCursorScreenPos();
            const float side = ImGui::GetFontSize() * 0.8F;
            ImGui::GetWindowDrawList()->AddRectFilled(at, {at.x + side, at.y + side}, colorOfPass(pass));
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(history.names()[pass].c_str());
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(fmt::format("{:8.3f}", history.median(pass)).c_str());
        }
        ImGui::TableNextColumn();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted("all");
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(fmt::format("{:8.3f}", history.medianFrame()).c_str());
        ImGui::EndTable();
    }
    ImGui::Spacing();
    drawRays(counters);
    ImGui::EndChild();
}

}  // namespace glint::view
