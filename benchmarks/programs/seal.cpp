// glint_seal: compares a scene that is not edited, one that is, and one whose instances are sealed: their
// BLASes, their memory, and the time of a frame.
#include "base/clock.h"
#include "context/commands.h"
#include "gltf/import.h"
#include "program.h"
#include "scene/scene_store.h"

#include <glint/session/camera.h>
#include <glint/session/session.h>
#include <glint/session/textures.h>

#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace glint {

namespace {

struct Arguments {
    std::string scene;
    int rounds = 9;
    benchmarks::Size size{320, 180};
    bool sorted = false;
};

struct Way {
    std::string name;
    bool editable = false;
    bool sealed = false;
    std::unique_ptr<GpuScene> scene{};
    std::unique_ptr<Renderer> renderer{};
    std::vector<double> frames{};  // milliseconds of wall clock
};

Status drawOnce(Context& context, Way& way, const FrameOptions& frame) {
    GLINT_TRY(auto runner, CommandRunner::create(context.state()));
    GLINT_TRY(const auto commands, runner.begin());
    GLINT_TRY_DO(way.renderer->record(commands, frame));
    const base::Clock::time_point begin = base::Clock::now();
    GLINT_TRY_DO(runner.submitAndWait());
    way.frames.push_back(base::millisecondsSince(begin));
    way.renderer->finished(way.renderer->recordings());
    return okStatus();
}

// Records the edits that wait, and the compaction that follows. Returns the milliseconds of wall clock of the
// first recording and of its commands.
Result<double> settle(Context& context, GpuScene& scene, std::uint64_t& number) {
    double ms = 0.0;
    for (int i = 0; i < 2; ++i) {
        GLINT_TRY(auto runner, CommandRunner::create(context.state()));
        GLINT_TRY(const auto commands, runner.begin());
        const base::Clock::time_point begin = base::Clock::now();
        GLINT_TRY_DO(scene.editor()->record(commands, ++number));
        GLINT_TRY_DO(runner.submitAndWait());
        ms = i == 0 ? base::millisecondsSince(begin) : ms;
        scene.complete(number);
    }
    return ms;
}

// Prints how long it takes to seal all instances of a scene, and to unseal them by taking their meshes anew.
Status measureSeal(Context& context, GpuScene& scene) {
    SceneEditor& editor = *scene.editor();
    const SceneStore& store = *scene.state().store;
    std::vector<InstanceHandle> instances;
    store.instanceSlots.forEach(
        [&](InstanceHandle handle, const StoredInstance&) { instances.push_back(handle); });
    std::uint64_t number = 1;
    GLINT_TRY_DO(editor.seal(instances));
    GLINT_TRY(const double sealMs, settle(context, scene, number));
    for (const InstanceHandle instance : instances) {
        GLINT_TRY([[maybe_unused]] const auto report,
                  editor.setInstanceMesh(instance, store.instanceSlots.find(instance)->mesh));
    }
    GLINT_TRY(const double unsealMs, settle(context, scene, number));
    fmt::print("\nto seal all: {:.1f} ms; to unseal all: {:.1f} ms\n", sealMs, unsealMs);
    return okStatus();
}

Status run(const Arguments& arguments) {
    const compiler::Settings settings;
    GLINT_TRY(const auto context, Context::createHeadless(session::deviceOptions(settings)));
    GLINT_TRY(const auto scene, gltf::importScene(arguments.scene, {.keepImageFiles = true}));
    compiler::CompileSettings compile;
    compile.strategies = package::kStrategyUber;
    compile.tracers = context->handles().tracers;
    compile.plan.keys.alpha = package::AlphaPolicy::Stochastic;
    GLINT_TRY(const auto build, compiler::resolve(std::span(&scene, 1), compile));
    GLINT_TRY(const auto package, session::compileAndLoad(build));
    session::SceneViewData data = session::sceneView(settings, scene);
    GLINT_TRY(auto textures,
              session::loadTextures(scene, session::textureOptions(settings, *context, *package, nullptr)));
    session::usePackage(*package, scene, std::move(textures), data);
    FrameOptions frame;
    GLINT_TRY(const auto camera, session::chooseCamera(scene, data, "", arguments.size.aspect()));
    frame.camera = camera.view;
    RendererOptions options;
    options.strategy = package::kStrategyUber;
    options.width = arguments.size.width;
    options.height = arguments.size.height;
    SceneView view = data.view();
    view.traversalOrder =
        arguments.sorted ? SceneView::TraversalOrder::Auto : SceneView::TraversalOrder::Input;
    Way ways[] = {{"not editable"}, {"editable", true}, {"sealed", true, true}};
    for (Way& way : ways) {
        view.editable = way.editable;
        view.sealed = way.sealed;
        GLINT_TRY(way.scene, GpuScene::upload(*context, *package, view));
        GLINT_TRY(way.renderer, Renderer::create(*context, *package, *way.scene, options));
    }
    // The first round warms the caches.
    for (int round = 0; round <= arguments.rounds; ++round) {
        for (Way& way : ways) {
            GLINT_TRY_DO(drawOnce(*context, way, frame));
        }
    }
    fmt::print("{}: {}, {} x {}, {} rounds\n\n", arguments.scene, context->deviceName(), options.width,
               options.height, arguments.rounds);
    fmt::print(
        "| way | BLASes | KiB of them | instances of the TLAS | proved triangles | MiB in all | ms of a "
        "frame |\n"
        "|---|--:|--:|--:|--:|--:|--:|\n");
    for (Way& way : ways) {
        way.frames.erase(way.frames.begin());
        const GpuScene::Statistics& statistics = way.scene->statistics();
        fmt::print("| {} | {} | {:.1f} | {} | {} | {:.1f} | {:.2f} ({:.2f} to {:.2f}) |\n", way.name,
                   statistics.blasCount, static_cast<double>(statistics.blasBytes) / 1024,
                   way.scene->state().store->topLevel.records().count(),
                   statistics.provedOpaque + statistics.provedTransparent,
                   static_cast<double>(way.scene->allocatedBytes()) / 1048576,
                   benchmarks::quantile(way.frames, 0.5), benchmarks::quantile(way.frames, 0.0),
                   benchmarks::quantile(way.frames, 1.0));
    }
    return measureSeal(*context, *ways[1].scene);
}

}  // namespace

}  // namespace glint

int main(int count, char** words) {
    glint::Arguments arguments;
    return glint::benchmarks::runProgram(
        "Compares a scene that is not edited, one that is, and one whose instances are sealed.",
        {{"scene", &arguments.scene, "glTF file", glint::benchmarks::kNeeded},
         {"--sorted", &arguments.sorted, "triangles and instances are sorted, as for CPU drivers"},
         glint::benchmarks::roundsOption(arguments.rounds, "frames of each way, which alternate"),
         glint::benchmarks::widthOption(arguments.size),
         glint::benchmarks::heightOption(arguments.size)},
        count, words, [&] { return glint::run(arguments); });
}
