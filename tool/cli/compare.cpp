// glint compare: measures how far two images differ.
#include "image/compare.h"

#include "base/files.h"
#include "cli/command_line.h"
#include "cli/options/options.h"
#include "cli/report.h"
#include "cli/table.h"
#include "image/image_file.h"
#include "image/tone.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>

namespace glint::cli {

namespace {

struct CompareArguments {
    std::string image;
    std::string reference;
    std::string diff;
    std::optional<double> maxError;
};

constexpr const char* kChannels[] = {"red", "green", "blue"};

base::Json toJson(const image::LargestError& error) {
    return {{"value", error.value}, {"x", error.x}, {"y", error.y}, {"channel", kChannels[error.channel]}};
}

// Returns the pixels as a display shows them. A PNG already has them in that form.
LinearImage shown(const std::string& path, const LinearImage& image, double exposure) {
    const Result<image::ImageFormat> format = image::imageFormat(path);
    return format && *format == image::ImageFormat::Png ? image : image::displayedImage(image, exposure);
}

// Measures FLIP with the exposure that `glint render` would choose for the reference, or for the image if the
// reference is a PNG.
double measureFlip(const CompareArguments& arguments, const LinearImage& image,
                   const LinearImage& reference) {
    const Result<image::ImageFormat> format = image::imageFormat(arguments.reference);
    const bool hasRadiance = format && *format == image::ImageFormat::Exr;
    const double exposure = image::automaticExposure(hasRadiance ? reference : image);
    return image::flipMean(image::flipMap(shown(arguments.image, image, exposure),
                                          shown(arguments.reference, reference, exposure)));
}

// The PSNR of equal images is infinite. JSON has no infinity, so it is null.
base::Json toJson(const image::ImageDifference& difference, double flip, const LinearImage& image) {
    return {{"width", image.width},
            {"height", image.height},
            {"maxAbsolute", toJson(difference.absolute)},
            {"maxRelative", toJson(difference.relative)},
            {"mean", difference.mean},
            {"rmse", difference.rmse},
            {"relMse", difference.relMse},
            {"psnr", std::isfinite(difference.psnr) ? base::Json(difference.psnr) : base::Json(nullptr)},
            {"flip", flip},
            {"pixels", difference.pixels},
            {"differing", difference.differing},
            {"nonFinite", difference.nonFinite},
            {"referenceNonFinite", difference.referenceNonFinite}};
}

std::string toText(const image::LargestError& error) {
    if (error.value == 0.0) {
        return "0";
    }
    return fmt::format("{:.6g} at ({}, {}) {}", error.value, error.x, error.y, kChannels[error.channel]);
}

std::string toText(const image::ImageDifference& difference, double flip, const LinearImage& image) {
    return formatFields(
        {{"size", fmt::format("{} x {}", image.width, image.height)},
         {"largest error", toText(difference.absolute)},
         {"largest relative", toText(difference.relative)},
         {"mean", fmt::format("{:.6g}", difference.mean)},
         {"RMSE", fmt::format("{:.6g}", difference.rmse)},
         {"relMSE", fmt::format("{:.6g}", difference.relMse)},
         {"PSNR", std::isfinite(difference.psnr) ? fmt::format("{:.2f} dB", difference.psnr) : "infinite"},
         {"FLIP", fmt::format("{:.6g}", flip)},
         {"pixels that differ", fmt::format("{} of {}", difference.differing, difference.pixels)},
         {"NaN or infinity",
          fmt::format("{} in A, {} in B", difference.nonFinite, difference.referenceNonFinite)}});
}

// Has the error "max-error" unless the images are near enough.
Status judge(const CompareArguments& arguments, const image::ImageDifference& difference) {
    if (!arguments.maxError) {
        return okStatus();
    }
    if (difference.nonFinite + difference.referenceNonFinite > 0) {
        return makeError("max-error", arguments.image,
                         "or the reference has pixels that are NaN or infinite");
    }
    if (difference.relative.value > *arguments.maxError) {
        return makeError("max-error", arguments.image,
                         fmt::format("differs from {} by {:.6g}; the limit is {:.6g}", arguments.reference,
                                     difference.relative.value, *arguments.maxError));
    }
    return okStatus();
}

Result<int> compare(const Console& console, const CompareArguments& arguments) {
    if (!arguments.diff.empty()) {
        GLINT_TRY_DO(base::checkOutputFile(arguments.diff));
    }
    GLINT_TRY(const auto image, image::readImage(arguments.image));
    GLINT_TRY(const auto reference, image::readImage(arguments.reference));
    GLINT_TRY(const auto difference,
              image::compareImages(image, reference, arguments.image, arguments.reference));
    if (!arguments.diff.empty()) {
        GLINT_TRY_DO(image::writeImage(arguments.diff, image::differenceMap(image, reference)));
    }
    const double flip = measureFlip(arguments, image, reference);
    answer(
        console, [&] { return toJson(difference, flip, image); },
        [&](Detail) { return toText(difference, flip, image); });
    GLINT_TRY_DO(judge(arguments, difference));
    return kExitDone;
}

}  // namespace

void addCompare(CLI::App& app, Action& chosen) {
    auto arguments = std::make_shared<CompareArguments>();
    auto maxError = std::make_shared<double>(0.0);
    CLI::App& command =
        addCommand(app, {.name = "compare",
                         .what = "Measure how far two images are apart, in linear light",
                         .examples = {"glint compare new.exr old.exr",
                                      "glint compare new.exr old.exr --max-error 0.01 --diff map.png"},
                         .usual = {"--diff", "--max-error", "--json"}});
    addText(command, "A", arguments->image, "IMAGE", "the image, .png or .exr").required();
    addText(command, "B", arguments->reference, "IMAGE", "the reference, of the same size").required();
    addOutputFile(
        command, "--diff", arguments->diff, "FILE.png", {".png"},
        "write a map of the relative errors: black up to 1e-4, then violet, red, orange to pale yellow at "
        "1 and above; green: NaN or infinity");
    CLI::Option& limit = addReal(command, "--max-error", *maxError, 0.0, 1e30,
                                 "exit 1 if a relative error is above X; that is |A - B| / max(1, |B|); also "
                                 "if a pixel is NaN or infinite (0 to 1e30, default: no limit)");
    command.callback([arguments, maxError, &limit, &chosen] {
        if (limit.count() > 0) {
            arguments->maxError = *maxError;
        }
        chosen = [arguments](const Console& console) { return compare(console, *arguments); };
    });
}

}  // namespace glint::cli
