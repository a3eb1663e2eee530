#include "view/controls.h"

#include <imgui.h>

namespace glint::view {

void Controls::mark(const std::string& name) {
    const ImVec2 min = ImGui::GetItemRectMin();
    const ImVec2 max = ImGui::GetItemRectMax();
    const ImVec2 clipMin = ImGui::GetWindowDrawList()->GetClipRectMin();
    const ImVec2 clipMax = ImGui::GetWindowDrawList()->GetClipRectMax();
    current_[name] = {{min.x, min.y}, {max.x, max.y}, {clipMin.x, clipMin.y}, {clipMax.x, clipMax.y}};
}

std::optional<Controls::Place> Controls::find(const std::string& name) const {
    const auto found = places_.find(name);
    return found == places_.end() ? std::nullopt : std::optional(found->second);
}

void closeByEscape() {
#if IMGUI_VERSION_NUM >= 18700
    const bool pressed = ImGui::IsKeyPressed(ImGuiKey_Escape);
#else
    const bool pressed = ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape));
#endif
    if (pressed) {
        ImGui::CloseCurrentPopup();
    }
}

void fittedText(const std::string& text) {
    const float width = ImGui::GetContentRegionAvail().x;
    std::string shown = text;
    for (std::size_t length = text.size(); length > 0 && ImGui::CalcTextSize(shown.c_str()).x > width;) {
        shown = --length > 0 ? text.substr(0, length) + "..." : std::string();
    }
    ImGui::TextUnformatted(shown.c_str());
}

void tip(const std::string& text) {
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) {
        ImGui::BeginTooltip();
        ImGui::PushTextWrapPos(ImGui::GetFontSize() * 32.0F);
        ImGui::TextUnformatted(text.c_str());
        ImGui::PopTextWrapPos();
        ImGui::EndTooltip();
    }
}

}  // namespace glint::view
