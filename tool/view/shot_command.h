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
    std::string camera;     // the value of --camera; empty: the default
    double exposure = 0.0;  // stops
    std::string time;       // seconds; empty: the rest pose
    std::string animation;  // with `time`: the value of --animation
    std::string view{};     // the value of --view; empty: the picture itself
    std::string layers{};   // the value of --layers, with an `output` that holds layers; empty: none
};

// Returns the words, from "glint" on. `settings` has the size of the picture and the number of its samples.
std::vector<std::string> shotWords(const compiler::Settings& settings, const ShotOptions& options);

}  // namespace glint::view
