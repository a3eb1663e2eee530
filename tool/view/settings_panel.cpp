#include "view/settings_panel.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <imgui.h>
#include <imgui_stdlib.h>
#include <optional>
#include <vector>

namespace glint::view {

namespace {

using compiler::Descriptor;
using compiler::SettingWord;
using compiler::ValueForm;

std::vector<std::string> splitList(const std::string& text) {
    std::vector<std::string> words;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        words.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return words;
}

// Words that stand alone in a list.
bool standsAlone(const std::string& word) {
    return word == "none" || word == "all";
}

std::string toggled(const std::string& list, const std::string& word, const std::vector<SettingWord>& words) {
    if (standsAlone(word)) {
        return word;
    }
    std::vector<std::string> chosen = splitList(list);
    std::erase_if(chosen, standsAlone);
    if (std::erase(chosen, word) == 0) {
        chosen.push_back(word);
    }
    if (chosen.empty()) {
        const bool hasNone = std::ranges::find(words, "none", &SettingWord::name) != words.end();
        return hasNone ? "none" : words.front().name;
    }
    return fmt::format("{}", fmt::join(chosen, ","));
}

std::string explained(const Descriptor& row, const compiler::Settings& usual) {
    std::string text = fmt::format("--{}: {}", row.name, row.what);
    if (row.values.form == ValueForm::Whole || row.values.form == ValueForm::Real) {
        text += fmt::format("\n{} to {}", compiler::boundText(row.values.min),
                            compiler::boundText(row.values.max));
    }
    text += fmt::format("\ndefault: {}", row.values.text(usual));
    if (!row.document.empty()) {
        text += fmt::format("\ndocs/{}", row.document);
    }
    return text;
}

// Returns why a setting can't be changed, or an empty text.
std::string lockedBy(const Descriptor& row, const compiler::Settings& settings) {
    if (!settings.package.empty() && row.stage == compiler::SettingStage::Package) {
        return "--package has decided this";
    }
    if (row.group == "Environment" && settings.environment.empty()) {
        return "there is no environment map: drop an .hdr or .exr file on the window";
    }
    if (row.name == "sky" && !settings.environment.empty()) {
        return "the environment map replaces the sky";
    }
    return "";
}

// Settings that take effect with the next frame follow a slider while it moves.
bool isLive(const Descriptor& row) {
    return row.stage == compiler::SettingStage::Frame && (row.commands & compiler::kOfCompile) == 0;
}

double parsedNumber(const std::string& text) {
    double value = 0.0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
}

// The widest range of a slider; ranges may extend much farther than useful values.
constexpr double kWideRange = 4096.0;

// Draws a slider for a number. Returns its text while it moves. `present` is the setting's text, and `text`
// the shown one.
std::optional<std::string> drawNumber(const char* label, const Descriptor& row, const std::string& present,
                                      const std::string& text) {
    const double value = parsedNumber(text);
    const double max = std::min(row.values.max, std::max(kWideRange, 2.0 * parsedNumber(present)));
    // Where a range is wide, small values matter most.
    const ImGuiSliderFlags flags =
        (row.values.max <= kWideRange ? ImGuiSliderFlags_AlwaysClamp : ImGuiSliderFlags_None) |
        (max - row.values.min > 100.0 && row.values.min >= 0.0 ? ImGuiSliderFlags_Logarithmic
                                                               : ImGuiSliderFlags_None);
    const bool isWhole = row.values.form == ValueForm::Whole;
    double moved = value;
    if (!ImGui::SliderScalar(label, ImGuiDataType_Double, &moved, &row.values.min, &max,
                             isWhole ? "%.0f" : "%.3g", flags)) {
        return std::nullopt;
    }
    return isWhole ? fmt::format("{:.0f}", moved) : fmt::format("{:.3g}", moved);
}

bool isWordOf(const std::vector<SettingWord>& words, const std::string& text) {
    return std::ranges::find(words, text, &SettingWord::name) != words.end();
}

}  // namespace

std::optional<std::string> SettingsPanel::drawList(Controls& controls, const Shown& shown) {
    const std::string& name = shown.name;
    const bool isList = shown.row.values.form == ValueForm::List;
    std::optional<std::string> next;
    if (!ImGui::BeginCombo(shown.label.c_str(), shown.present.c_str(), ImGuiComboFlags_HeightLarge)) {
        controls.mark(name);
        return next;
    }
    const std::vector<std::string> chosen = splitList(shown.present);
    for (const SettingWord& word : shown.words) {
        const bool isChosen = std::ranges::find(chosen, word.name) != chosen.end();
        const ImGuiSelectableFlags flags =
            isList ? ImGuiSelectableFlags_DontClosePopups : ImGuiSelectableFlags_None;
        if (ImGui::Selectable(word.name.c_str(), isChosen, flags)) {
            next = isList ? toggled(shown.present, word.name, shown.words) : word.name;
        }
        controls.mark(name + "=" + word.name);
        tip(word.what.empty() ? word.name : word.what);
    }
    if (shown.isNumber) {
        std::string typed = isWordOf(shown.words, shown.typed) ? "" : shown.typed;
        ImGui::SetNextItemWidth(ImGui::GetFontSize() * 6.0F);
        if (ImGui::InputText("number", &typed, ImGuiInputTextFlags_EnterReturnsTrue)) {
            next = typed;
            ImGui::CloseCurrentPopup();
        }
        controls.mark(name + "=");
    }
    closeByEscape();
    ImGui::EndCombo();
    return next;
}

std::optional<std::string> SettingsPanel::drawValue(Controls& controls, const Shown& shown) {
    const Descriptor& row = shown.row;
    std::optional<std::string> next;
    if (row.values.form == ValueForm::Switch) {
        bool on = shown.present == "on";
        if (ImGui::Checkbox(shown.label.c_str(), &on)) {
            next = on ? "on" : "off";
        }
        controls.mark(shown.name);
        return next;
    }
    if (row.values.form != ValueForm::Text && !(shown.isNumber && shown.words.empty())) {
        return drawList(controls, shown);
    }
    // Sliders and texts count when they are let go.
    if (shown.isNumber) {
        if (const std::optional<std::string> moved =
                drawNumber(shown.label.c_str(), row, shown.present, shown.typed)) {
            drafts_[shown.name] = *moved;
            next = isLive(row) ? moved : next;
        }
    } else if (std::string typed = shown.typed; ImGui::InputText(shown.label.c_str(), &typed)) {
        drafts_[shown.name] = typed;
    }
    controls.mark(shown.name);
    const auto edited = drafts_.find(shown.name);
    if (edited != drafts_.end() && !ImGui::IsItemActive()) {
        next = edited->second;
        drafts_.erase(edited);
    }
    return next;
}

bool SettingsPanel::take(const Descriptor& row, const std::string& next, compiler::Settings& settings) {
    complaint_.clear();
    const bool isSwitch = row.values.form == ValueForm::Switch;
    const bool isList = row.values.form == ValueForm::List;
    for (const std::string& word : isList ? splitList(next) : std::vector<std::string>{next}) {
        complaint_ = isSwitch ? "" : complaintAbout(row, word);
        if (!complaint_.empty()) {
            complaint_ = fmt::format("{}: {}", row.name, complaint_);
            return false;
        }
    }
    row.values.set(settings, next);
    return true;
}

bool SettingsPanel::drawRow(Controls& controls, const Descriptor& row, compiler::Settings& settings,
                            const compiler::BenchFacts& facts) {
    static const compiler::Settings kUsual;
    const std::string name(row.name);
    const std::string present = row.values.text(settings);
    const auto draft = drafts_.find(name);
    const bool isNumber = row.values.form == ValueForm::Whole || row.values.form == ValueForm::Real;
    const Shown shown{
        row,          name,    "##" + name, present, draft == drafts_.end() ? present : draft->second,
        wordsOf(row), isNumber};
    const bool differs = present != row.values.text(kUsual);
    const std::string locked = lockedBy(row, settings);
    const std::string idle = compiler::withoutEffect(row.name, facts);

    ImGui::AlignTextToFramePadding();
    const ImVec4 color = differs                          ? ImVec4(0.55F, 0.80F, 1.0F, 1.0F)
                         : idle.empty() && locked.empty() ? ImGui::GetStyle().Colors[ImGuiCol_Text]
                                                          : ImGui::GetStyle().Colors[ImGuiCol_TextDisabled];
    ImGui::TextColored(color, "%s", name.c_str());
    tip(explained(row, kUsual) + (locked.empty() ? "" : "\n\n" + locked) +
        (idle.empty() ? "" : "\n\nchanges nothing here: " + idle));
    ImGui::SameLine(ImGui::GetFontSize() * 12.0F);
    ImGui::BeginDisabled(!locked.empty());
    const float resetWidth = ImGui::GetFrameHeight();
    ImGui::SetNextItemWidth(-resetWidth - ImGui::GetStyle().ItemSpacing.x);
    std::optional<std::string> next = drawValue(controls, shown);
    ImGui::EndDisabled();
    if (differs && locked.empty()) {
        ImGui::SameLine(0.0F, ImGui::GetStyle().ItemSpacing.x);
        if (ImGui::Button(("x" + shown.label).c_str(), {resetWidth, 0.0F})) {
            next = row.values.text(kUsual);
        }
        controls.mark("reset:" + name);
        tip("back to " + row.values.text(kUsual));
    }
    return next && *next != present && take(row, *next, settings);
}

bool SettingsPanel::draw(Controls& controls, compiler::Settings& settings,
                         const compiler::BenchFacts& facts) {
    bool changed = false;
    ImGui::SetNextItemWidth(-1.0F);
    ImGui::InputTextWithHint("##filter", "find a setting", &filter_);
    controls.mark("find");
    if (!complaint_.empty()) {
        ImGui::PushStyleColor(ImGuiCol_Text, {1.0F, 0.55F, 0.35F, 1.0F});
        ImGui::TextWrapped("%s", complaint_.c_str());
        ImGui::PopStyleColor();
    }
    std::vector<std::string_view> groups;
    for (const Descriptor& row : compiler::settingsTable()) {
        if ((row.commands & compiler::kOfRender) != 0 &&
            std::ranges::find(groups, row.group) == groups.end()) {
            groups.push_back(row.group);
        }
    }
    ImGui::BeginChild("settings");
    for (const std::string_view group : groups) {
        std::vector<const Descriptor*> rows;
        for (const Descriptor& row : compiler::settingsTable()) {
            const bool matches = row.name.find(filter_) != std::string_view::npos ||
                                 row.what.find(filter_) != std::string_view::npos;
            if ((row.commands & compiler::kOfRender) != 0 && row.group == group && matches) {
                rows.push_back(&row);
            }
        }
        if (rows.empty() ||
            !ImGui::CollapsingHeader(std::string(group).c_str(), ImGuiTreeNodeFlags_DefaultOpen)) {
            continue;
        }
        // A table would leave out rows that are scrolled away, and scripts could not find them.
        for (const Descriptor* const row : rows) {
            changed = drawRow(controls, *row, settings, facts) || changed;
        }
    }
    ImGui::EndChild();
    return changed;
}

}  // namespace glint::view
