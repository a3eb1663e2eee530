// The command line of glint render, and its options about movement: a sequence of frames, or one moment of an
// animation.
#pragma once

#include "cli/cache.h"
#include "cli/options/options.h"
#include "cli/options/setting_options.h"
#include "gltf/scene.h"
#include "image/tone.h"

#include <glint/result.h>
#include <glint/scene_view.h>
#include <glint/session/scene_view.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace glint::cli {

struct MotionArguments {
    std::string frames;  // "A:B" or "A"; empty: no sequence
    double fps = 24.0;
    std::string time;  // seconds; empty: the rest pose
    std::string animation = "0";
    MotionView::Builds builds = MotionView::Builds::ByRule;
};
// Adds --frames and what belongs to it, and addMoment().
void addMotionOptions(CLI::App& command, MotionArguments& arguments);
// Adds --time and --animation. `what` says what happens at that time.
void addMoment(CLI::App& command, MotionArguments& arguments, const std::string& what);

// The frames of a sequence. The first and the last are rendered too.
struct FrameRange {
    std::int64_t first = 0;
    std::int64_t last = 0;
};
// Parses "7" or "0:23". Returns nothing for other text, if the last frame is before the first, or above a
// million frames.
std::optional<FrameRange> parseFrames(const std::string& text);

// The animations that play, and the moments to render.
struct Movement {
    std::vector<std::size_t> animations{};  // into Scene::animations
    std::vector<double> seconds{};          // of each frame, at least one
    std::int64_t firstFrame = 0;            // its number
    bool isSequence = false;                // files are numbered
    MotionView::Builds builds = MotionView::Builds::ByRule;

    session::Moment moment(std::size_t frame) const {
        return {animations, seconds[frame]};
    }
};

// Returns nothing if the scene is rendered at rest. With `followsTime` its materials may move, so that a
// scene without animations has moments, too. Errors: "animation-missing", "animation-unknown".
Result<std::optional<Movement>> chooseMovement(const MotionArguments& arguments, const gltf::Scene& scene,
                                               bool followsTime);

// Returns "out.0007.png" for "out.png" and 7.
std::filesystem::path numberedFile(const std::filesystem::path& file, std::int64_t frame);

// --- The command line ---

using image::kMaxExposure;

struct RenderArguments : compiler::Settings {
    std::string scene;
    std::string output;
    MotionArguments motion;
    std::string edits;         // a file of edits; empty: none
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
