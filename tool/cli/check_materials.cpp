// glint check-materials: checks what the code of packs computes.
#include "base/files.h"
#include "base/json.h"
#include "cli/command_line.h"
#include "cli/options/options.h"
#include "cli/report.h"
#include "cli/table.h"
#include "image/image_file.h"

#include <glint/measure/check_materials.h>

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <system_error>

namespace glint::cli {

namespace {

struct CheckArguments {
    measure::CheckMaterialsOptions options;
    std::int64_t samples = 4096;
    std::int64_t combinations = 12;
    std::string pictures;
    bool prove = false;
    std::int64_t boxes = 4096;
};

constexpr const char* kPictureSuffix = ".png";

std::string cellOf(const measure::CheckOutcome& outcome) {
    using enum measure::CheckState;
    switch (outcome.state) {
        case Passed:
            return fmt::format("{:.2g}", outcome.worst);
        case Failed:
            return fmt::format("FAILED {:.2g}", outcome.worst);
        case Waived:
            return fmt::format("waived {:.2g}", outcome.worst);
        case Unasked:
            return "not claimed";
        case Unsure:
            return "unsure";
        case Absent:
            break;
    }
    return "-";
}

std::string toText(const measure::MaterialChecksReport& report, const std::vector<std::string>& pictures,
                   Detail detail) {
    Rows rows{{"feature", "tried"}};
    std::vector<std::string> limits{"limit", "-"};
    for (const measure::MaterialCheck check : measure::kMaterialChecks) {
        rows.front().emplace_back(nameOf(check));
    }
    for (const measure::FeatureChecks& feature : report.features) {
        std::vector<std::string> row{feature.feature, fmt::format("{}", feature.combinations)};
        for (const measure::CheckOutcome& outcome : feature.outcomes) {
            row.push_back(cellOf(outcome));
        }
        rows.push_back(std::move(row));
    }
    if (!report.features.empty()) {
        for (const measure::CheckOutcome& outcome : report.features.front().outcomes) {
            limits.push_back(fmt::format("{:.2g}", outcome.limit));
        }
        rows.push_back(std::move(limits));
    }
    std::string notes;
    for (const measure::FeatureChecks& feature : report.features) {
        for (const measure::CheckOutcome& outcome : feature.outcomes) {
            if (outcome.state == measure::CheckState::Waived) {
                notes += fmt::format("{}: {}: {}\n", feature.feature, nameOf(outcome.check), outcome.message);
            }
        }
    }
    for (const std::string& picture : pictures) {
        notes += picture + "\n";
    }
    return fmt::format("{}, {} samples for each combination and view\n\n{}{}{}", report.device,
                       report.samples, formatTable(rows, detail), notes.empty() ? "" : "\n", notes);
}

// JSON has no infinity, which is what NaN is as far as a range is concerned.
base::Json finiteOrNull(double value) {
    return std::isfinite(value) ? base::Json(value) : base::Json(nullptr);
}

base::Json toJson(const measure::CheckPlace& place) {
    return {{"base", place.base},
            {"parameters", base::jsonOf(place.parameters)},
            {"view", place.view},
            {"light", base::orNull(place.light)}};
}

base::Json toJson(const measure::CheckOutcome& outcome) {
    return {{"check", nameOf(outcome.check)},
            {"state", nameOf(outcome.state)},
            {"quantity", quantityOf(outcome.check)},
            {"worst", finiteOrNull(outcome.worst)},
            {"limit", outcome.limit},
            {"evaluations", outcome.evaluations},
            {"message", base::textOrNull(outcome.message)},
            {"place", outcome.place ? toJson(*outcome.place) : base::Json(nullptr)}};
}

base::Json toJson(const measure::FeatureChecks& feature) {
    return {{"feature", feature.feature},
            {"declaration", feature.declaration},
            {"lobe", feature.isLobe},
            {"combinations", feature.combinations},
            {"failed", feature.failed()},
            {"checks", listOf(feature.outcomes, [](const auto& outcome) { return toJson(outcome); })}};
}

base::Json toJson(const measure::MaterialChecksReport& report, const std::vector<std::string>& pictures) {
    return {{"device", report.device},
            {"samples", report.samples},
            {"features", listOf(report.features, [](const auto& feature) { return toJson(feature); })},
            {"pictures", pictures}};
}

// Writes the pictures, and returns their files.
Result<std::vector<std::string>> writePictures(const std::string& folder,
                                               const std::vector<measure::FeaturePicture>& pictures) {
    std::vector<std::string> files;
    if (folder.empty()) {
        return files;
    }
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) {
        return makeError("output-folder", folder, fmt::format("can't be made: {}", error.message()),
                         "name a folder that may be written");
    }
    for (const measure::FeaturePicture& picture : pictures) {
        const std::filesystem::path file = std::filesystem::path(folder) / (picture.name + kPictureSuffix);
        GLINT_TRY_DO(image::writeImage(file, picture.image, 0.0));
        files.push_back(file.generic_string());
    }
    return files;
}

Result<int> checkMaterialFeatures(const Console& console, const CheckArguments& arguments) {
    measure::CheckMaterialsOptions options = arguments.options;
    options.samples = static_cast<std::uint32_t>(arguments.samples);
    options.combinations = static_cast<std::uint32_t>(arguments.combinations);
    options.pictures = !arguments.pictures.empty();
    if (options.pictures) {
        GLINT_TRY_DO(base::checkOutputFolder(arguments.pictures));
    }
    GLINT_TRY(const auto report, measure::checkMaterials(options, console));
    GLINT_TRY(const auto pictures, writePictures(arguments.pictures, report.pictures));
    answer(
        console, [&] { return toJson(report, pictures); },
        [&](Detail detail) { return toText(report, pictures, detail); });
    bool failed = false;
    for (const measure::FeatureChecks& feature : report.features) {
        for (const Diagnostic& failure : failuresOf(feature)) {
            console.report(failure);
            failed = true;
        }
    }
    return failed ? kExitFailed : kExitDone;
}

}  // namespace

void addCheckMaterials(CLI::App& app, Action& chosen, std::span<const char* const> line,
                       const Companion& companion) {
    auto arguments = std::make_shared<CheckArguments>();
    CLI::App& command = addCommand(
        app,
        {.name = "check-materials",
         .what = "Check on the device what the GLSL of material features computes",
         .examples = {"glint check-materials materials --pictures checked",
                      "glint check-materials materials --prove"},
         .usual = {"--pictures", "--prove", "--samples", "--combinations", "--boxes", "--device", "--json"}});
    addTexts(command, "DIR", arguments->options.packs, "DIR",
             "folders of material features (docs/material_features.md)")
        .required();
    addText(command, "--pictures", arguments->pictures, "DIR",
            "write pictures of features; PNG files: each feature's lobe over all directions for three views, "
            "and a sphere in a white furnace, which is brighter than the background, or red, where it "
            "creates energy; existing files are replaced");
    addInteger(command, "--samples", arguments->samples, 256, 1 << 20,
               "sampled directions for each combination and view; more find smaller errors of densities");
    addInteger(command, "--combinations", arguments->combinations, 1, 4096,
               "maximum number of parameter combinations for each feature; the first are the usual values "
               "and each range's ends");
    addFlag(command, "--prove", arguments->prove,
            "prove on intervals instead, without a device; no operation fails, and all results are finite "
            "and in their ranges");
    addInteger(command, "--boxes", arguments->boxes, 1, 100000000,
               "the most boxes of inputs for each feature; of --prove; more decide a larger share");
    const OptionGroup group(command, "Device");
    addDeviceChoice(command, arguments->options.device, arguments->options.validate);
    addJobs(command, arguments->options.jobs);
    command.callback([arguments, line, companion, &command, &chosen] {
        // Options that the proofs do not read, and those that they alone read.
        const std::vector<const char*> ofDevice{"--pictures", "--samples", "--combinations", "--device",
                                                "--validate"};
        const std::vector<const char*> ofProof{"--boxes"};
        for (const char* const name : arguments->prove ? ofDevice : ofProof) {
            if (command.count(name) > 0) {
                throw CLI::ValidationError(name, arguments->prove
                                                     ? "has no effect with --prove; leave out one of them"
                                                     : "is for --prove; give both, or neither");
            }
        }
        chosen = [arguments, line, companion](const Console& console) -> Result<int> {
            if (!arguments->prove) {
                return checkMaterialFeatures(console, *arguments);
            }
            if (companion.proveMaterials == nullptr) {
                return startCompanion(
                    "glint-verify", line,
                    makeError("verify-missing", "", "this glint was built without its proofs",
                              "build the target glint-verify, which GLINT_VERIFY=ON has"));
            }
            return companion.proveMaterials(console, arguments->options.packs,
                                            static_cast<std::uint64_t>(arguments->boxes));
        };
    });
}

}  // namespace glint::cli
