// glint_swap_in: measures how long a scene of many cases takes to its first frame, with all pipelines made
// first and with pipelines that are made in the background, and how long the frames take while these swap in
// and while another package of the scene replaces the first.
#include "base/clock.h"
#include "emit/compile.h"
#include "emit/package/compiled_package.h"
#include "program.h"
#include "synthetic/cases_scene.h"

#include <glint/session/camera.h>
#include <glint/session/session.h>

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
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
    benchmarks::Size size{640, 320};
    std::uint32_t threads = 0;
    std::uint32_t after = 100;
    bool skipsAllFirst = false;
    bool replaces = false;
    bool noDraft = false;
    bool defersShadows = false;
    std::string packageFolder;
};

constexpr std::uint32_t kMostFrames = 1'000'000;

struct Bed {
    std::unique_ptr<Context> context;
    std::shared_ptr<const Package> other;  // the same scene, with other code in every shader that shades
    session::DeviceScene scene;
    FrameOptions frame;
};

// Writes the package to `folder`, too, unless that is empty.
Result<std::shared_ptr<const Package>> compiledPackage(const gltf::Scene& scene,
                                                       const compiler::CompileSettings& settings,
                                                       const std::string& folder) {
    GLINT_TRY(const auto compiled, compiler::compilePackage(scene, settings));
    if (!folder.empty()) {
        GLINT_TRY_DO(compiler::writePackage(compiled, folder));
    }
    return session::loadPackage(compiled);
}

Result<Bed> makeBed(const Arguments& arguments) {
    Bed bed;
    GLINT_TRY(bed.context, Context::createHeadless());
    synthetic::CasesOptions options;
    options.cases = arguments.cases;
    options.cost = arguments.cheap ? synthetic::Cost::Cheap : synthetic::Cost::Expensive;
    options.coherence =
        arguments.incoherent ? synthetic::Coherence::Incoherent : synthetic::Coherence::Coherent;
    options.lights = 1;
    options.aspect = arguments.size.aspect();
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
    if (arguments.defersShadows) {
        settings.shadows = package::ShadowPlacement::Deferred;
    }
    settings.emitGlsl = !arguments.packageFolder.empty();
    const bool coherent = options.coherence == synthetic::Coherence::Coherent;
    settings.effects = {false,
                        compiler::builtinEffects({"shadow", coherent ? "reflection" : "indirect-diffuse"})};
    GLINT_TRY(auto package, compiledPackage(scene, settings, arguments.packageFolder));
    if (arguments.replaces) {
        settings.energyCompensation = false;
        GLINT_TRY(bed.other, compiledPackage(scene, settings, ""));
    }
    GLINT_TRY(bed.scene,
              session::DeviceScene::upload(*bed.context, std::move(package), session::makeSceneView(scene)));
    GLINT_TRY(bed.frame.camera, session::sceneCamera(scene, 0, options.aspect));
    return bed;
}

using benchmarks::quantile;

// The events until every pipeline was in use. Milliseconds of wall clock.
struct Course {
    double createMs = 0.0;
    double firstFrameMs = 0.0;  // from the start of the renderer's creation to the end of the first frame
    double fixedMs = 0.0;       // the same, of the first frame that is no draft
    double completeMs = 0.0;    // the same, until a frame used the last pipeline
    std::vector<double> before;
    std::vector<double> after;
    double replaceCallMs = 0.0;     // of replacePackage() alone
    double replacedMs = 0.0;        // from that call to the end of the first frame with the other package
    std::vector<double> replacing;  // frames from that call on; the first has the call's time, too
};

// Draws a frame and appends its milliseconds, those since `begin`.
Status drawFrame(Renderer& renderer, const Bed& bed, base::Clock::time_point begin,
                 std::vector<double>& frames) {
    GLINT_TRY_DO(renderer.renderSamples(bed.frame, 1));
    frames.push_back(base::millisecondsSince(begin));
    return okStatus();
}

// Lets the other package replace the first, and draws until a frame has used it.
Status replace(Renderer& renderer, const Bed& bed, Course& course) {
    const base::Clock::time_point start = base::Clock::now();
    GLINT_TRY([[maybe_unused]] const auto replaced, renderer.replacePackage(bed.other));
    course.replaceCallMs = base::millisecondsSince(start);
    base::Clock::time_point begin = start;
    while (course.replacing.size() < kMostFrames) {
        GLINT_TRY_DO(drawFrame(renderer, bed, begin, course.replacing));
        const Renderer::ReplacementProgress progress = renderer.replacementProgress();
        if (progress.error) {
            return *progress.error;
        }
        if (progress.inUse > 0) {
            break;
        }
        begin = base::Clock::now();
    }
    course.replacedMs = base::millisecondsSince(start);
    return okStatus();
}

Result<Course> follow(const Bed& bed, const RendererOptions& options, std::uint32_t framesAfter) {
    Course course;
    const base::Clock::time_point start = base::Clock::now();
    GLINT_TRY(const auto renderer, bed.scene.makeRenderer(*bed.context, options));
    course.createMs = base::millisecondsSince(start);
    std::uint32_t frames = 0;
    bool complete = false;
    while (!complete && frames < kMostFrames) {
        GLINT_TRY_DO(drawFrame(*renderer, bed, base::Clock::now(), course.before));
        if (frames++ == 0) {
            course.firstFrameMs = base::millisecondsSince(start);
        }
        const Renderer::PipelineProgress progress = renderer->pipelineProgress();
        if (progress.error) {
            return *progress.error;
        }
        if (course.fixedMs == 0.0 && !progress.draft) {
            course.fixedMs = base::millisecondsSince(start);
        }
        complete = progress.adopted == progress.wanted;
    }
    course.completeMs = base::millisecondsSince(start);
    for (std::uint32_t i = 0; i < framesAfter; ++i) {
        GLINT_TRY_DO(drawFrame(*renderer, bed, base::Clock::now(), course.after));
    }
    if (bed.other) {
        GLINT_TRY_DO(replace(*renderer, bed, course));
    }
    return course;
}

// How many frames took up to each multiple of the median, and the longest.
void printHistogram(const char* name, const std::vector<double>& frames) {
    constexpr double kMultiples[] = {1.0, 1.1, 1.25, 1.5, 2.0, 3.0};
    const double median = quantile(frames, 0.5);
    fmt::print("| {} | {} | {:.2f} |", name, frames.size(), median);
    double least = 0.0;
    for (const double multiple : kMultiples) {
        const double most = multiple * median;
        fmt::print(" {} |",
                   std::ranges::count_if(frames, [&](double ms) { return ms > least && ms <= most; }));
        least = most;
    }
    fmt::print(" {} | {:.2f} |\n", std::ranges::count_if(frames, [&](double ms) { return ms > least; }),
               quantile(frames, 1.0));
}

// The frames while pipelines swap in, with all in use, and while a package is replaced.
void printHistograms(const Course& course) {
    fmt::print(
        "\nreplaced after {:.0f} ms; replacePackage() took {:.1f} ms, the last frame, which switches, {:.1f} "
        "ms\n\n"
        "| frames | number | median, ms | to the median | to 1.1 | to 1.25 | to 1.5 | to 2 | to 3 | above | "
        "most, ms |\n"
        "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n",
        course.replacedMs, course.replaceCallMs, course.replacing.back());
    // The first frame waits for its pipelines.
    printHistogram("pipelines swap in", {course.before.begin() + 1, course.before.end()});
    printHistogram("all in use", course.after);
    printHistogram("a package is replaced", course.replacing);
    fmt::print("\n");
}

void print(const std::string& strategy, const char* way, const Course& course) {
    const double median = quantile(course.before, 0.5);
    const double done = quantile(course.after, 0.5);
    const auto slow = std::ranges::count_if(course.before,
                                            [&](double milliseconds) { return milliseconds > 2.0 * median; });
    fmt::print(
        "| {} | {} | {:.0f} | {:.0f} | {:.0f} | {:.0f} | {} | {:.2f} | {:.2f} | {:.2f} | {} | {:.2f} |\n",
        strategy, way, course.createMs, course.firstFrameMs, course.fixedMs, course.completeMs,
        course.before.size(), median, quantile(course.before, 0.99), quantile(course.before, 1.0), slow,
        done);
    std::fflush(stdout);
}

Status run(const Arguments& arguments) {
    GLINT_TRY(const auto bed, makeBed(arguments));
    fmt::print("{} cases, {} x {}\n\n", bed.scene.package->caseCount(), arguments.size.width,
               arguments.size.height);
    fmt::print(
        "| strategy | pipelines | created, ms | first frame, ms | no draft, ms | all used, ms | frames until "
        "then | median, "
        "ms "
        "| 99 %, ms | most, ms | above twice the median | median afterwards, ms |\n"
        "|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    for (const std::string& name : arguments.strategies) {
        RendererOptions options;
        options.strategy = package::findStrategy(name)->strategy;
        options.width = arguments.size.width;
        options.height = arguments.size.height;
        options.pipelineThreads = arguments.threads;
        // In the background first: afterwards the driver may know the shaders.
        for (const bool background : {true, false}) {
            if (!background && arguments.skipsAllFirst) {
                continue;
            }
            options.backgroundPipelines = background;
            options.draft = !arguments.noDraft;
            const Result<Course> course = follow(bed, options, arguments.after);
            if (!course) {
                fmt::print(stderr, "{}: {}\n", name, toString(course.error()));
                continue;
            }
            print(name, background ? "background" : "first", *course);
            if (background && bed.other && course->before.size() > 1 && !course->after.empty()) {
                printHistograms(*course);
            }
        }
    }
    return okStatus();
}

}  // namespace

}  // namespace glint

int main(int count, char** words) {
    glint::Arguments arguments;
    return glint::benchmarks::runProgram(
        "Measures the time to the first frame of a scene with many cases, and the frames while pipelines "
        "swap in. Turn off the driver's shader cache before (MESA_SHADER_CACHE_DISABLE=true, "
        "__GL_SHADER_DISK_CACHE=0).",
        {{"--cases", &arguments.cases, "cases of the scene, 1 to 256"},
         {"--cheap", &arguments.cheap, "cheap materials instead of expensive ones"},
         {"--incoherent", &arguments.incoherent, "rays in all directions instead of a mirror's"},
         {"--strategies", &arguments.strategies, "strategies, by name"},
         {"--threads", &arguments.threads, "threads that make pipelines; 0: one for each core"},
         {"--after", &arguments.after, "frames after the last pipeline"},
         {"--no-draft", &arguments.noDraft, "wait for the fixed passes and the fallback"},
         {"--deferred-shadows", &arguments.defersShadows,
          "trace the shadow rays of hits in a pass of their own, so that cases are compute shaders"},
         {"--package", &arguments.packageFolder, "also write the package to this folder"},
         {"--background-only", &arguments.skipsAllFirst, "do not measure pipelines that are made first"},
         {"--replace", &arguments.replaces,
          "then replace the package by one without energy compensation, and print histograms of the "
          "frames"},
         glint::benchmarks::widthOption(arguments.size),
         glint::benchmarks::heightOption(arguments.size)},
        count, words, [&] { return glint::run(arguments); });
}
