// The controls of settings. They are made from the table of settings, so a setting that is added there
// appears here.
#pragma once

#include "settings/table.h"
#include "view/controls.h"

#include <map>
#include <string>

namespace glint::view {

class SettingsPanel {
public:
    // Draws a control for each setting of `glint render` and changes `settings`. `facts` tells which of them
    // change nothing in this scene. Returns whether any has changed.
    bool draw(Controls& controls, compiler::Settings& settings, const compiler::BenchFacts& facts);

private:
    bool drawRow(Controls& controls, const compiler::Descriptor& row, compiler::Settings& settings,
                 const compiler::BenchFacts& facts);

    // Text that is being typed or dragged, by setting, until it is finished.
    std::map<std::string, std::string, std::less<>> drafts_;
    std::string filter_;
    std::string complaint_;  // about the last text that was typed
};

}  // namespace glint::view
