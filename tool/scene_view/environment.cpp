#include "image/image_file.h"

#include <glint/scene_view/environment.h>

#include <fmt/format.h>

namespace glint::scene_view {

namespace {

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

Result<std::unique_ptr<Environment>> loadEnvironment(Context& context, const std::string& file,
                                                     const EnvironmentOptions& options,
                                                     std::vector<Diagnostic>& notes) {
    GLINT_TRY(const auto image, image::readRadiance(file));
    Result<std::unique_ptr<Environment>> environment = Environment::create(context, image, options);
    if (!environment) {
        Diagnostic error = environment.error();
        error.where = file;
        return error;
    }
    const std::vector<Diagnostic> more = describe(file, image, (*environment)->statistics());
    notes.insert(notes.end(), more.begin(), more.end());
    return environment;
}

}  // namespace glint::scene_view
