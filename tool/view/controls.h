// Panels and their controls, whose places are known so that a script can find them as a person would: by
// their names.
#pragma once

#include "settings/descriptor.h"

#include <glint/renderer.h>

#include <array>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace glint::view {

class Controls {
public:
    struct Place {
        std::array<float, 2> min{};  // window coordinates, also of a control that is scrolled away
        std::array<float, 2> max{};
        std::array<float, 2> clipMin{};  // the part of the window that shows it
        std::array<float, 2> clipMax{};
    };

    void beginFrame() {
        places_.swap(current_);
        current_.clear();
    }
    // Notes the place of ImGui's last item. Returns `used`, which is what the item has returned.
    bool mark(const std::string& name, bool used = false);
    // Returns the place in the last frame, or no value if the control was not there.
    std::optional<Place> find(const std::string& name) const;

private:
    std::map<std::string, Place> places_;
    std::map<std::string, Place> current_;
};

// Closes the list that is open if Escape is pressed. Call it in the list.
void closeByEscape();

// Draws a text that ends with dots where the line has no room for it.
void fittedText(const std::string& text);

// Draws a text over as many lines as it needs, in a colour from 0 to 1.
void coloredText(const std::array<float, 3>& color, const std::string& text);
inline constexpr std::array<float, 3> kErrorColor{1.0F, 0.55F, 0.35F};

// Shows a text while the mouse is over ImGui's last item.
void tip(const std::string& text);

// --- The controls of settings ---

class SettingsPanel {
public:
    // Draws a control for each setting of `glint render` and changes `settings`. `facts` tells which of them
    // change nothing in this scene. Returns whether any has changed.
    bool draw(Controls& controls, compiler::Settings& settings, const compiler::BenchFacts& facts);

private:
    // A setting as its control shows it.
    struct Shown {
        const compiler::Descriptor& row;
        std::string name;
        std::string label;    // of the control, which shows no text
        std::string present;  // the text of the value
        std::string typed;    // the same, or what is being typed or dragged
        std::vector<compiler::SettingWord> words;
        bool isNumber = false;
    };
    // These draw the control, and return the text of a value that was chosen.
    std::optional<std::string> drawValue(Controls& controls, const Shown& shown);
    std::optional<std::string> drawList(Controls& controls, const Shown& shown);
    // Sets the value, or keeps the complaint about it. Returns whether it was set.
    bool take(const compiler::Descriptor& row, const std::string& next, compiler::Settings& settings);
    bool drawRow(Controls& controls, const compiler::Descriptor& row, compiler::Settings& settings,
                 const compiler::BenchFacts& facts);

    // Text that is being typed or dragged, by setting, until it is finished.
    std::map<std::string, std::string, std::less<>> drafts_;
    std::string filter_;
    std::string complaint_;  // about the last text that was typed
};

// --- The time of each pass of the last frames, as a running chart ---

// Device times of the last frames.
class PassHistory {
public:
    static constexpr std::size_t kFrames = 160;

    void add(const std::vector<PassTiming>& passes);
    void clear();
    // Names of passes in the order in which they first ran.
    const std::vector<std::string>& names() const {
        return names_;
    }
    // Milliseconds by pass, for each frame, the oldest first. Later frames may have more passes.
    const std::deque<std::vector<double>>& frames() const {
        return frames_;
    }
    // The median of the frames that have the pass.
    double median(std::size_t pass) const;
    double medianFrame() const;

private:
    std::vector<std::string> names_;
    std::deque<std::vector<double>> frames_;
};

// Draws chart and table. `counters` are those of the last frame.
void drawPasses(Controls& controls, const PassHistory& history, const Renderer::Counters& counters);

}  // namespace glint::view
