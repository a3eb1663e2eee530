// glint view: shows a scene in a window.
#include "cli/command_line.h"
#include "cli/render/arguments.h"
#include "cli/report.h"
#include "view/request.h"

#include <algorithm>

namespace glint::cli {

namespace {

namespace fs = std::filesystem;

// A picture is complete at this number of samples, unless --spp says otherwise.
constexpr std::uint32_t kSamplesInWindow = 64;

struct ViewArguments : RenderArguments {
    view::Request request;  // with the options of the window
};

view::Request requestOf(const Console& console, const ViewArguments& arguments, CompileCache& cache) {
    view::Request request = arguments.request;
    request.scene = arguments.scene;
    request.settings = static_cast<const compiler::Settings&>(arguments);
    request.exposure = arguments.exposure;
    request.time = arguments.motion.time;
    request.animation = arguments.motion.animation;
    request.observer = &console;
    request.modules = cache.modules();
    request.store = cache.store();
    request.explain = [](const compiler::Build& build, int material) {
        std::vector<view::Field> fields;
        for (const std::vector<std::string>& row : materialRows(build, material, Detail::Whole)) {
            const std::size_t first = std::min(row[0].find_first_not_of(' '), row[0].size());
            fields.push_back({row[0].substr(first), row[1]});
        }
        return fields;
    };
    return request;
}

Result<int> show(const Console& console, const ViewArguments& arguments, const Companion& companion) {
    CompileCache cache(arguments.cache, "");
    view::Request request = requestOf(console, arguments, cache);
    std::unique_ptr<PipelineCacheFile> pipelines;
    request.opened = [&](Context& context) {
        pipelines = std::make_unique<PipelineCacheFile>(
            console, context, pipelineCacheFolder(arguments.pipelines, arguments.cache));
    };
    request.closing = [&](Context&) {
        pipelines->save();
        pipelines.reset();
    };
    const Status shown = companion.showWindow(request);
    cache.close(console);
    return shown ? Result<int>(kExitDone) : shown.error();
}

}  // namespace

void addView(CLI::App& app, Action& chosen, std::span<const char* const> line, const Companion& companion) {
    CLI::App& command = addCommand(
        app,
        {.name = "view",
         .what = "Show a scene in a window, and change every setting while it runs",
         .examples = {"glint view scene.gltf", "glint view scene.gltf --size 1280x720 --bounces 4 --play"},
         .usual = {"--size", "--spp", "--camera", "--environment", "--exposure", "--bounces", "--strategy",
                   "--play", "--package", "--device"}});
    const auto arguments = std::make_shared<ViewArguments>();
    arguments->samples = kSamplesInWindow;
    addSceneOptions(command, *arguments);
    addPackageOption(command, *arguments, "; and the next one when it is written (glint compile --watch)");
    const OptionGroup group(command, "Window");
    addMoment(command, arguments->motion, "begin");
    addFlag(command, "--play", arguments->request.plays, "begin to play the animation");
    addFlag(command, "--panel", arguments->request.showsPanel,
            "begin with the panel; Tab shows and hides it");
    addText(command, "--screenshots", arguments->request.folder, "DIR",
            "where screenshots are written, under new names (default: here)");
    command.callback([arguments, line, companion, &command, &chosen] {
        checkPackageChoice(command);
        checkSceneOptions(command, *arguments);
        checkProfile(command, *arguments);
        chosen = [arguments, line, companion](const Console& console) -> Result<int> {
            return companion.showWindow != nullptr
                       ? show(console, *arguments, companion)
                       : startCompanion(
                             "glint-view", line,
                             makeError("window-missing", "", "this glint was built without its window",
                                       "install libglfw3-dev, libimgui-dev and glslang-tools, then "
                                       "configure and build Glint again"));
        };
    });
}

}  // namespace glint::cli
