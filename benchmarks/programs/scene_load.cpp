// glint_scene_load: measures how long the program stands still while a scene is uploaded, and how long it
// takes to the first frame and to all levels of the textures: with the blocking upload, with one that is
// recorded into the first frame's command buffer, and with one that begins with coarse levels.
#include "base/clock.h"
#include "context/commands.h"
#include "gltf/import.h"
#include "program.h"

#include <glint/session/camera.h>
#include <glint/session/session.h>
#include <glint/session/textures.h>

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace glint {

namespace {

enum class Way { Blocking, Recorded, Streamed };

struct Arguments {
    std::string scene;
    int rounds = 5;
    benchmarks::Size size{320, 180};
};

// Everything that is there before the upload.
struct Ready {
    std::unique_ptr<Context> context;
    gltf::Scene scene;
    std::shared_ptr<const Package> package;
    session::SceneViewData data;
    FrameOptions frame;
};

// Milliseconds of wall clock since the upload began.
struct Times {
    double returned = 0.0;    // the call has returned
    double firstFrame = 0.0;  // the device has completed a frame, including the making of pipelines
    double allLevels = 0.0;   // the same, of a frame with all levels of the textures
};

Result<std::unique_ptr<Ready>> prepare(const Arguments& arguments, const compiler::Settings& settings) {
    auto ready = std::make_unique<Ready>();
    GLINT_TRY(ready->context, Context::createHeadless(session::deviceOptions(settings)));
    GLINT_TRY(ready->scene, gltf::importScene(arguments.scene, {.keepImageFiles = true}));
    compiler::CompileSettings compile;
    compile.strategies = package::kStrategyUber;
    compile.tracers = ready->context->handles().tracers;
    GLINT_TRY(const auto build, compiler::resolve(std::span(&ready->scene, 1), compile));
    GLINT_TRY(ready->package, session::compileAndLoad(build));
    session::TextureOptions options =
        session::textureOptions(settings, *ready->context, *ready->package, nullptr);
    options.fit.allLevels = true;
    GLINT_TRY(auto textures, session::loadTextures(ready->scene, options));
    ready->data = session::sceneView(settings, ready->scene);
    session::usePackage(*ready->package, ready->scene, std::move(textures), ready->data);
    GLINT_TRY(const auto camera,
              session::chooseCamera(ready->scene, ready->data, "", arguments.size.aspect()));
    ready->frame.camera = camera.view;
    return ready;
}

// Brings the finer levels, 8 MiB a frame, each of which is waited for.
Status bringLevels(GpuScene& scene, Renderer& renderer, const FrameOptions& frame, CommandRunner& runner) {
    for (std::uint64_t number = 2; scene.textureStream()->progress().textures > 0; ++number) {
        GLINT_TRY(const auto commands, runner.begin());
        GLINT_TRY([[maybe_unused]] const auto levels, scene.textureStream()->record(commands, number));
        GLINT_TRY_DO(renderer.record(commands, frame));
        GLINT_TRY_DO(runner.submitAndWait());
        scene.complete(number);
    }
    return okStatus();
}

Result<Times> measureOnce(const Ready& ready, Way way, const Arguments& arguments) {
    RendererOptions options;
    options.strategy = package::kStrategyUber;
    options.width = arguments.size.width;
    options.height = arguments.size.height;
    SceneView view = ready.data.view();
    view.streamsTextures = way == Way::Streamed;
    GLINT_TRY(auto runner, CommandRunner::create(ready.context->state()));
    GLINT_TRY(const auto commands, runner.begin());
    Times times;
    const base::Clock::time_point start = base::Clock::now();
    GLINT_TRY(const auto scene, way == Way::Blocking
                                    ? GpuScene::upload(*ready.context, *ready.package, view)
                                    : GpuScene::record(*ready.context, *ready.package, view, commands, 1));
    times.returned = base::millisecondsSince(start);
    GLINT_TRY(const auto renderer, Renderer::create(*ready.context, *ready.package, *scene, options));
    GLINT_TRY_DO(renderer->record(commands, ready.frame));
    GLINT_TRY_DO(runner.submitAndWait());
    times.firstFrame = base::millisecondsSince(start);
    scene->complete(1);
    if (way == Way::Streamed) {
        GLINT_TRY_DO(bringLevels(*scene, *renderer, ready.frame, runner));
    }
    times.allLevels = base::millisecondsSince(start);
    return times;
}

std::string spread(std::vector<Times>& all, double Times::*time) {
    std::ranges::sort(all, {}, time);
    return fmt::format("{:.1f} ({:.1f} to {:.1f})", all[all.size() / 2].*time, all.front().*time,
                       all.back().*time);
}

Status run(const Arguments& arguments) {
    GLINT_TRY(const auto ready, prepare(arguments, {}));
    constexpr std::pair<Way, const char*> kWays[] = {{Way::Blocking, "`upload()`"},
                                                     {Way::Recorded, "`record()`"},
                                                     {Way::Streamed, "`record()`, streamed"}};
    std::vector<Times> times[std::size(kWays)];
    // The driver's caches are warm after the first round, which does not count.
    for (int round = 0; round <= arguments.rounds; ++round) {
        for (std::size_t i = 0; i < std::size(kWays); ++i) {
            GLINT_TRY(const auto measured, measureOnce(*ready, kWays[i].first, arguments));
            if (round > 0) {
                times[i].push_back(measured);
            }
        }
    }
    fmt::print("{}: {}, {} rounds; medians in ms, with the least and the most\n\n", arguments.scene,
               ready->context->deviceName(), arguments.rounds);
    fmt::print("| way | the call returns | first frame | all levels |\n|---|--:|--:|--:|\n");
    for (std::size_t i = 0; i < std::size(kWays); ++i) {
        fmt::print("| {} | {} | {} | {} |\n", kWays[i].second, spread(times[i], &Times::returned),
                   spread(times[i], &Times::firstFrame), spread(times[i], &Times::allLevels));
    }
    return okStatus();
}

}  // namespace

}  // namespace glint

int main(int count, char** words) {
    glint::Arguments arguments;
    return glint::benchmarks::runProgram(
        "Measures how long a scene takes to its first frame, by the way in which it is uploaded.",
        {{"scene", &arguments.scene, "glTF file", glint::benchmarks::kNeeded},
         glint::benchmarks::roundsOption(arguments.rounds, "rounds of each way, which alternate"),
         glint::benchmarks::widthOption(arguments.size),
         glint::benchmarks::heightOption(arguments.size)},
        count, words, [&] { return glint::run(arguments); });
}
