// The controls of settings. They are made from the table of settings, so a setting that is added there
// appears here.
#pragma once

#include "settings/descriptor.h"
#include "view/controls.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace glint::view {

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

}  // namespace glint::view
