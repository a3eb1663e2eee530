// The command line that makes the same picture as the window: glint render with the settings that differ from
// its defaults.
#pragma once

#include "settings/settings.h"

#include <string>
#include <vector>

namespace glint::view {

struct ShotOptions {
    std::string scene;
    std::string output;
    std::string camera;     // what --camera takes; empty: the default
    double exposure = 0.0;  // stops
    std::string time;       // seconds; empty: the rest pose
    std::string animation;  // with `time`: what --animation takes
    std::string view{};     // what --view takes; empty: the picture itself
    std::string layers{};   // what --layers takes, with an `output` that holds layers; empty: none
};

// Returns the words, from "glint" on. `settings` has the size of the picture and the number of its samples.
std::vector<std::string> shotWords(const compiler::Settings& settings, const ShotOptions& options);

}  // namespace glint::view
