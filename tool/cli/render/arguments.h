// The command line of glint render.
#pragma once

#include "cli/cache.h"
#include "cli/options/motion_options.h"
#include "cli/options/setting_options.h"
#include "image/tone.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace glint::cli {

using image::kMaxExposure;

struct RenderArguments : compiler::Settings {
    std::string scene;
    std::string output;
    MotionArguments motion;
    std::string settingsFile;  // that completeLine() has read
    std::string exposure = "auto";
    std::string stats;
    bool pipelineStatistics = false;
    std::string coverage;
    bool denoise = false;
    std::string view;           // with which view the picture is drawn; empty: none
    std::string viewReference;  // a file that it compares with
    std::string profileOutput;  // counts hits by key; Settings::profile is the file that planning reads
    PipelineArguments pipelines;
    CacheArguments cache;
};

// Declares the options that make a picture, whatever its use: the scene, size, effects, shaders, the device.
void addSceneOptions(CLI::App& command, RenderArguments& arguments);
// Throws a CLI::ParseError if some of them contradict each other.
void checkSceneOptions(const CLI::App& command, RenderArguments& arguments);

// Adds --package; `further` is what the help says besides.
void addPackageOption(CLI::App& command, RenderArguments& arguments, const std::string& further = {});
// Throws a CLI::ParseError if an option is given that --package decides.
void checkPackageChoice(const CLI::App& command);

// Declares every option of glint render. Calls `then` once the line is parsed and found valid.
void addRenderOptions(CLI::App& command, const std::shared_ptr<RenderArguments>& arguments,
                      const std::function<void()>& then);

}  // namespace glint::cli
