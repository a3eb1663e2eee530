#include "cli/options/motion_options.h"

#include "base/text.h"
#include "cli/table.h"
#include "settings/settings.h"

#include <fmt/format.h>

#include <numeric>

namespace glint::cli {

namespace {

constexpr std::int64_t kMaxFrame = 1000000;
constexpr double kMaxSeconds = 1e6;

std::string animationName(const gltf::Scene& scene, std::size_t index) {
    const std::string& name = scene.animations[index].name;
    return name.empty() ? std::to_string(index) : name;
}

std::optional<std::int64_t> parseFrame(std::string_view text) {
    std::int64_t frame = 0;
    return compiler::parseWhole(text, 0, kMaxFrame, frame) ? std::optional(frame) : std::nullopt;
}

Result<std::vector<std::size_t>> chooseAnimations(const gltf::Scene& scene, const std::string& wanted,
                                                  bool followsTime) {
    std::vector<std::size_t> all(scene.animations.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    if (all.empty() && followsTime) {
        return all;
    }
    if (all.empty()) {
        return makeError("animation-missing", scene.path, "has no animation to play",
                         "leave out --frames and --time");
    }
    if (wanted == "all") {
        return all;
    }
    for (const std::size_t index : all) {
        if (scene.animations[index].name == wanted) {
            return std::vector{index};
        }
    }
    const std::optional<std::int64_t> number = parseFrame(wanted);
    if (number && static_cast<std::size_t>(*number) < all.size()) {
        return std::vector{static_cast<std::size_t>(*number)};
    }
    std::vector<std::string> names;
    names.reserve(all.size() + 1);
    for (const std::size_t index : all) {
        names.push_back(animationName(scene, index));
    }
    const std::string known = base::enumeration(names);
    names.emplace_back("all");
    return makeError("animation-unknown", scene.path,
                     "has no animation \"" + wanted + "\"" + known + base::suggestion(wanted, names),
                     "use a name, a number from 0, or all");
}

}  // namespace

void addMotionOptions(CLI::App& command, MotionArguments& arguments) {
    const std::string group = "Movement";
    CLI::Option& frames = addText(command, "--frames", arguments.frames, "A:B",
                                  "play an animation and write frames A to B, or one frame;\n"
                                  "each as out.0007.png, in place of an existing file");
    frames.group(group)->check(CLI::Validator(
        [](const std::string& text) {
            return parseFrames(text) ? std::string()
                                     : "\"" + text + "\" is neither a frame such as 7 nor a range such as " +
                                           "0:23; give one, of 0 to 1000000";
        },
        ""));
    addReal(command, "--fps", arguments.fps, 0.001, 10000.0,
            "frames per second (0.001 to 10000, default: 24; needs\n"
            "--frames)")
        .needs(&frames)
        ->group(group);
    addMoment(command, arguments, "render one picture", group);
    command.get_option("--time")->excludes(&frames);
    addNamed(command, "--refit", arguments.builds,
             "how acceleration structures follow; auto: they are\n"
             "refitted, and rebuilt by rule; always: only refitted;\n"
             "never: rebuilt in each frame; needs --frames")
        .needs(&frames)
        ->group(group);
}

void addMoment(CLI::App& command, MotionArguments& arguments, const std::string& what,
               const std::string& group) {
    addText(
        command, "--time", arguments.time, "SECONDS",
        wrapped(what + " at this time of the animation (0 to 1000000, default: the rest pose)", kHelpColumns))
        .group(group)
        ->check(CLI::Validator(
            [](const std::string& text) {
                double seconds = 0.0;
                return compiler::parseReal(text, 0.0, kMaxSeconds, seconds)
                           ? std::string()
                           : "\"" + text + "\" is no number from 0 to 1000000; give one";
            },
            ""));
    addText(command, "--animation", arguments.animation, "NAME|INDEX|all",
            "which animation plays, by name or number from 0; all: all\n"
            "of them at once (default: 0)")
        .group(group);
}

std::optional<FrameRange> parseFrames(const std::string& text) {
    const std::size_t colon = text.find(':');
    const std::string_view all = text;
    const std::optional<std::int64_t> first = parseFrame(all.substr(0, colon));
    const std::optional<std::int64_t> last =
        colon == std::string::npos ? first : parseFrame(all.substr(colon + 1));
    if (!first || !last || *last < *first) {
        return std::nullopt;
    }
    return FrameRange{*first, *last};
}

Result<std::optional<Movement>> chooseMovement(const MotionArguments& arguments, const gltf::Scene& scene,
                                               bool followsTime) {
    if (arguments.frames.empty() && arguments.time.empty()) {
        return std::optional<Movement>();
    }
    GLINT_TRY(auto animations, chooseAnimations(scene, arguments.animation, followsTime));
    Movement movement;
    movement.animations = std::move(animations);
    if (const std::optional<FrameRange> range = parseFrames(arguments.frames)) {
        movement.isSequence = true;
        movement.firstFrame = range->first;
        for (std::int64_t frame = range->first; frame <= range->last; ++frame) {
            movement.seconds.push_back(static_cast<double>(frame) / arguments.fps);
        }
    } else {
        double seconds = 0.0;
        compiler::parseReal(arguments.time, 0.0, kMaxSeconds, seconds);
        movement.seconds.push_back(seconds);
    }
    movement.builds = arguments.builds;
    return std::optional(std::move(movement));
}

std::filesystem::path numberedFile(const std::filesystem::path& file, std::int64_t frame) {
    std::filesystem::path numbered = file;
    numbered.replace_extension(fmt::format(".{:04}{}", frame, file.extension().string()));
    return numbered;
}

}  // namespace glint::cli
