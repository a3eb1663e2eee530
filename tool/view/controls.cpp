#include "view/controls.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <imgui.h>
#include <imgui_stdlib.h>
#include <numeric>
#include <optional>
#include <vector>

namespace glint::view {

bool Controls::mark(const std::string& name, bool used) {
    const ImVec2 min = ImGui::GetItemRectMin();
    const ImVec2 max = ImGui::GetItemRectMax();
    const ImVec2 clipMin = ImGui::GetWindowDrawList()->GetClipRectMin();
    const ImVec2 clipMax = ImGui::GetWindowDrawList()->GetClipRectMax();
    current_[name] = {{min.x, min.y}, {max.x, max.y}, {clipMin.x, clipMin.y}, {clipMax.x, clipMax.y}};
    return used;
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

void coloredText(const std::array<float, 3>& color, const std::string& text) {
    ImGui::PushStyleColor(ImGuiCol_Text, {color[0], color[1], color[2], 1.0F});
    ImGui::TextWrapped("%s", text.c_str());
    ImGui::PopStyleColor();
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

// --- Settings ---

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
        if (controls.mark(name + "=" + word.name, ImGui::Selectable(word.name.c_str(), isChosen, flags))) {
            next = isList ? toggled(shown.present, word.name, shown.words) : word.name;
        }
        tip(word.what.empty() ? word.name : word.what);
    }
    if (shown.isNumber) {
        std::string typed = isWordOf(shown.words, shown.typed) ? "" : shown.typed;
        ImGui::SetNextItemWidth(ImGui::GetFontSize() * 6.0F);
        if (controls.mark(name + "=",
                          ImGui::InputText("number", &typed, ImGuiInputTextFlags_EnterReturnsTrue))) {
            next = typed;
            ImGui::CloseCurrentPopup();
        }
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
        if (controls.mark(shown.name, ImGui::Checkbox(shown.label.c_str(), &on))) {
            next = on ? "on" : "off";
        }
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
        if (controls.mark("reset:" + name, ImGui::Button(("x" + shown.label).c_str(), {resetWidth, 0.0F}))) {
            next = row.values.text(kUsual);
        }
        tip("back to " + row.values.text(kUsual));
    }
    return next && *next != present && take(row, *next, settings);
}

bool SettingsPanel::draw(Controls& controls, compiler::Settings& settings,
                         const compiler::BenchFacts& facts) {
    bool changed = false;
    ImGui::SetNextItemWidth(-1.0F);
    controls.mark("find", ImGui::InputTextWithHint("##filter", "find a setting", &filter_));
    if (!complaint_.empty()) {
        coloredText(kErrorColor, complaint_);
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

// --- Passes ---

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

void drawRays(const Renderer::Counters& counters) {
    if (counters.effects.empty() ||
        !ImGui::BeginTable("rays", 4, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp)) {
        return;
    }
    for (const char* const title : {"effect", "rays", "hits", "misses"}) {
        ImGui::TableSetupColumn(title);
    }
    ImGui::TableHeadersRow();
    for (const Renderer::EffectCounters& effect : counters.effects) {
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

void drawPasses(Controls& controls, const PassHistory& history, const Renderer::Counters& counters) {
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
