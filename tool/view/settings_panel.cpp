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

bool SettingsPanel::drawRow(Controls& controls, const Descriptor& row, compiler::Settings& settings,
                            const compiler::BenchFacts& facts) {
    static const compiler::Settings kUsual;
    const std::string name(row.name);
    const std::string label = "##" + name;
    const std::string present = row.values.text(settings);
    const bool differs = present != row.values.text(kUsual);
    const std::string locked = lockedBy(row, settings);
    const std::string idle = compiler::withoutEffect(row.name, facts);
    const std::vector<SettingWord> words = wordsOf(row);
    std::optional<std::string> next;

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
    const auto draft = drafts_.find(name);
    const std::string shown = draft == drafts_.end() ? present : draft->second;
    const bool isNumber = row.values.form == ValueForm::Whole || row.values.form == ValueForm::Real;
    switch (row.values.form) {
        case ValueForm::Switch: {
            bool on = present == "on";
            if (ImGui::Checkbox(label.c_str(), &on)) {
                next = on ? "on" : "off";
            }
            controls.mark(name);
            break;
        }
        case ValueForm::Word:
        case ValueForm::List:
            if (ImGui::BeginCombo(label.c_str(), present.c_str(), ImGuiComboFlags_HeightLarge)) {
                const std::vector<std::string> chosen = splitList(present);
                for (const SettingWord& word : words) {
                    const bool isChosen = std::ranges::find(chosen, word.name) != chosen.end();
                    const ImGuiSelectableFlags flags = row.values.form == ValueForm::List
                                                           ? ImGuiSelectableFlags_DontClosePopups
                                                           : ImGuiSelectableFlags_None;
                    if (ImGui::Selectable(word.name.c_str(), isChosen, flags)) {
                        next = row.values.form == ValueForm::List ? toggled(present, word.name, words)
                                                                  : word.name;
                    }
                    controls.mark(name + "=" + word.name);
                    tip(word.what.empty() ? word.name : word.what);
                }
                closeByEscape();
                ImGui::EndCombo();
            } else {
                controls.mark(name);
            }
            break;
        case ValueForm::Whole:
        case ValueForm::Real:
            if (!words.empty()) {
                // Words and numbers: the words, and below them a field for numbers.
                if (ImGui::BeginCombo(label.c_str(), present.c_str())) {
                    for (const SettingWord& word : words) {
                        if (ImGui::Selectable(word.name.c_str(), present == word.name)) {
                            next = word.name;
                        }
                        controls.mark(name + "=" + word.name);
                        tip(word.what.empty() ? word.name : word.what);
                    }
                    std::string typed = isWordOf(words, shown) ? "" : shown;
                    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 6.0F);
                    if (ImGui::InputText("number", &typed, ImGuiInputTextFlags_EnterReturnsTrue)) {
                        next = typed;
                        ImGui::CloseCurrentPopup();
                    }
                    controls.mark(name + "=");
                    closeByEscape();
                    ImGui::EndCombo();
                } else {
                    controls.mark(name);
                }
                break;
            }
            if (const std::optional<std::string> moved = drawNumber(label.c_str(), row, present, shown)) {
                drafts_[name] = *moved;
                if (isLive(row)) {
                    next = *moved;
                }
            }
            controls.mark(name);
            break;
        case ValueForm::Text: {
            std::string typed = shown;
            if (ImGui::InputText(label.c_str(), &typed)) {
                drafts_[name] = typed;
            }
            controls.mark(name);
            break;
        }
    }
    // Sliders and texts count when they are let go.
    if ((isNumber && words.empty()) || row.values.form == ValueForm::Text) {
        const auto edited = drafts_.find(name);
        if (edited != drafts_.end() && !ImGui::IsItemActive()) {
            next = edited->second;
            drafts_.erase(edited);
        }
    }
    ImGui::EndDisabled();
    if (differs && locked.empty()) {
        ImGui::SameLine(0.0F, ImGui::GetStyle().ItemSpacing.x);
        if (ImGui::Button(("x" + label).c_str(), {resetWidth, 0.0F})) {
            next = row.values.text(kUsual);
        }
        controls.mark("reset:" + name);
        tip("back to " + row.values.text(kUsual));
    }
    if (!next || *next == present) {
        return false;
    }
    complaint_.clear();
    if (row.values.form == ValueForm::Switch) {
        row.values.set(settings, *next);
        return true;
    }
    for (const std::string& word :
         row.values.form == ValueForm::List ? splitList(*next) : std::vector<std::string>{*next}) {
        complaint_ = complaintAbout(row, word);
        if (!complaint_.empty()) {
            complaint_ = fmt::format("{}: {}", row.name, complaint_);
            return false;
        }
    }
    row.values.set(settings, *next);
    return true;
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
