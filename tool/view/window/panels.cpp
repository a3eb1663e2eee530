// The panels and marks that the window draws over and beside the picture.
#include "settings/descriptor.h"
#include "view/look.h"
#include "view/window/window.h"

#define GLFW_INCLUDE_NONE
#include <fmt/format.h>

#include <GLFW/glfw3.h>
#include <algorithm>
#include <imgui.h>
#include <numeric>
#include <utility>

namespace glint::view {

namespace {

constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                    ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;

struct Shortcut {
    const char* keys;
    const char* what;
};
constexpr Shortcut kShortcuts[] = {
    {"left drag", "orbit the target; look around after F"},
    {"right drag", "look around"},
    {"middle drag, Shift + left drag", "move sideways"},
    {"wheel", "go nearer; when flying: change the speed"},
    {"W A S D, Q E", "fly forward, left, back, right, down, up; Shift: faster"},
    {"F", "dragging orbits, or looks around"},
    {"Home", "back to the camera's place"},
    {"C", "next camera of the scene, then one that frames everything"},
    {"click", "explain a pixel: material, key, case, rays, cost"},
    {"1 2 3 4", "switch the strategy"},
    {"B", "compare two settings: A and B"},
    {"V", "show A, B, both with a border, their difference"},
    {"L", "list the views and layers; back to the picture"},
    {"Space", "play or pause the animation"},
    {"[ ]", "darker, brighter by a third of a stop"},
    {"X", "measure the exposure"},
    {"M", "1 pixel of the picture for 1, 4, 9 or 16 of the window"},
    {"P or F12", "screenshot, with the command that repeats it"},
    {"Tab", "show or hide the panel"},
    {"Esc", "close what is open"},
    {"F1", "this list"},
    {"Ctrl + Q", "quit"},
    {"drop a file",
     ".gltf, .glb: open it, or add it where the tab Nodes is open; .hdr, .exr: light the scene by it"},
};

std::string mebibytes(std::uint64_t bytes) {
    return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / (1U << 20));
}

void drawField(const std::string& label, const std::string& text) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextDisabled("%s", label.c_str());
    ImGui::TableNextColumn();
    ImGui::TextWrapped("%s", text.c_str());
}

bool beginFields(const char* name) {
    if (!ImGui::BeginTable(name, 2, ImGuiTableFlags_SizingFixedFit)) {
        return false;
    }
    ImGui::TableSetupColumn("label", ImGuiTableColumnFlags_WidthFixed, ImGui::GetFontSize() * 11.0F);
    ImGui::TableSetupColumn("text", ImGuiTableColumnFlags_WidthStretch);
    return true;
}

}  // namespace

void Window::drawInterface() {
    const ImGuiIO& io = ImGui::GetIO();
    const float scale = io.FontGlobalScale;
    pixelScale_ = io.DisplayFramebufferScale.x;
    // The picture keeps at least a part of a narrow window.
    const float panel =
        showsPanel_ ? std::min(kPanelWidth * scale, std::max(io.DisplaySize.x - 64.0F, 0.0F)) : 0.0F;
    const float line = kStatusHeight * scale;
    const float width = std::max(io.DisplaySize.x - panel, 1.0F);
    const float height = std::max(io.DisplaySize.y - line, 1.0F);
    area_ = {0, 0, static_cast<int>(width * pixelScale_), static_cast<int>(height * pixelScale_)};
    drawMarks();
    drawStatus(width, height, line);
    const bool measured = std::exchange(measuresPasses_, false);
    showsOutliner_ = showsOutliner_ && showsPanel_;
    if (showsPanel_) {
        drawSidePanel(width, panel, io.DisplaySize.y);
    }
    if (showsHelp_) {
        drawHelp();
    }
    if (measured != measuresPasses_) {
        // Times of whole frames and of passes don't mix in a chart. A complete picture has no times of passes
        // yet.
        forSides([](Side& one) { one.history.clear(); });
        restartPictures();
    }
}

// Marks over the picture: the pixel that is explained, the border between two pictures, and the name of the
// look.
void Window::drawMarks() {
    ImDrawList* const list = ImGui::GetBackgroundDrawList();
    const float width = static_cast<float>(area_.width) / pixelScale_;
    const float height = static_cast<float>(area_.height) / pixelScale_;
    const float line = ImGui::GetTextLineHeight();
    if (pick_ && sides_[0]->picture.isReady()) {
        const compiler::Settings& settings = sides_[0]->picture.settings();
        const ImVec2 at{
            (static_cast<float>(pick_->x) + 0.5F) / static_cast<float>(settings.renderer.width) * width,
            (static_cast<float>(pick_->y) + 0.5F) / static_cast<float>(settings.renderer.height) * height};
        for (const auto& [color, thickness] :
             {std::pair(IM_COL32(0, 0, 0, 200), 3.0F), std::pair(IM_COL32(255, 255, 255, 255), 1.0F)}) {
            list->AddCircle(at, 7.0F, color, 20, thickness);
            list->AddLine({at.x - 12.0F, at.y}, {at.x - 4.0F, at.y}, color, thickness);
            list->AddLine({at.x + 4.0F, at.y}, {at.x + 12.0F, at.y}, color, thickness);
            list->AddLine({at.x, at.y - 12.0F}, {at.x, at.y - 4.0F}, color, thickness);
            list->AddLine({at.x, at.y + 4.0F}, {at.x, at.y + 12.0F}, color, thickness);
        }
    }
    const auto label = [&](float x, const std::string& text, bool fromRight) {
        const ImVec2 size = ImGui::CalcTextSize(text.c_str());
        const float left = fromRight ? x - size.x - 10.0F : x + 10.0F;
        list->AddRectFilled({left - 5.0F, 7.0F}, {left + size.x + 5.0F, 9.0F + line + 2.0F},
                            IM_COL32(0, 0, 0, 170), 3.0F);
        list->AddText({left, 9.0F}, IM_COL32(255, 255, 255, 255), text.c_str());
    };
    if (view_) {
        label(0.0F, look_.name() + (sides_[1] ? edited_ == 0 ? " of A" : " of B" : ""), false);
    } else if (sides_[1] && sides_[1]->picture.isReady()) {
        switch (shown_) {
            case Shown::First:
                label(0.0F, "A", false);
                break;
            case Shown::Second:
                label(0.0F, "B", false);
                break;
            case Shown::Wipe:
                label(border_ * width, "A", true);
                label(border_ * width, "B", false);
                list->AddTriangleFilled({border_ * width - 6.0F, height}, {border_ * width + 6.0F, height},
                                        {border_ * width, height - 10.0F}, IM_COL32(255, 255, 255, 255));
                break;
            default:
                label(0.0F, fmt::format("difference of A and B, times {:g}", gain_), false);
                break;
        }
    }
    if (!sides_[0]->picture.isReady()) {
        const std::string text = error_ ? toString(*error_) : builder_->progress() + " ...";
        const float wrap = std::max(width - 40.0F, 50.0F);
        const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap);
        list->AddText(ImGui::GetFont(), ImGui::GetFontSize(),
                      {std::max(0.5F * (width - size.x), 10.0F), 0.5F * (height - size.y)},
                      IM_COL32(220, 220, 220, 255), text.c_str(), nullptr, wrap);
    }
}

void Window::drawStatus(float width, float y, float height) {
    ImGui::SetNextWindowPos({0.0F, y});
    ImGui::SetNextWindowSize({width, height});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {8.0F, 5.0F});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1.0F, 1.0F});
    ImGui::Begin("##status", nullptr, kFixed | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoInputs);
    const Picture& picture = side().picture;
    std::string text;
    if (picture.isReady()) {
        const double seconds = std::accumulate(sampleTimes_.begin(), sampleTimes_.end(), 0.0);
        const double rate = seconds > 0.0 ? static_cast<double>(sampleTimes_.size()) / seconds : 0.0;
        text = fmt::format("{}x{}  {}  {}/{} samples", picture.settings().renderer.width,
                           picture.settings().renderer.height, package::nameOf(*picture.settings().strategy),
                           picture.samples(), picture.settings().samples);
        text += picture.isComplete() ? "" : fmt::format("  {:.1f}/s", rate);
        text += wantsShot_ ? "  screenshot when complete" : "";
    }
    ImGui::TextUnformatted(text.c_str());
    const std::string progress = builder_->progress();
    const std::string& note = progress.empty() ? status_ : progress;
    if (!note.empty()) {
        ImGui::SameLine(0.0F, 20.0F);
        const ImVec4 color =
            progress.empty() && error_ ? ImVec4(1.0F, 0.55F, 0.35F, 1.0F) : ImVec4(0.65F, 0.75F, 0.85F, 1.0F);
        ImGui::PushStyleColor(ImGuiCol_Text, color);
        fittedText(note);
        ImGui::PopStyleColor();
    }
    ImGui::End();
    ImGui::PopStyleVar(2);
}

void Window::drawHead() {
    const bool compares = sides_[1] != nullptr;
    if (controls_.mark("Help", ImGui::Button("Help F1"))) {
        showsHelp_ = !showsHelp_;
    }
    ImGui::SameLine();
    if (controls_.mark("Screenshot", ImGui::Button("Screenshot P"))) {
        wantsShot_ = true;
    }
    ImGui::SameLine();
    if (controls_.mark("Compare", ImGui::Button(compares ? "Stop comparing B" : "Compare A|B  B"))) {
        compare(!compares);
    }
    ImGui::SameLine();
    const std::string resolution = fmt::format("1:{} M", divisor_);
    if (controls_.mark("Resolution", ImGui::Button(resolution.c_str()))) {
        divisor_ = divisor_ % 4 + 1;
    }
    tip("pixels of the picture to pixels of the window, each way");

    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted("exposure");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 9.0F);
    if (controls_.mark("exposure",
                       ImGui::SliderFloat("##exposure", &exposure_, -16.0F, 16.0F, "%+.2f stops"))) {
        autoExposure_ = false;
    }
    ImGui::SameLine();
    if (controls_.mark("exposure auto", ImGui::Checkbox("auto", &autoExposure_)) && autoExposure_) {
        exposureIsNew_ = true;
    }
    tip("log-average luminance of the surfaces to 18 % grey, when a picture begins and when it is complete");
    drawAnimation();
}

void Window::drawAnimation() {
    if (!sides_[0]->picture.isReady()) {
        return;
    }
    const auto& animations = sides_[0]->picture.scene().animations;
    if (animations.empty() && sides_[0]->wanted.materials.empty()) {
        return;
    }
    if (controls_.mark("Play", ImGui::Button(plays_ ? "Pause" : "Play"))) {
        togglePlaying();
    }
    double duration = 0.0;
    for (const std::size_t index : animations_) {
        duration = index < animations.size() ? std::max(duration, animations[index].duration) : duration;
    }
    duration = duration > 0.0 ? duration : 60.0;
    ImGui::SameLine();
    auto seconds = static_cast<float>(time_);
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 11.0F);
    if (controls_.mark(
            "time", ImGui::SliderFloat("##time", &seconds, 0.0F, static_cast<float>(duration), "%.3f s"))) {
        time_ = seconds;
        poses_ = true;
        plays_ = false;
    }
    ImGui::SameLine();
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 4.0F);
    controls_.mark("speed", ImGui::SliderFloat("##speed", &playSpeed_, 0.1F, 4.0F, "x %.1f"));
    tip("speed of the animation");
    if (poses_) {
        ImGui::SameLine();
        if (controls_.mark("Rest", ImGui::Button("Rest"))) {
            poses_ = plays_ = false;
        }
        tip("the pose in which the file places everything");
    }
    if (animations.size() > 1) {
        const auto nameOfAnimation = [&](int index) {
            if (index >= static_cast<int>(animations.size())) {
                return std::string("all animations");
            }
            const std::string& name = animations[static_cast<std::size_t>(index)].name;
            return fmt::format("{} {}", index, name);
        };
        ImGui::SetNextItemWidth(-1.0F);
        if (ImGui::BeginCombo("##animation", nameOfAnimation(animationChoice_).c_str())) {
            for (int i = 0; i <= static_cast<int>(animations.size()); ++i) {
                if (controls_.mark(fmt::format("animation={}", i),
                                   ImGui::Selectable(nameOfAnimation(i).c_str(), i == animationChoice_))) {
                    animationChoice_ = i;
                }
            }
            closeByEscape();
            ImGui::EndCombo();
        } else {
            controls_.mark("animation");
        }
    }
}

void Window::drawCompare() {
    if (!sides_[1]) {
        return;
    }
    ImGui::Separator();
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted("settings of");
    constexpr const char* kNames[] = {"A", "B"};
    for (std::size_t i = 0; i < kPictures; ++i) {
        ImGui::SameLine();
        if (controls_.mark(fmt::format("edit {}", kNames[i]),
                           ImGui::RadioButton(fmt::format("{}##edited", kNames[i]).c_str(), edited_ == i))) {
            edited_ = i;
        }
    }
    ImGui::SameLine(0.0F, 24.0F);
    if (controls_.mark("Measure", ImGui::Button("Measure"))) {
        reportErrorOf(measureDifference());
    }
    tip("how far B is from A: as seen (FLIP), and in linear light");
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted("show       ");
    constexpr const char* kShown[] = {"A", "B", "A|B", "difference"};
    for (std::uint32_t i = 0; i < std::size(kShown); ++i) {
        ImGui::SameLine();
        if (controls_.mark(fmt::format("show {}", kShown[i]),
                           ImGui::RadioButton(fmt::format("{}##shown", kShown[i]).c_str(),
                                              shown_ == static_cast<Shown>(i)))) {
            shown_ = static_cast<Shown>(i);
        }
    }
    if (shown_ == Shown::Difference) {
        ImGui::SetNextItemWidth(ImGui::GetFontSize() * 9.0F);
        controls_.mark("gain", ImGui::SliderFloat("times##gain", &gain_, 1.0F, 64.0F, "%.0f",
                                                  ImGuiSliderFlags_Logarithmic));
    }
    if (!difference_.empty()) {
        ImGui::TextUnformatted(difference_.c_str());
    }
}

void Window::drawPixel() {
    if (!pick_) {
        ImGui::TextWrapped("Click a pixel of the picture.");
        return;
    }
    ImGui::BeginChild("pixel");
    ImGui::Text("pixel %u, %u", pick_->x, pick_->y);
    if (beginFields("pixel")) {
        for (const Field& field : pick_->fields) {
            drawField(field.label, field.text);
        }
        ImGui::EndTable();
    }
    ImGui::EndChild();
}

void Window::drawLooksTab() {
    if (!side().picture.isReady()) {
        return;
    }
    const bool isMade = builder_->isBusy(edited_);
    const std::string note = lookNote_.empty() ? "" : isMade ? "is being compiled" : lookNote_;
    if (const std::optional<Look> clicked =
            drawLooks(controls_, side().picture.build(), look_, view_ ? &*view_ : nullptr, note)) {
        chooseLook(*clicked);
    }
}

void Window::drawScene() {
    Side& one = side();
    if (!one.picture.isReady()) {
        return;
    }
    ImGui::BeginChild("scene");
    const Build& build = one.picture.build();
    const GpuScene::Statistics& statistics = one.picture.gpuScene().statistics();
    if (beginFields("scene")) {
        drawField("file", scene_);
        drawField("device", context_->deviceName());
        drawField("camera", camera_.name().empty() ? "first of the scene" : camera_.name());
        drawField("materials", std::to_string(build.scene->materials.size()));
        drawField("keys, cases",
                  fmt::format("{}, {}", build.resolved->plan.keys.size(), caseCount(build.resolved->plan)));
        std::string effects;
        for (const package::EffectInfo& effect : build.package->effects()) {
            effects += (effects.empty() ? "" : ", ") + std::string(effect.name);
        }
        drawField("effects", effects.empty() ? "none" : effects);
        drawField("triangles", fmt::format("{} in {} instances", statistics.triangles, statistics.instances));
        drawField("last build",
                  fmt::format("read {:.0f} ms, compile {:.0f} ms ({} modules compiled, {} kept), textures "
                              "{:.0f} ms",
                              build.readMs, build.compileMs, build.modulesCompiled, build.modulesKept,
                              build.texturesMs));
        drawField("last change", one.picture.lastChange());
        drawField("pipelines", std::to_string(one.picture.renderer().footprint().pipelines));
        ImGui::EndTable();
    }
    const auto drawMemory = [](const char* title, const std::vector<MemoryItem>& items) {
        std::uint64_t bytes = 0;
        for (const MemoryItem& item : items) {
            bytes += item.bytes;
        }
        if (ImGui::TreeNode(fmt::format("{}: {}###{}", title, mebibytes(bytes), title).c_str())) {
            if (beginFields(title)) {
                for (const MemoryItem& item : items) {
                    drawField(item.name, mebibytes(item.bytes));
                }
                ImGui::EndTable();
            }
            ImGui::TreePop();
        }
    };
    drawMemory("memory of the scene", one.picture.gpuScene().memory());
    controls_.mark("memory of the scene");
    drawMemory("memory of a frame", one.picture.renderer().memory());
    controls_.mark("memory of a frame");
    ImGui::EndChild();
}

void Window::drawMessages() {
    unread_ = 0;
    if (controls_.mark("Copy all", ImGui::Button("Copy all"))) {
        std::string all;
        for (const Diagnostic& message : messages_) {
            all += toString(message) + "\n";
        }
        ImGui::SetClipboardText(all.c_str());
    }
    ImGui::SameLine();
    if (controls_.mark("Clear", ImGui::Button("Clear"))) {
        messages_.clear();
    }
    ImGui::BeginChild("messages");
    for (const Diagnostic& message : messages_) {
        coloredText(message.severity == Severity::Error     ? std::array{1.0F, 0.5F, 0.35F}
                    : message.severity == Severity::Warning ? std::array{0.95F, 0.8F, 0.4F}
                                                            : std::array{0.8F, 0.85F, 0.9F},
                    toString(message));
        ImGui::Separator();
    }
    if (messages_.empty()) {
        ImGui::TextDisabled("There are none.");
    }
    ImGui::EndChild();
}

void Window::drawSidePanel(float x, float width, float height) {
    ImGui::SetNextWindowPos({x, 0.0F});
    ImGui::SetNextWindowSize({width, height});
    ImGui::Begin("##panel", nullptr, kFixed);
    drawHead();
    drawCompare();
    ImGui::Separator();
    if (error_) {
        coloredText(kErrorColor, toString(*error_));
    }
    if (ImGui::BeginTabBar("tabs")) {
        const auto tab = [this](const char* name, const std::string& title, const auto& draw) {
            const ImGuiTabItemFlags flags =
                wantedTab_ == name ? ImGuiTabItemFlags_SetSelected : ImGuiTabItemFlags_None;
            const bool isOpen = ImGui::BeginTabItem((title + "###" + name).c_str(), nullptr, flags);
            controls_.mark(std::string("tab ") + name);
            if (isOpen) {
                draw();
                ImGui::EndTabItem();
            }
        };
        tab("Settings", "Settings", [this] {
            const bool changed = settingsPanel_.draw(
                controls_, side().wanted,
                side().picture.isReady() ? side().picture.build().facts : compiler::BenchFacts());
            if (changed) {
                followPanel();
            }
        });
        tab("Passes", "Passes", [this] {
            measuresPasses_ = true;
            drawPasses(controls_, side().history, side().counters);
        });
        tab("Views", "Views", [this] { drawLooksTab(); });
        tab("Pixel", "Pixel", [this] { drawPixel(); });
        showsOutliner_ = false;
        tab("Nodes", "Nodes", [this] { drawOutliner(); });
        tab("Scene", "Scene", [this] { drawScene(); });
        tab("Messages", unread_ > 0 ? fmt::format("Messages ({})", unread_) : "Messages",
            [this] { drawMessages(); });
        wantedTab_.clear();
        ImGui::EndTabBar();
    }
    ImGui::End();
}

// Applies the changes of the panel. The size of the picture is that of its part of the window.
void Window::followPanel() {
    Side& one = side();
    if (one.picture.isReady()) {
        const RendererOptions& shown = one.picture.settings().renderer;
        const RendererOptions& wanted = one.wanted.renderer;
        if (wanted.width != shown.width || wanted.height != shown.height) {
            int width = 0;
            int height = 0;
            glfwGetWindowSize(window_, &width, &height);
            const auto change = [&](std::uint32_t pixels, int now) {
                return static_cast<int>(static_cast<float>(static_cast<int>(pixels) * divisor_ - now) /
                                        pixelScale_);
            };
            glfwSetWindowSize(window_, width + change(wanted.width, area_.width),
                              height + change(wanted.height, area_.height));
        }
    }
    if (Status followed = followSettings(edited_); !followed) {
        fail(followed.error());
    }
}

void Window::drawHelp() {
    // The message also covers the panel where the picture is narrow.
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({0.5F * size.x, 0.5F * size.y}, ImGuiCond_Always, {0.5F, 0.5F});
    ImGui::SetNextWindowSizeConstraints({1.0F, 1.0F}, size);
    ImGui::Begin("Keys and mouse", &showsHelp_,
                 ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_AlwaysAutoResize |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoMove);
    if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg)) {
        for (const Shortcut& shortcut : kShortcuts) {
            ImGui::TableNextColumn();
            ImGui::TextColored({0.55F, 0.80F, 1.0F, 1.0F}, "%s", shortcut.keys);
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(shortcut.what);
        }
        ImGui::EndTable();
    }
    ImGui::End();
}

}  // namespace glint::view
