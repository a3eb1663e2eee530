// Options of what moves: a sequence of frames, or one moment of an animation.
#pragma once

#include "cli/options.h"
#include "gltf/scene.h"

#include <glint/result.h>
#include <glint/scene_view.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace glint {

struct MotionArguments {
    std::string frames;  // "A:B" or "A"; empty: no sequence
    double fps = 24.0;
    std::string time;  // seconds; empty: the rest pose
    std::string animation = "0";
    std::string refit = "auto";
};
void addMotionOptions(CLI::App& command, MotionArguments& arguments);

// Frames of a sequence, first and last of which are rendered.
struct FrameRange {
    std::int64_t first = 0;
    std::int64_t last = 0;
};
// "7" or "0:23"; nothing for other text, for a last frame before the first, and above a million frames.
std::optional<FrameRange> parseFrames(const std::string& text);

// A moment that is rendered.
struct Moment {
    std::int64_t frame = 0;
    double seconds = 0.0;
};

// What is played, and when it is looked at.
struct Movement {
    std::vector<std::size_t> animations;  // into Scene::animations
    std::vector<Moment> moments;          // at least one
    bool isSequence = false;              // files are numbered
    MotionView::Builds builds = MotionView::Builds::ByRule;
};

// Nothing where the scene is to be seen at rest. Errors: "animation-missing", "animation-unknown".
Result<std::optional<Movement>> chooseMovement(const MotionArguments& arguments, const Scene& scene);

// "out.png" and 7 give "out.0007.png".
std::filesystem::path numberedFile(const std::filesystem::path& file, std::int64_t frame);

}  // namespace glint
