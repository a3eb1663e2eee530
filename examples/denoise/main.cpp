// Draws a scene at few samples, filters it by its layers, and compares it with many samples without the
// filter.
#include "denoiser.h"
#include "image/compare.h"
#include "image/image_file.h"
#include "settings/descriptor.h"

#include <glint/measure/target.h>
#include <glint/session/camera.h>
#include <glint/session/session.h>
#include <glint/session/textures.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace {

// Writes a message to stderr and ends the program with 1.
[[noreturn]] void fail(const std::string& message) {
    std::cerr << "denoise: " << message << "\n";
    std::exit(1);
}

constexpr std::string_view kUsage =
    "usage: denoise SCENE.gltf OUTPUT.png|.exr [OPTION VALUE]...\n"
    "Draws frames of a few samples, filters them, writes the last, and compares it with pictures without the "
    "filter.\n"
    "\n"
    "  --frames N            frames that are filtered, each with those before it (1)\n"
    "  --samples N           samples of a pixel in each frame (4)\n"
    "  --many N              samples of the picture that they are compared with (64)\n"
    "  --reference N         samples of the picture that is taken for the truth (1024); 0: no comparison\n"
    "  --turn DEGREES        the camera turns by that much from frame to frame (0)\n"
    "  --share X             least weight of a new frame, 0 to 1 (0.04)\n"
    "  --exposure EV         stops, of PNG files (0)\n"
    "  --wavelets N          passes of the wavelet, 0 to 8 (5)\n"
    "  --validation on|off   with the validation layers; their messages are an error (off)\n"
    "\n"
    "Every other option is a setting of `glint render`, such as --effects, --size, --sun-angle or "
    "--bounces.\n";

struct Options {
    std::string scene, output;
    glint::compiler::Settings settings;
    std::uint32_t frames = 1;
    std::uint32_t samples = 4;
    std::uint32_t many = 64;
    std::uint32_t reference = 1024;
    double turn = 0.0;
    denoise::FilterSettings filter;
    double exposure = 0.0;
};

bool setOption(Options& options, std::string_view name, const std::string& value) {
    std::int64_t whole = 0;
    const std::pair<std::string_view, std::uint32_t*> numbers[] = {{"--frames", &options.frames},
                                                                   {"--samples", &options.samples},
                                                                   {"--many", &options.many},
                                                                   {"--reference", &options.reference}};
    for (const auto& [option, number] : numbers) {
        if (name == option) {
            const bool valid =
                glint::compiler::parseWhole(value, number == &options.reference ? 0 : 1, 1 << 20, whole);
            *number = static_cast<std::uint32_t>(whole);
            return valid;
        }
    }
    if (name == "--turn") {
        return glint::compiler::parseReal(value, -90.0, 90.0, options.turn);
    }
    if (name == "--exposure") {
        return glint::compiler::parseReal(value, -32.0, 32.0, options.exposure);
    }
    if (name == "--share") {
        double alpha = 0.0;
        const bool valid = glint::compiler::parseReal(value, 0.0, 1.0, alpha);
        options.filter.alpha = static_cast<float>(alpha);
        return valid;
    }
    if (name == "--wavelets") {
        const bool valid = glint::compiler::parseWhole(value, 0, 8, whole);
        options.filter.wavelets = static_cast<std::uint32_t>(whole);
        return valid;
    }
    if (name == "--validation") {
        options.settings.validate = value == "on";
        return value == "on" || value == "off";
    }
    for (const glint::compiler::Descriptor& row : glint::compiler::settingsTable()) {
        if ((row.commands & glint::compiler::kOfRender) != 0 && name == "--" + std::string(row.name)) {
            const std::string complaint = complaintAbout(row, value);
            if (!complaint.empty() && row.values.form != glint::compiler::ValueForm::List) {
                fail(std::string(name) + ": " + complaint);
            }
            row.values.set(options.settings, value);
            return true;
        }
    }
    return false;
}

std::optional<Options> parse(const std::vector<std::string>& words) {
    if (words.size() < 2 || words.size() % 2 != 0) {
        return std::nullopt;
    }
    Options options;
    options.scene = words[0];
    options.output = words[1];
    for (std::size_t i = 2; i < words.size(); i += 2) {
        if (!setOption(options, words[i], words[i + 1])) {
            return std::nullopt;
        }
    }
    return options;
}

// Returns the value, or ends the program with the error.
template <typename Value>
Value valueOf(glint::Result<Value> result) {
    if (!result) {
        fail(toString(result.error()));
    }
    return std::move(*result);
}

void succeed(const glint::Status& status) {
    if (!status) {
        fail(toString(status.error()));
    }
}

double millisecondsSince(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

// Turns a camera about its own upward axis.
glint::CameraView turned(glint::CameraView camera, double degrees) {
    const double angle = degrees * 3.14159265358979323846 / 180.0;
    const std::array<float, 3> f = camera.forward;
    const std::array<float, 3> u = camera.up;
    const std::array<float, 3> right{f[1] * u[2] - f[2] * u[1], f[2] * u[0] - f[0] * u[2],
                                     f[0] * u[1] - f[1] * u[0]};
    for (std::size_t i = 0; i < 3; ++i) {
        camera.forward[i] = static_cast<float>(std::cos(angle) * f[i] + std::sin(angle) * right[i]);
    }
    return camera;
}

void printRow(const std::string& what, const glint::LinearImage& image, const glint::LinearImage& reference,
              double samplesMs, double filterMs) {
    const auto difference = valueOf(glint::image::compareImages(image, reference, what, "the truth"));
    std::printf("%-24s %10.5f %10.5f %12.1f %12.1f\n", what.c_str(), difference.relMse, difference.rmse,
                samplesMs, filterMs);
}

void run(Options& options) {
    namespace session = glint::session;
    glint::compiler::Settings& settings = options.settings;
    const session::Opened opened = valueOf(session::open(options.scene, settings, nullptr));
    const glint::gltf::Scene& scene = opened.scene;
    session::SceneViewData data = session::sceneView(settings, scene);
    const std::uint32_t width = settings.renderer.width;
    const std::uint32_t height = settings.renderer.height;
    const auto camera =
        valueOf(session::chooseCamera(scene, data, settings.camera, static_cast<double>(width) / height));
    const auto context = valueOf(glint::Context::createHeadless(session::deviceOptions(settings)));
    const auto compile =
        [&](const std::vector<std::string>& layers) -> glint::Result<std::shared_ptr<const glint::Package>> {
        settings.compile.layers = layers;
        GLINT_TRY(const auto target, glint::measure::targetOf(settings, *context, nullptr, scene));
        GLINT_TRY(const auto build, glint::compiler::resolve(std::span(&scene, 1), settings, target));
        return session::compileAndLoad(build);
    };
    std::vector<std::string> layers = denoise::wantedLayers();
    for (const std::string& layer : denoise::imageLayers()) {
        layers.push_back(layer);
    }
    auto compiled = compile(layers);
    if (!compiled && compiled.error().id == "layer-effect") {
        compiled = compile(denoise::wantedLayers());  // no effect shows points
    }
    const auto package = valueOf(std::move(compiled));
    session::usePackage(
        *package, scene,
        valueOf(session::loadTextures(scene, session::textureOptions(settings, *context, *package, nullptr))),
        data);
    const auto sky = session::chooseSky(settings, scene, data);
    const auto uploaded = valueOf(session::DeviceScene::upload(*context, package, std::move(data)));

    // Each frame is a picture of its own. Its layers are means over its samples.
    glint::RendererOptions rendererOptions = session::rendererOptions(settings);
    rendererOptions.accumulate = options.samples > 1;
    const auto renderer = valueOf(uploaded.makeRenderer(*context, rendererOptions));
    options.filter.samples = options.samples;
    const auto denoiser =
        valueOf(denoise::Denoiser::create(*context, *renderer, width, height, options.filter));
    glint::FrameOptions frame = session::frameOptions(settings, camera.view, sky, nullptr);
    glint::LinearImage filtered;
    double samplesMs = 0.0;  // of the last frame
    for (std::uint32_t i = 0; i < options.frames; ++i) {
        frame.camera = turned(camera.view, options.turn * (static_cast<double>(i) - (options.frames - 1)));
        // The seed shifts the pixels' samples and all random numbers.
        frame.seed = i + 1;
        const auto begin = std::chrono::steady_clock::now();
        succeed(renderer->renderSamples(frame, options.samples));
        samplesMs = millisecondsSince(begin);
        filtered = valueOf(denoiser->filter());
    }
    succeed(glint::image::writeImage(options.output, filtered, options.exposure));
    std::printf("%s, %u x %u, filter: %.1f MiB of images\n", context->deviceName().c_str(), width, height,
                static_cast<double>(denoiser->bytes()) / (1024.0 * 1024.0));
    if (options.reference > 0) {
        rendererOptions.accumulate = true;
        const auto means = valueOf(uploaded.makeRenderer(*context, rendererOptions));
        const auto mean = [&](std::uint32_t samples, std::uint32_t seed, double& milliseconds) {
            glint::FrameOptions many = session::frameOptions(settings, camera.view, sky, nullptr);
            many.seed = seed;
            const auto begin = std::chrono::steady_clock::now();
            glint::LinearImage image = valueOf(means->render(many, samples));
            milliseconds = millisecondsSince(begin);
            return image;
        };
        double milliseconds = 0.0;
        const glint::LinearImage truth = mean(options.reference, 7777, milliseconds);
        std::printf("%-24s %10s %10s %12s %12s\n", "picture", "relMSE", "RMSE", "samples ms", "filter ms");
        const std::string few = std::to_string(options.samples) + " samples";
        printRow(few + ", filtered", filtered, truth, samplesMs, denoiser->milliseconds());
        const glint::LinearImage plain = mean(options.samples, 1, milliseconds);
        printRow(few, plain, truth, milliseconds, 0.0);
        const glint::LinearImage many = mean(options.many, 1, milliseconds);
        printRow(std::to_string(options.many) + " samples", many, truth, milliseconds, 0.0);
    }
    const std::vector<std::string> messages = context->validationMessages();
    if (!messages.empty()) {
        fail(messages.front());
    }
}

}  // namespace

int main(int argc, char** argv) {
    std::optional<Options> options = parse({argv + 1, argv + argc});
    if (!options) {
        std::cerr << kUsage;
        return 2;
    }
    run(*options);
    return 0;
}
