#include "cli/environment.h"

#include "image/image_file.h"

#include <fmt/format.h>

#include <numbers>

namespace glint {

namespace {

constexpr double kMaxIntensity = 1e9;
constexpr const char* kMap = "--environment";
constexpr const char* kRotation = "--environment-rotation";
constexpr const char* kMapIntensity = "--environment-intensity";

// Returns warnings about the file, and notes about how it is used.
std::vector<Diagnostic> describe(const std::string& file, const LinearImage& image,
                                 const Environment::Statistics& statistics) {
    std::vector<Diagnostic> notes;
    if (image.width != 2 * image.height) {
        notes.push_back(makeWarning("environment-aspect", file,
                                    fmt::format("is {} x {}: an equirectangular map is twice as wide as high",
                                                image.width, image.height),
                                    "check that it shows the whole sphere"));
    }
    if (statistics.negativePixels > 0) {
        notes.push_back(makeWarning(
            "environment-negative", file,
            fmt::format("{} pixels have negative radiance, which is taken as 0", statistics.negativePixels),
            "check the program that made it"));
    }
    if (statistics.width != image.width || statistics.height != image.height) {
        notes.push_back({Severity::Note, "environment-resampled", file,
                         fmt::format("is {} x {}, and resampled to {} x {}", image.width, image.height,
                                     statistics.width, statistics.height),
                         ""});
    }
    return notes;
}

}  // namespace

void EnvironmentArguments::apply(FrameOptions& frame) const {
    frame.environmentRotation = static_cast<float>(rotation / 180.0 * std::numbers::pi);
    frame.environmentIntensity = static_cast<float>(intensity);
}

void addEnvironmentOptions(CLI::App& command, EnvironmentArguments& arguments) {
    const std::string group = "Environment";
    CLI::Option& file =
        addText(command, kMap, arguments.file, "FILE",
                "light the scene by this equirectangular map, .hdr or\n.exr, instead of a gradient");
    file.check(CLI::Validator(
                   [](const std::string& text) {
                       const Result<RadianceFormat> format = radianceFormat(text);
                       return format ? std::string() : "\"" + text + "\" does not end in .hdr or .exr";
                   },
                   ""))
        ->group(group);
    addReal(command, kRotation, arguments.rotation, -360.0, 360.0,
            "degrees about +Y, counter-clockwise as seen from above\n(-360 to 360, default: 0; needs "
            "--environment)")
        .group(group);
    addReal(command, kMapIntensity, arguments.intensity, 0.0, kMaxIntensity,
            "factor of the map's radiance (0 to 1e9, default: 1; needs\n"
            "--environment)")
        .group(group);
}

void checkEnvironmentOptions(const CLI::App& command) {
    for (const char* option : {kRotation, kMapIntensity}) {
        if (command.count(option) > 0 && command.count(kMap) == 0) {
            throw CLI::ValidationError(option, "needs --environment");
        }
    }
}

Result<std::unique_ptr<Environment>> loadEnvironment(Context& context, const std::string& file,
                                                     std::vector<Diagnostic>& notes) {
    const Result<LinearImage> image = readRadiance(file);
    if (!image) {
        return image.error();
    }
    Result<std::unique_ptr<Environment>> environment = Environment::create(context, *image);
    if (!environment) {
        Diagnostic error = environment.error();
        error.where = file;
        return error;
    }
    const std::vector<Diagnostic> more = describe(file, *image, (*environment)->statistics());
    notes.insert(notes.end(), more.begin(), more.end());
    return environment;
}

}  // namespace glint
