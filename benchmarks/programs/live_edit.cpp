// glint_live_edit: measures how long an edit of a pack's GLSL takes from the file to the picture. It runs
// `glint compile --watch` as a process of its own, renders the scene, and edits the file again and again.
#include "base/clock.h"
#include "base/files.h"
#include "gltf/import.h"
#include "materials/packs.h"

#include <glint/context.h>
#include <glint/package_watch.h>
#include <glint/renderer.h>
#include <glint/scene_view/camera.h>
#include <glint/scene_view/scene_view.h>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <fcntl.h>
#include <filesystem>
#include <memory>
#include <string>
#include <sys/wait.h>
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
    std::uint32_t width = 320;
    std::uint32_t height = 180;
    int rounds = 5;
    bool noFallback = false;
};

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

    // Waits for the line of a run, counted from 1.
    std::string line(std::size_t number) const {
        constexpr int kPatience = 60'000;
        for (int i = 0; i < kPatience; ++i) {
            if (const Result<base::Bytes> bytes = base::readFile(out_)) {
                std::string_view text = base::asText(*bytes);
                for (std::size_t n = 1; n < number && !text.empty(); ++n) {
                    text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
                }
                if (const std::size_t end = text.find('\n'); end != std::string_view::npos) {
                    return std::string(text.substr(0, end));
                }
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        return {};
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

constexpr std::array kParts{"notice", "read",    "plan",      "compile",     "write",
                            "load",   "replace", "pipelines", "first frame", "sum"};
using Times = std::array<double, kParts.size()>;

// The parts of one edit's way, in the order of kParts, milliseconds.
Result<Times> follow(const Compiler& compiler, PackageWatch& packages, Renderer& renderer,
                     const FrameOptions& frame, const fs::path& file, const std::string& text,
                     std::size_t run, PackageReplacement& replaced) {
    const fs::path temporary = file.string() + ".edited";
    if (Status status = base::writeFile(temporary, text); !status) {
        return status.error();
    }
    const base::Clock::time_point start = base::Clock::now();
    fs::rename(temporary, file);
    std::shared_ptr<const Package> package;
    double stampMs = 0.0;
    double loadMs = 0.0;
    const std::uint64_t before = renderer.replacementProgress().inUse;
    base::Clock::time_point replacedAt;
    double replaceMs = 0.0;
    double readyMs = -1.0;
    while (renderer.replacementProgress().inUse == before) {
        if (!package) {
            const base::Clock::time_point begin = base::Clock::now();
            Result<std::shared_ptr<const Package>> polled = packages.poll();
            if (!polled) {
                return polled.error();
            }
            package = *polled;
            if (package) {
                stampMs = base::millisecondsBetween(start, begin);
                loadMs = base::millisecondsSince(begin);
                const base::Clock::time_point began = base::Clock::now();
                Result<PackageReplacement> result = renderer.replacePackage(package);
                if (!result) {
                    return result.error();
                }
                replaced = *result;
                replaceMs = base::millisecondsSince(began);
                replacedAt = base::Clock::now();
            }
        }
        const ReplacementProgress progress = renderer.replacementProgress();
        if (progress.error) {
            return *progress.error;
        }
        if (package && progress.ready && readyMs < 0.0) {
            readyMs = base::millisecondsSince(replacedAt);
        }
        // A program would draw all the time; here the compiler and the driver have the processor.
        if (package && progress.ready) {
            if (Status status = renderer.renderSamples(frame, 1); !status) {
                return status.error();
            }
        } else {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    }
    const double sum = base::millisecondsSince(start);
    const std::string line = compiler.line(run);
    Times times{};
    times[1] = numberAfter(line, "read ");
    times[2] = numberAfter(line, "plan ");
    times[3] = numberAfter(line, "compile ");
    times[4] = numberAfter(line, "write ");
    times[0] = std::max(stampMs - (times[1] + times[2] + times[3] + times[4]), 0.0);
    times[5] = loadMs;
    times[6] = replaceMs;
    times[7] = readyMs;
    times[9] = sum;
    times[8] = sum - stampMs - loadMs - replaceMs - readyMs;
    fmt::print("<!-- {} -->\n", line);
    return times;
}

Status measure(const Arguments& arguments) {
    Result<std::unique_ptr<Context>> context = Context::createHeadless();
    if (!context) {
        return context.error();
    }
    const fs::path package = fs::path(arguments.folder) / "package";
    const Result<const materials::MaterialModel*> model =
        materials::loadMaterialModel(std::vector<std::string>{arguments.pack});
    if (!model) {
        return model.error();
    }
    gltf::ImportOptions import;
    import.decodeImages = true;
    import.materialModel = *model;
    const Result<gltf::Scene> scene = gltf::importScene(arguments.scene, import);
    if (!scene) {
        return scene.error();
    }
    RendererOptions options;
    options.strategy = package::findStrategy(arguments.strategy)->strategy;
    options.width = arguments.width;
    options.height = arguments.height;
    options.backgroundPipelines = !arguments.noFallback;
    const bool queries = ((*context)->handles().tracers & package::kTracerRayQuery) != 0;
    const Compiler compiler(arguments, package, queries ? "ray-query" : "ray-pipeline");
    fmt::print("<!-- {} -->\n", compiler.line(1));
    PackageWatch packages(package);
    Result<Package> first = Package::load(package);
    if (!first) {
        return first.error();
    }
    Result<std::unique_ptr<GpuScene>> uploaded =
        GpuScene::upload(**context, *first, scene_view::makeSceneView(*scene).view());
    if (!uploaded) {
        return uploaded.error();
    }
    Result<std::unique_ptr<Renderer>> renderer = Renderer::create(**context, *first, **uploaded, options);
    if (!renderer) {
        return renderer.error();
    }
    (*renderer)->waitForPipelines();
    const double aspect = static_cast<double>(arguments.width) / arguments.height;
    const scene_view::SceneViewData data = scene_view::makeSceneView(*scene);
    FrameOptions frame;
    frame.camera = scene_view::framingCamera(scene_view::worldBounds(data), aspect);
    if (Status status = (*renderer)->renderSamples(frame, 1); !status) {
        return status;
    }
    const Result<base::Bytes> bytes = base::readFile(arguments.file);
    if (!bytes) {
        return bytes.error();
    }
    const std::string original(base::asText(*bytes));
    const std::size_t place = original.find(arguments.from);
    if (place == std::string::npos) {
        return makeError("live-edit", arguments.file, "the file lacks the text of --from");
    }
    std::vector<Times> rows;
    PackageReplacement replaced;
    for (int round = 0; round < arguments.rounds; ++round) {
        std::string text = original;
        // A number that no earlier round had, so that no cache knows it.
        const auto now = std::chrono::system_clock::now().time_since_epoch().count();
        text.replace(place, arguments.from.size(),
                     fmt::format("{} * {}.{:09}", arguments.from, 1, now % 1'000'000));
        Result<Times> times = follow(compiler, packages, **renderer, frame, arguments.file, text,
                                     static_cast<std::size_t>(round) + 2, replaced);
        if (!times) {
            static_cast<void>(base::writeFile(arguments.file, original));
            return times.error();
        }
        rows.push_back(*times);
    }
    static_cast<void>(base::writeFile(arguments.file, original));
    fmt::print("\n{} cases; pipelines: {} made, {} kept; {} x {}, {} edits\n\n", (*first).caseCount(),
               replaced.pipelinesMade, replaced.pipelinesKept, arguments.width, arguments.height,
               arguments.rounds);
    fmt::print("| part | median, ms | least | most |\n|---|--:|--:|--:|\n");
    for (std::size_t part = 0; part < kParts.size(); ++part) {
        std::vector<double> values;
        for (const Times& row : rows) {
            values.push_back(row[part]);
        }
        std::ranges::sort(values);
        fmt::print("| {} | {:.0f} | {:.0f} | {:.0f} |\n", kParts[part], values[values.size() / 2],
                   values.front(), values.back());
    }
    return okStatus();
}

}  // namespace

}  // namespace glint

int main(int count, char** words) {
    glint::Arguments arguments;
    CLI::App app{"Measures the way of an edit from a pack's GLSL to the picture, part by part."};
    app.add_option("--glint", arguments.glint, "the command")->required();
    app.add_option("--scene", arguments.scene, "a scene that uses the pack")->required();
    app.add_option("--pack", arguments.pack, "folder of the pack")->required();
    app.add_option("--file", arguments.file, "the GLSL that is edited, and mended at the end")->required();
    app.add_option("--from", arguments.from, "a number in that file, which the edits multiply")->required();
    app.add_option("--folder", arguments.folder, "an existing folder for the package")->required();
    app.add_option("--strategy", arguments.strategy, "name of the strategy")->capture_default_str();
    app.add_option("--width", arguments.width, "pixels")->capture_default_str();
    app.add_option("--height", arguments.height, "pixels")->capture_default_str();
    app.add_option("--rounds", arguments.rounds, "edits")->capture_default_str();
    app.add_flag("--no-fallback", arguments.noFallback,
                 "compile no fallback, and make pipelines in replacePackage()");
    CLI11_PARSE(app, count, words);
    try {
        if (const glint::Status status = glint::measure(arguments); !status) {
            fmt::print(stderr, "{}\n", toString(status.error()));
            return 1;
        }
        return 0;
    } catch (const std::exception& error) {
        fmt::print(stderr, "glint_live_edit: {}\n", error.what());
        return 1;
    }
}
