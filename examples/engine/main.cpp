// A small renderer that uses Glint for its materials and its reflections, and nothing of Glint's scene or
// frame.
#include "frame.h"
#include "gpu.h"
#include "picture.h"
#include "world.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>
#include <string_view>
#include <vector>

namespace {

constexpr std::string_view kUsage =
    "usage: engine SCENE.gltf PACKAGE SHADERS OUTPUT.png|.exr [OPTION VALUE]...\n"
    "Renders frames of a scene, in which all but the floor turns, and writes the last.\n"
    "\n"
    "  --format full|compact   how vertices are stored (full)\n"
    "  --frames N              frames (1)\n"
    "  --size WIDTHxHEIGHT     of the picture (640x360)\n"
    "  --strategy NAME         of Glint's steps: uber, visibility, sorted-uber, hit-shaders (visibility)\n"
    "  --tracer NAME           ray-query or ray-pipeline (ray-query where the device has it)\n"
    "  --validation on|off     with the validation layers; their messages are an error (off)\n";

struct Options {
    std::string scene, package, shaders, output;
    engine::FrameSettings frame;
    std::optional<glint::package::Tracer> tracer;
    engine::Format format = engine::Format::Full;
    int frames = 1;
    bool validation = false;
};

bool setOption(Options& options, const std::string& name, const std::string& value) {
    if (name == "--format") {
        options.format = value == "compact" ? engine::Format::Compact : engine::Format::Full;
        return value == "compact" || value == "full";
    }
    if (name == "--frames") {
        options.frames = std::atoi(value.c_str());
        return options.frames > 0;
    }
    if (name == "--size") {
        return std::sscanf(value.c_str(), "%ux%u", &options.frame.width, &options.frame.height) == 2 &&
               options.frame.width - 1 < 16384 && options.frame.height - 1 < 16384;
    }
    if (name == "--strategy") {
        const auto strategy = glint::valueNamed<glint::package::Strategy>(value);
        options.frame.strategy = strategy.value_or(options.frame.strategy);
        return strategy.has_value();
    }
    if (name == "--tracer") {
        options.tracer = glint::valueNamed<glint::package::Tracer>(value);
        return options.tracer.has_value();
    }
    options.validation = value == "on";
    return name == "--validation" && (value == "on" || value == "off");
}

std::optional<Options> parse(const std::vector<std::string>& words) {
    if (words.size() < 4 || words.size() % 2 != 0) {
        return std::nullopt;
    }
    Options options{words[0], words[1], words[2], words[3], {}, {}};
    for (std::size_t i = 4; i < words.size(); i += 2) {
        if (!setOption(options, words[i], words[i + 1])) {
            return std::nullopt;
        }
    }
    return options;
}

// Turns all instances but the first, which is the floor, about their own vertical axis.
std::vector<std::array<float, 12>> turned(const engine::World& world, float angle) {
    std::vector<std::array<float, 12>> transforms;
    const float cosine = std::cos(angle);
    const float sine = std::sin(angle);
    for (const engine::Instance& instance : world.instances) {
        std::array<float, 12> rows = instance.objectToWorld;
        for (std::size_t row = 0; &instance != world.instances.data() && row < 3; ++row) {
            const float x = rows[4 * row];
            const float z = rows[4 * row + 2];
            rows[4 * row] = cosine * x - sine * z;
            rows[4 * row + 2] = sine * x + cosine * z;
        }
        transforms.push_back(rows);
    }
    return transforms;
}

engine::Picture render(engine::Gpu& gpu, const Options& options) {
    const glint::Result<glint::Package> package =
        glint::Package::load(std::filesystem::path(options.package));
    if (!package) {
        engine::fail(toString(package.error()));
    }
    engine::FrameSettings settings = options.frame;
    settings.tracer = options.tracer.value_or((gpu.tracers & glint::package::kTracerRayQuery) != 0
                                                  ? glint::package::kTracerRayQuery
                                                  : glint::package::kTracerRayPipeline);
    const engine::World world =
        engine::readGltf(options.scene, options.format,
                         static_cast<float>(settings.width) / static_cast<float>(settings.height));
    engine::Engine engine(gpu, *package, world, options.shaders, settings);
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < options.frames; ++i) {
        engine.frame(turned(world, 0.05F * static_cast<float>(i)));
    }
    engine::Picture picture = engine.picture();
    const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - begin;
    std::cout << gpu.name() << ", " << nameOf(settings.strategy) << ", " << nameOf(settings.tracer) << ": "
              << options.frames << " frames, " << elapsed.count() / options.frames << " ms each, "
              << engine.rays() << " reflection rays\n";
    return picture;
}

}  // namespace

int main(int argc, char** argv) {
    const std::optional<Options> options = parse({argv + 1, argv + argc});
    if (!options) {
        std::cerr << kUsage;
        return 2;
    }
    engine::Gpu gpu(options->validation, options->tracer.value_or(glint::package::kAllTracers));
    engine::writePicture(render(gpu, *options), options->output);
    if (gpu.messages() != 0) {
        engine::fail(std::to_string(gpu.messages()) + " messages of the validation layers");
    }
    return 0;
}
