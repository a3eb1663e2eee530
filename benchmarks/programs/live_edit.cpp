// glint_live_edit: measures how long an edit of a pack's GLSL takes from the file to the picture. It runs
// `glint compile --watch` as a process of its own, renders the scene, and edits the file again and again.
#include "base/clock.h"
#include "base/files.h"
#include "base/json.h"
#include "gltf/import.h"
#include "materials/declarations.h"
#include "program.h"

#include <glint/package.h>
#include <glint/session/camera.h>
#include <glint/session/session.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <fcntl.h>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <sys/wait.h>
#include <system_error>
#include <thread>
#include <unistd.h>
#include <utility>
#include <vector>

namespace glint {

namespace {

namespace fs = std::filesystem;

struct Arguments {
    std::string glint;
    std::string scene;
    std::string pack;
    std::string file;
    std::string from;
    std::string folder;
    std::string strategy = "visibility";
    benchmarks::Size size{320, 180};
    int rounds = 5;
    bool noFallback = false;
    bool noOptimize = false;
    std::string json;
};

double processorTimeOf(clockid_t clock) {
    timespec time{};
    return clock_gettime(clock, &time) == 0
               ? 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec)
               : 0.0;
}

// `glint compile --watch`, which writes its lines to a file.
class Compiler {
public:
    Compiler(const Arguments& arguments, const fs::path& package, const std::string& tracer)
        : out_(package.string() + ".lines") {
        std::vector<std::string> words{
            arguments.glint, "compile",          arguments.scene, "-o",     package,
            "--strategy",    arguments.strategy, "--tracer",      tracer,   "--merge",
            "none",          "--materials",      arguments.pack,  "--watch"};
        if (!arguments.noFallback) {
            words.emplace_back("--fallback");
        }
        if (arguments.noOptimize) {
            words.emplace_back("--no-optimize");
        }
        std::error_code ignored;
        fs::remove(out_, ignored);  // of an earlier program
        child_ = fork();
        if (child_ == 0) {
            constexpr int kMode = 0600;
            std::vector<char*> pointers;
            for (std::string& word : words) {
                pointers.push_back(word.data());
            }
            pointers.push_back(nullptr);
            if (dup2(open(out_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, kMode), STDOUT_FILENO) >= 0) {
                execv(pointers[0], pointers.data());
            }
            _exit(127);
        }
    }
    Compiler(const Compiler&) = delete;
    Compiler& operator=(const Compiler&) = delete;
    ~Compiler() {
        kill(child_, SIGINT);
        waitpid(child_, nullptr, 0);
    }

    // Waits for the line of a run, counted from 1, and returns it.
    std::string line(std::size_t number) const {
        constexpr int kPatience = 60'000;
        const std::string start = fmt::format("{}. ", number);
        for (int i = 0; i < kPatience; ++i) {
            if (const Result<base::Bytes> bytes = base::readFile(out_)) {
                std::istringstream text{std::string(base::asText(*bytes))};
                for (std::string line; std::getline(text, line) && !text.eof();) {
                    if (line.starts_with(start)) {
                        return line;
                    }
                }
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        return {};
    }

    // Returns the processor time that the process has taken so far.
    double processorMs() const {
        clockid_t clock{};
        return clock_getcpuclockid(child_, &clock) == 0 ? processorTimeOf(clock) : 0.0;
    }

private:
    fs::path out_;
    pid_t child_ = -1;
};

// Returns the number that follows `word` in a line of the watch.
double numberAfter(const std::string& line, const std::string& word) {
    const std::size_t place = line.rfind(word);
    return place == std::string::npos ? 0.0 : std::strtod(line.c_str() + place + word.size(), nullptr);
}

constexpr std::array kParts{"notice", "read", "plan", "compile", "write", "load", "replace", "pipelines",
                            "first frame", "sum",
                            // These two are of the first frame, on the device.
                            "first cases", "cases",
                            // Processor time since the edit: of the compiler, and of this program.
                            "compiler", "renderer"};
// The parts of the way from the edit to a picture, in the order of kParts, milliseconds.
using Times = std::array<double, kParts.size()>;
enum Part : std::uint8_t {
    kNotice,
    kRead,
    kPlan,
    kCompile,
    kWrite,
    kLoad,
    kReplace,
    kPipelines,
    kFrame,
    kSum,
    kFirst,
    kCases,
    kCompiler,
    kRenderer,
};

// Follows one edit to its picture.
class Follower {
public:
    Follower(const Compiler& compiler, Package::Watch& packages, Renderer& renderer,
             const FrameOptions& frame)
        : compiler_(compiler), packages_(packages), renderer_(renderer), frame_(frame) {
        frame_.timing = Timing::Passes;
    }

    // Writes `text` to `file`, and returns once the new package is in use. `run` is that of the compiler.
    Result<Times> follow(const fs::path& file, const std::string& text, std::size_t run,
                         Renderer::Replacement& replaced) {
        const fs::path temporary = file.string() + ".edited";
        GLINT_TRY_DO(base::writeFile(temporary, text));
        start_ = base::Clock::now();
        compilerStart_ = compiler_.processorMs();
        rendererStart_ = processorTimeOf(CLOCK_PROCESS_CPUTIME_ID);
        fs::rename(temporary, file);
        GLINT_TRY(auto times, showNext(replaced));
        const std::string line = compiler_.line(run);
        addLine(line, times);
        fmt::print("<!-- {} -->\n", line);
        return times;
    }

private:
    // Waits for the next package and its first picture.
    Result<Times> showNext(Renderer::Replacement& replaced) {
        Times times{};
        std::shared_ptr<const Package> package;
        base::Clock::time_point begin;
        while (!package) {
            begin = base::Clock::now();
            GLINT_TRY(package, packages_.poll());
            if (!package) {
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            }
        }
        times[kCompiler] = compiler_.processorMs() - compilerStart_;
        // Until addLine() knows the other parts of this time.
        times[kNotice] = base::millisecondsBetween(start_, begin);
        times[kLoad] = base::millisecondsSince(begin);
        base::Clock::time_point last = base::Clock::now();
        const auto lap = [&] {
            const base::Clock::time_point now = base::Clock::now();
            return base::millisecondsBetween(std::exchange(last, now), now);
        };
        const std::uint64_t before = renderer_.replacementProgress().inUse;
        GLINT_TRY(replaced, renderer_.replacePackage(package));
        times[kReplace] = lap();
        // A program would draw all the time; here the compiler and the driver have the processor.
        while (!renderer_.replacementProgress().ready) {
            if (const std::optional<Diagnostic> error = renderer_.replacementProgress().error) {
                return *error;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        times[kPipelines] = lap();
        GLINT_TRY_DO(renderer_.renderSamples(frame_, 1));
        times[kFrame] = lap();
        times[kSum] = base::millisecondsBetween(start_, last);
        times[kRenderer] = processorTimeOf(CLOCK_PROCESS_CPUTIME_ID) - rendererStart_;
        if (renderer_.replacementProgress().inUse == before) {
            return makeError("live-edit", "", "the frame does not use the package that was ready");
        }
        GLINT_TRY(const auto passes, renderer_.timings());
        for (const PassTiming& pass : passes) {
            times[kFirst] += pass.pass == Pass::FirstCase ? pass.milliseconds : 0.0;
            times[kCases] += pass.pass == Pass::ShadeCase ? pass.milliseconds : 0.0;
        }
        return times;
    }

    // Divides the time until the package was there by what the compiler says about it.
    static void addLine(const std::string& line, Times& times) {
        times[kRead] = numberAfter(line, "read ");
        times[kPlan] = numberAfter(line, "plan ");
        times[kCompile] = numberAfter(line, "compile ");
        times[kWrite] = numberAfter(line, "write ");
        const double known = times[kRead] + times[kPlan] + times[kCompile] + times[kWrite];
        times[kNotice] = std::max(times[kNotice] - known, 0.0);
    }

    const Compiler& compiler_;
    Package::Watch& packages_;
    Renderer& renderer_;
    FrameOptions frame_;
    base::Clock::time_point start_;
    double compilerStart_ = 0.0;
    double rendererStart_ = 0.0;
};

base::Json toJson(const Times& times) {
    base::Json json = base::Json::object();
    for (std::size_t part = 0; part < kParts.size(); ++part) {
        json[kParts[part]] = times[part];
    }
    return json;
}

void printTable(const std::vector<Times>& rows) {
    fmt::print("| part | median, ms | least | most |\n|---|--:|--:|--:|\n");
    for (std::size_t part = 0; part < kParts.size(); ++part) {
        std::vector<double> values;
        for (const Times& row : rows) {
            values.push_back(row[part]);
        }
        fmt::print("| {} | {:.0f} | {:.0f} | {:.0f} |\n", kParts[part], benchmarks::quantile(values, 0.5),
                   benchmarks::quantile(values, 0.0), benchmarks::quantile(values, 1.0));
    }
}

// Prints the table, and writes the JSON that benchmarks/charts/live_edit_chart.py draws.
Status report(const Arguments& arguments, const std::string& device, const std::vector<Times>& edits) {
    base::Json list = base::Json::array();
    for (const Times& times : edits) {
        list.push_back({{"whole", toJson(times)}});
    }
    printTable(edits);
    if (arguments.json.empty()) {
        return okStatus();
    }
    const base::Json all = {{"device", device},
                            {"width", arguments.size.width},
                            {"height", arguments.size.height},
                            {"strategy", arguments.strategy},
                            {"fallback", !arguments.noFallback},
                            {"edits", std::move(list)}};
    return base::writeFile(arguments.json, all.dump(1) + "\n");
}

Status measure(const Arguments& arguments) {
    GLINT_TRY(const auto context, Context::createHeadless());
    compiler::Settings settings;
    settings.package = (fs::path(arguments.folder) / "package").string();
    GLINT_TRY(const auto model, materials::loadMaterialModel(std::vector<std::string>{arguments.pack}));
    gltf::ImportOptions import;
    import.decodeImages = true;
    import.materialModel = model;
    GLINT_TRY(const auto scene, gltf::importScene(arguments.scene, import));
    RendererOptions options;
    options.strategy = package::findStrategy(arguments.strategy)->strategy;
    options.width = arguments.size.width;
    options.height = arguments.size.height;
    options.backgroundPipelines = !arguments.noFallback;
    const bool queries = (context->handles().tracers & package::kTracerRayQuery) != 0;
    const Compiler compiler(arguments, settings.package, queries ? "ray-query" : "ray-pipeline");
    fmt::print("<!-- {} -->\n", compiler.line(1));
    Package::Watch packages(settings.package);
    GLINT_TRY(auto first, session::givenPackage(settings));
    GLINT_TRY(const auto uploaded,
              session::DeviceScene::upload(*context, std::move(first), session::makeSceneView(scene)));
    GLINT_TRY(const auto renderer, uploaded.makeRenderer(*context, options));
    renderer->waitForPipelines();
    FrameOptions frame;
    frame.camera = session::framingCamera(session::worldBounds(uploaded.data), arguments.size.aspect());
    GLINT_TRY_DO(renderer->renderSamples(frame, 1));
    GLINT_TRY(const auto bytes, base::readFile(arguments.file));
    const std::string original(base::asText(bytes));
    const std::size_t place = original.find(arguments.from);
    if (place == std::string::npos) {
        return makeError("live-edit", arguments.file, "the file lacks the text of --from");
    }
    std::vector<Times> edits;
    Renderer::Replacement replaced;
    Follower follower(compiler, packages, *renderer, frame);
    Status result = okStatus();
    for (int round = 0; round < arguments.rounds && result; ++round) {
        std::string text = original;
        // A number that no earlier round had, so that no cache knows it.
        const auto now = std::chrono::system_clock::now().time_since_epoch().count();
        text.replace(place, arguments.from.size(),
                     fmt::format("{} * {}.{:09}", arguments.from, 1, now % 1'000'000));
        const Result<Times> times =
            follower.follow(arguments.file, text, static_cast<std::size_t>(round) + 2, replaced);
        if (times) {
            edits.push_back(*times);
        } else {
            result = times.error();
        }
    }
    static_cast<void>(base::writeFile(arguments.file, original));
    GLINT_TRY_DO(result);
    fmt::print("\n{} cases; pipelines: {} made, {} kept; {} x {}, {} edits\n\n",
               uploaded.package->caseCount(), replaced.pipelinesMade, replaced.pipelinesKept,
               arguments.size.width, arguments.size.height, arguments.rounds);
    return report(arguments, context->deviceName(), edits);
}

}  // namespace

}  // namespace glint

int main(int count, char** words) {
    glint::Arguments arguments;
    return glint::benchmarks::runProgram(
        "Measures the way of an edit from a pack's GLSL to the picture, part by part.",
        {{"--glint", &arguments.glint, "the command", glint::benchmarks::kNeeded},
         {"--scene", &arguments.scene, "a scene that uses the pack", glint::benchmarks::kNeeded},
         {"--pack", &arguments.pack, "folder of the pack", glint::benchmarks::kNeeded},
         {"--file", &arguments.file, "the GLSL that is edited, and mended at the end",
          glint::benchmarks::kNeeded},
         {"--from", &arguments.from, "a number in that file, which the edits multiply",
          glint::benchmarks::kNeeded},
         {"--folder", &arguments.folder, "an existing folder for the package", glint::benchmarks::kNeeded},
         {"--strategy", &arguments.strategy, "name of the strategy"},
         glint::benchmarks::roundsOption(arguments.rounds, "edits"),
         {"--no-fallback", &arguments.noFallback,
          "compile no fallback, and make pipelines in replacePackage()"},
         {"--no-optimize", &arguments.noOptimize, "as of glint compile"},
         {"--json", &arguments.json, "a file for every edit's times"},
         glint::benchmarks::widthOption(arguments.size),
         glint::benchmarks::heightOption(arguments.size)},
        count, words, [&] { return glint::measure(arguments); });
}
