// glint_swap_in: measures how long a scene of many cases takes to its first frame, with all pipelines made
// first and with pipelines that are made in the background, and how long the frames take while these swap in.
#include "base/clock.h"
#include "emit/compile.h"
#include "synthetic/cases_scene.h"

#include <glint/context.h>
#include <glint/renderer.h>
#include <glint/scene_view/camera.h>
#include <glint/scene_view/package.h>
#include <glint/scene_view/scene_view.h>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace glint {

namespace {

struct Arguments {
    int cases = 64;
    bool cheap = false;
    bool incoherent = false;
    std::vector<std::string> strategies{"uber", "visibility", "sorted-uber", "hit-shaders"};
    std::uint32_t width = 640;
    std::uint32_t height = 320;
    std::uint32_t threads = 0;
    std::uint32_t after = 100;
    bool skipsAllFirst = false;
};

constexpr std::uint32_t kMostFrames = 1'000'000;

struct Bed {
    std::unique_ptr<Context> context;
    std::unique_ptr<Package> package;
    std::unique_ptr<GpuScene> scene;
    FrameOptions frame;
};

Result<Bed> makeBed(const Arguments& arguments) {
    Bed bed;
    Result<std::unique_ptr<Context>> context = Context::createHeadless();
    if (!context) {
        return context.error();
    }
    bed.context = std::move(*context);
    synthetic::CasesOptions options;
    options.cases = arguments.cases;
    options.cost = arguments.cheap ? synthetic::Cost::Cheap : synthetic::Cost::Expensive;
    options.coherence =
        arguments.incoherent ? synthetic::Coherence::Incoherent : synthetic::Coherence::Coherent;
    options.lights = 1;
    options.aspect = static_cast<double>(arguments.width) / arguments.height;
    const gltf::Scene scene = synthetic::makeCasesScene(options);
    compiler::CompileSettings settings;
    settings.strategies = 0;
    for (const std::string& name : arguments.strategies) {
        const package::StrategyInfo* const strategy = package::findStrategy(name);
        if (strategy == nullptr) {
            return makeError("strategy", name, "there is no such strategy");
        }
        settings.strategies |= strategy->strategy;
    }
    settings.tracers = bed.context->handles().tracers;
    settings.plan.merge = compiler::MergePolicy::None;
    settings.plan.fallback = true;
    const bool coherent = options.coherence == synthetic::Coherence::Coherent;
    settings.effects = {false,
                        compiler::builtinEffects({"shadow", coherent ? "reflection" : "indirect-diffuse"})};
    const Result<compiler::CompiledPackage> compiled = compiler::compilePackage(scene, settings);
    if (!compiled) {
        return compiled.error();
    }
    Result<Package> package = scene_view::loadPackage(*compiled);
    if (!package) {
        return package.error();
    }
    bed.package = std::make_unique<Package>(std::move(*package));
    Result<std::unique_ptr<GpuScene>> uploaded =
        GpuScene::upload(*bed.context, *bed.package, scene_view::makeSceneView(scene).view());
    if (!uploaded) {
        return uploaded.error();
    }
    bed.scene = std::move(*uploaded);
    const Result<CameraView> camera = scene_view::sceneCamera(scene, 0, options.aspect);
    if (!camera) {
        return camera.error();
    }
    bed.frame.camera = *camera;
    return bed;
}

double quantile(std::vector<double> values, double share) {
    std::ranges::sort(values);
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

// What happened until every pipeline was in use. Milliseconds of wall clock.
struct Course {
    double createMs = 0.0;
    double firstFrameMs = 0.0;  // from the start of the renderer's creation to the end of the first frame
    double completeMs = 0.0;    // the same, until a frame used the last pipeline
    std::vector<double> before;
    std::vector<double> after;
};

Result<Course> follow(const Bed& bed, const RendererOptions& options, std::uint32_t framesAfter) {
    Course course;
    const base::Clock::time_point start = base::Clock::now();
    Result<std::unique_ptr<Renderer>> renderer =
        Renderer::create(*bed.context, *bed.package, *bed.scene, options);
    if (!renderer) {
        return renderer.error();
    }
    course.createMs = base::millisecondsSince(start);
    std::uint32_t frames = 0;
    bool complete = false;
    while (!complete && frames < kMostFrames) {
        const base::Clock::time_point begin = base::Clock::now();
        if (Status status = (*renderer)->renderSamples(bed.frame, 1); !status) {
            return status.error();
        }
        course.before.push_back(base::millisecondsSince(begin));
        if (frames++ == 0) {
            course.firstFrameMs = base::millisecondsSince(start);
        }
        const PipelineProgress progress = (*renderer)->pipelineProgress();
        if (progress.error) {
            return *progress.error;
        }
        complete = progress.adopted == progress.wanted;
    }
    course.completeMs = base::millisecondsSince(start);
    for (std::uint32_t i = 0; i < framesAfter; ++i) {
        const base::Clock::time_point begin = base::Clock::now();
        if (Status status = (*renderer)->renderSamples(bed.frame, 1); !status) {
            return status.error();
        }
        course.after.push_back(base::millisecondsSince(begin));
    }
    return course;
}

void print(const std::string& strategy, const char* way, const Course& course) {
    const double median = quantile(course.before, 0.5);
    const double done = quantile(course.after, 0.5);
    const auto slow = std::ranges::count_if(course.before,
                                            [&](double milliseconds) { return milliseconds > 2.0 * median; });
    fmt::print("| {} | {} | {:.0f} | {:.0f} | {:.0f} | {} | {:.2f} | {:.2f} | {:.2f} | {} | {:.2f} |\n",
               strategy, way, course.createMs, course.firstFrameMs, course.completeMs, course.before.size(),
               median, quantile(course.before, 0.99), quantile(course.before, 1.0), slow, done);
    std::fflush(stdout);
}

int run(const Arguments& arguments) {
    const Result<Bed> bed = makeBed(arguments);
    if (!bed) {
        fmt::print(stderr, "{}\n", toString(bed.error()));
        return 1;
    }
    fmt::print("{} cases, {} x {}\n\n", bed->package->caseCount(), arguments.width, arguments.height);
    fmt::print(
        "| strategy | pipelines | created, ms | first frame, ms | all used, ms | frames until then | median, "
        "ms "
        "| 99 %, ms | most, ms | above twice the median | median afterwards, ms |\n"
        "|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    for (const std::string& name : arguments.strategies) {
        RendererOptions options;
        options.strategy = package::findStrategy(name)->strategy;
        options.width = arguments.width;
        options.height = arguments.height;
        options.pipelineThreads = arguments.threads;
        // In the background first: afterwards the driver may know the shaders.
        for (const bool background : {true, false}) {
            if (!background && arguments.skipsAllFirst) {
                continue;
            }
            options.backgroundPipelines = background;
            const Result<Course> course = follow(*bed, options, arguments.after);
            if (!course) {
                fmt::print(stderr, "{}: {}\n", name, toString(course.error()));
                continue;
            }
            print(name, background ? "background" : "first", *course);
        }
    }
    return 0;
}

}  // namespace

}  // namespace glint

int main(int count, char** words) {
    glint::Arguments arguments;
    CLI::App app{
        "Measures the time to the first frame of a scene with many cases, and the frames while pipelines "
        "swap in. Turn off the driver's shader cache before (MESA_SHADER_CACHE_DISABLE=true, "
        "__GL_SHADER_DISK_CACHE=0)."};
    app.add_option("--cases", arguments.cases, "cases of the scene, 1 to 256")->capture_default_str();
    app.add_flag("--cheap", arguments.cheap, "cheap materials instead of expensive ones");
    app.add_flag("--incoherent", arguments.incoherent, "rays in all directions instead of a mirror's");
    app.add_option("--strategies", arguments.strategies, "strategies, by name")->capture_default_str();
    app.add_option("--width", arguments.width, "pixels")->capture_default_str();
    app.add_option("--height", arguments.height, "pixels")->capture_default_str();
    app.add_option("--threads", arguments.threads, "threads that make pipelines; 0: one for each core");
    app.add_option("--after", arguments.after, "frames after the last pipeline")->capture_default_str();
    app.add_flag("--background-only", arguments.skipsAllFirst,
                 "do not measure pipelines that are made first");
    CLI11_PARSE(app, count, words);
    try {
        return glint::run(arguments);
    } catch (const std::exception& error) {
        fmt::print(stderr, "glint_swap_in: {}\n", error.what());
        return 1;
    }
}
