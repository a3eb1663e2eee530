// glint_oracle: renders a scene in double precision and compares pictures of the device with it.
#include "base/files.h"
#include "gltf/import.h"
#include "image/compare.h"
#include "image/exr.h"
#include "image/image_file.h"
#include "oracle/scene/difference.h"
#include "oracle/scene/input.h"
#include "oracle/scene/report.h"
#include "oracle/scene/texels.h"
#include "oracle/transport/path_picture.h"

#include <glint/session/camera.h>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <exception>
#include <optional>
#include <string>

namespace {

using namespace glint;
using namespace glint::oracle;

struct Settings {
    SceneChoice choice;
    std::string size = "96x54";
    std::uint32_t samples = 1;
    std::uint32_t deviceSamples = 1;
    double mirrorRoughness = 0.05F;
    std::string against;
    std::string picture;
    std::string difference;
    std::string json;
    std::string texels;
    bool deviceTexels = false;
    bool devicePoints = false;
    std::string filtered;
    std::string writeTexels;
    std::uint32_t list = 0;
    // Of paths.
    std::string bounces;  // empty: the renderer with Glint's approximations
    std::string shadowThrough = "alpha";
    std::uint32_t rouletteFrom = PathSettings{}.rouletteFrom;
    bool noRoulette = false;
    LightSizes sizes;
    std::string environment;
    bool noSky = false;
    PathSampling sampling;
    std::string errors;
};

// The strata are repeated; the spread of the repeats gives the error.
constexpr int kRepeats = 4;

Strata strataOf(std::uint32_t samples) {
    return {std::max(static_cast<int>(std::lround(std::ceil(std::sqrt(samples / double{kRepeats})))), 1),
            kRepeats};
}

Result<SrgbTable> readTexels(const std::string& path) {
    const Result<LinearImage> picture = image::readImage(path);
    return picture ? texelsOf(*picture, path) : Result<SrgbTable>(picture.error());
}

Result<LinearImage> readPicture(const std::string& path, const Picture& truth) {
    Result<LinearImage> picture = image::readImage(path);
    if (picture && (picture->width != truth.width || picture->height != truth.height)) {
        return makeError("image-mismatch", path,
                         fmt::format("is not of {}x{} pixels", truth.width, truth.height),
                         "give both the same --size");
    }
    return picture;
}

Result<Difference> compare(const Settings& settings, const OracleInput& input, const SceneRenderer& renderer,
                           const Picture& truth, const LinearImage& device) {
    if (settings.samples > 1) {
        return meanDifference(device, truth, settings.deviceSamples);
    }
    std::optional<SceneRenderer> decoding;
    if (!settings.texels.empty()) {
        GLINT_TRY(const auto table, readTexels(settings.texels));
        decoding.emplace(input.scene, RendererSettings{defaultSky(), settings.mirrorRoughness, table});
    }
    LinearImage filtered;
    if (!settings.filtered.empty()) {
        GLINT_TRY(filtered, readPicture(settings.filtered, truth));
    }
    return centreDifference(device, truth, renderer, input.view,
                            {decoding ? &*decoding : nullptr, filtered.pixels.empty() ? nullptr : &filtered});
}

Result<std::uint32_t> bouncesOf(const std::string& text) {
    if (text == "unlimited") {
        return kUnlimited;
    }
    std::uint32_t bounces = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), bounces);
    if (error != std::errc() || end != text.data() + text.size() || bounces == kUnlimited) {
        return makeError("oracle-bounces", "", "\"" + text + "\" is no number of bounces",
                         "give a whole number, or unlimited");
    }
    return bounces;
}

Result<PathSky> skyOf(const std::string& environment, bool none) {
    if (environment.empty()) {
        return PathSky(none ? GradientSky{} : defaultSky());
    }
    GLINT_TRY(auto map, image::readImage(environment));
    for (auto& pixel : map.pixels) {
        for (float& channel : pixel) {
            channel = std::max(channel, 0.0F);
        }
    }
    return PathSky(std::move(map));
}

// Returns the standard errors as an image.
LinearImage errorsOf(const Picture& picture) {
    Picture errors = picture;
    for (Pixel& pixel : errors.pixels) {
        pixel.mean = pixel.error;
    }
    return toImage(errors);
}

// Renders all of light transport.
Status runPaths(const Settings& settings, const OracleInput& input) {
    GLINT_TRY(const auto bounces, bouncesOf(settings.bounces));
    GLINT_TRY(auto sky, skyOf(settings.environment, settings.noSky));
    PathSettings paths;
    paths.bounces = bounces;
    paths.shadowThrough = settings.shadowThrough == "opaque"  ? ShadowThrough::Opaque
                          : settings.shadowThrough == "glass" ? ShadowThrough::Glass
                                                              : ShadowThrough::Alpha;
    paths.rouletteFrom = settings.noRoulette ? kUnlimited : settings.rouletteFrom;
    paths.sizes = settings.sizes;
    if (settings.deviceTexels) {
        GLINT_TRY(const auto table, readTexels(settings.texels));
        paths.srgb = table;
    }
    Result<PathSky> secondSky = sky;
    const PathTracer tracer(input.scene, std::move(sky), paths);
    PathSampling sampling = settings.sampling;
    sampling.samples = settings.samples;
    const PathPicture truth = pathPicture(tracer, input.view, sampling);
    if (!settings.picture.empty()) {
        GLINT_TRY_DO(image::writeImage(settings.picture, toImage(truth.picture), 0.0));
    }
    if (!settings.errors.empty()) {
        GLINT_TRY_DO(image::writeImage(settings.errors, errorsOf(truth.picture), 0.0));
    }
    std::optional<PathDifference> difference;
    if (!settings.against.empty()) {
        GLINT_TRY(const auto device, readPicture(settings.against, truth.picture));
        paths.reflectsBelow = true;
        const PathTracer reflectingTracer(input.scene, std::move(*secondSky), paths);
        const PathPicture reflecting = pathPicture(reflectingTracer, input.view, sampling);
        difference = pathDifference(device, truth, &reflecting, input.scene, settings.deviceSamples);
        if (!settings.difference.empty()) {
            GLINT_TRY_DO(
                image::writeImage(settings.difference, image::differenceMap(device, toImage(truth.picture))));
        }
        std::fputs(toText(*difference, settings.list).c_str(), stdout);
    }
    return settings.json.empty()
               ? okStatus()
               : base::writeFile(settings.json, toJson(truth, sampling, difference ? &*difference : nullptr,
                                                       settings.deviceSamples));
}

Status run(const Settings& settings) {
    if (!settings.writeTexels.empty()) {
        return writeTexelScene(settings.writeTexels);
    }
    GLINT_TRY(const auto size, parseSize(settings.size));
    GLINT_TRY(const auto input, readOracleInput(settings.choice, size.width, size.height));
    if (!settings.bounces.empty()) {
        return runPaths(settings, input);
    }
    RendererSettings look{.sky = defaultSky(), .mirrorRoughness = settings.mirrorRoughness};
    if (settings.deviceTexels) {
        GLINT_TRY(const auto table, readTexels(settings.texels));
        look.srgb = table;
    }
    const SceneRenderer renderer(input.scene, look);
    const Picture truth = settings.devicePoints ? samplePicture(renderer, input.view, settings.samples)
                          : settings.samples == 1
                              ? centrePicture(renderer, input.view)
                              : meanPicture(renderer, input.view, strataOf(settings.samples));
    if (!settings.picture.empty()) {
        GLINT_TRY_DO(image::writeImage(settings.picture, toImage(truth), 0.0));
    }
    if (settings.against.empty()) {
        return okStatus();
    }
    GLINT_TRY(const auto device, readPicture(settings.against, truth));
    GLINT_TRY(const auto difference, compare(settings, input, renderer, truth, device));
    if (!settings.difference.empty()) {
        GLINT_TRY_DO(image::writeImage(settings.difference, image::differenceMap(device, toImage(truth))));
    }
    std::fputs(toText(difference, settings.list).c_str(), stdout);
    return settings.json.empty()
               ? okStatus()
               : base::writeFile(settings.json, toJson(difference, settings.samples, settings.deviceSamples));
}

int parseAndRun(int argc, char** argv) {
    CLI::App app{
        "Render a scene in double precision on the CPU, and compare a picture of glint render with it. "
        "Without "
        "--bounces: punctual lights with hard shadows, the sky, one mirror reflection, as glint render "
        "approximates "
        "them. With --bounces: all of light transport",
        "glint_oracle"};
    Settings settings;
    app.add_option("SCENE", settings.choice.path, "the scene, .gltf or .glb");
    CLI::Option* const bounces = app.add_option(
        "--bounces", settings.bounces,
        "trace paths: light scatters at this many surfaces and one more, or at any number: N|unlimited");
    app.add_option("--shadow-through", settings.shadowThrough,
                   "what rays to lights pass: opaque, nothing; alpha, BLEND; glass, clear glass, too, on the "
                   "straight "
                   "line")
        ->check(CLI::IsMember({"opaque", "alpha", "glass"}))
        ->capture_default_str()
        ->needs(bounces);
    app.add_option("--roulette", settings.rouletteFrom,
                   "the number of scatterings from which paths end at random, by their throughput")
        ->capture_default_str()
        ->needs(bounces);
    app.add_flag("--no-roulette", settings.noRoulette, "no path ends at random")->needs(bounces);
    app.add_option("--light-radius", settings.sizes.radius, "metres, of point and spot lights")
        ->check(CLI::Range(0.0, 1e6))
        ->needs(bounces);
    app.add_option("--sun-angle", settings.sizes.sunDiameter, "radians, the diameter of directional lights")
        ->check(CLI::Range(0.0, 3.0))
        ->needs(bounces);
    app.add_option("--environment", settings.environment, "the sky as an equirectangular map, .hdr or .exr")
        ->needs(bounces);
    app.add_flag("--no-sky", settings.noSky, "the sky is black")->needs(bounces)->excludes("--environment");
    app.add_option("--seed", settings.sampling.seed, "of the paths")->capture_default_str()->needs(bounces);
    app.add_option("--threads", settings.sampling.threads, "0: one for each core; all give the same picture")
        ->check(CLI::Range(0U, 1024U))
        ->capture_default_str()
        ->needs(bounces);
    app.add_option("--errors", settings.errors, "write the standard error of each pixel, .exr")
        ->needs(bounces);
    app.add_option("--size", settings.size, "WxH, pixels, 1 to 4096 each way")->capture_default_str();
    app.add_option(
           "--spp,--samples", settings.samples,
           "rays a pixel: 1, through its centre; more, in 4 repeats of strata, at least as many; paths, at "
           "random places")
        ->check(CLI::Range(1U, 1U << 20U))
        ->capture_default_str();
    app.add_flag("--device-points", settings.devicePoints, "they lie where samples of glint render do");
    app.add_option("--camera", settings.choice.camera, "as of glint render");
    app.add_option("--variant", settings.choice.variant, "as of glint render");
    app.add_option("--mirror-roughness", settings.mirrorRoughness,
                   "smoother surfaces are mirrors; glint render needs the same, and --max-roughness, too")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
    app.add_option("-o,--output", settings.picture, "write the truth: .exr, or .png at exposure 0");
    app.add_option(
        "--against", settings.against,
        "compare this picture, .exr: of glint render --effects shadow,reflection --texture-lod mip0 "
        "--alpha tested");
    app.add_option("--device-spp", settings.deviceSamples, "samples that picture was made with")
        ->check(CLI::Range(1U, 1U << 16U))
        ->capture_default_str();
    app.add_option("--diff", settings.difference, "write where they differ, .png");
    app.add_option("--json", settings.json, "write the comparison");
    app.add_option(
        "--texels", settings.texels,
        "how the device decodes sRGB texels, as a cause of differences: its picture, .exr, of the scene of "
        "--write-texels at 16x16");
    app.add_flag("--device-texels", settings.deviceTexels,
                 "the truth itself decodes texels as the device does")
        ->needs("--texels");
    app.add_option(
        "--filtered", settings.filtered,
        "the picture of --against by a device that filters textures in single precision, as a cause: of "
        "llvmpipe under GALLIVM_PERF=no_aos_sampling");
    app.add_option("--write-texels", settings.writeTexels,
                   "write that scene into this folder, and do nothing else");
    app.add_option("--list", settings.list, "print that many of the worst pixels")->capture_default_str();
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    if (settings.choice.path.empty() == settings.writeTexels.empty()) {
        std::fputs("glint_oracle: give a SCENE, or --write-texels\n", stderr);
        return 2;
    }
    const Status status = run(settings);
    if (!status) {
        std::fprintf(stderr, "%s\n", toString(status.error()).c_str());
        return 1;
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return parseAndRun(argc, argv);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "glint_oracle: %s\n", error.what());
        return 1;
    }
}
