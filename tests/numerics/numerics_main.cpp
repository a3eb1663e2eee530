// glint_numerics: measures every function of the shaders and writes the table of docs/numerics.md, or the
// precision ladder of docs/accuracy.md.
#include "base/files.h"
#include "document_region.h"
#include "ladder_report.h"
#include "report.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <set>
#include <string>

namespace {

namespace fs = std::filesystem;
using namespace glint;

struct Settings {
    numerics::MeasureOptions measure = numerics::optionsFromEnvironment();
    std::string document;
    std::string json;
    std::string function;  // empty: all
    std::string device;
    bool ladder = false;
    int rounds = numerics::LadderOptions{}.rounds;
    std::string marker;
    std::string from;  // JSON of a ladder that was measured before
};

Result<numerics::Report> measureAll(const Settings& settings) {
    const numerics::MeasureOptions& options = settings.measure;
    GLINT_TRY(auto device, numerics::ProbeDevice::create({settings.device, true}));
    numerics::Report report{device->description(), options, {}};
    for (const numerics::Probe& probe : numerics::allProbes()) {
        if (!settings.function.empty() && probe.function != settings.function) {
            continue;
        }
        GLINT_TRY(auto result, numerics::measure(*device, probe, options));
        report.rows.push_back({probe, std::move(result)});
        const numerics::ReportRow& row = report.rows.back();
        std::printf("%-36s worst %9.2e  median %9.2e  C++ %9.2e%s\n", std::string(probe.function).c_str(),
                    row.result.device.worst(), row.result.device.median(), row.result.single.worst(),
                    row.passes() ? "" : "  OUT OF BOUNDS");
        if (!row.passes()) {
            std::printf("    output %d of %s, %llu not finite, %llu undecided\n",
                        row.result.device.worstOutput(),
                        numerics::formatInputs(row.result.device.worstInputs()).c_str(),
                        static_cast<unsigned long long>(row.result.device.notFinite()),
                        static_cast<unsigned long long>(row.result.undecided));
        }
        std::fflush(stdout);
    }
    const std::vector<std::string> messages = device->messages();
    return messages.empty() ? Result<numerics::Report>(std::move(report))
                            : makeError("validation", "", messages.front(), "");
}

// Writes the report into the files that were asked for.
Status writeReport(const Settings& settings, const std::string& json, const std::string& markdown) {
    if (!settings.json.empty()) {
        GLINT_TRY_DO(base::writeFile(settings.json, json));
    }
    if (settings.document.empty()) {
        return okStatus();
    }
    GLINT_TRY(const auto bytes, base::readFile(settings.document));
    const Result<std::string> document =
        numerics::replaceRegion({bytes.begin(), bytes.end()}, settings.marker, markdown);
    return document ? base::writeFile(settings.document, *document) : Status(document.error());
}

int fail(const Diagnostic& error) {
    std::fprintf(stderr, "%s\n", toString(error).c_str());
    return 1;
}

Result<numerics::Ladder> measureLadder(const Settings& settings) {
    if (!settings.from.empty()) {
        const Result<base::Bytes> bytes = base::readFile(settings.from);
        return bytes ? numerics::ladderFromJson({bytes->begin(), bytes->end()})
                     : Result<numerics::Ladder>(bytes.error());
    }
    GLINT_TRY(const auto device, numerics::ProbeDevice::create({settings.device, false}));
    numerics::LadderOptions options;
    options.inputs = settings.measure.inputs;
    options.seed = settings.measure.seed;
    options.rounds = settings.rounds;
    options.function = settings.function;
    const std::vector<numerics::Probe> probes = numerics::ladderProbes();
    if (!options.function.empty() &&
        std::ranges::find(probes, options.function, &numerics::Probe::function) == probes.end()) {
        return makeError("ladder-function", "", options.function + " is not in the ladder",
                         "leave out --function to see which are");
    }
    return numerics::climb(*device, options);
}

int runLadder(const Settings& settings) {
    const Result<numerics::Ladder> ladder = measureLadder(settings);
    if (!ladder) {
        return fail(ladder.error());
    }
    std::fputs(numerics::toText(*ladder).c_str(), stdout);
    const Status status = writeReport(settings, numerics::toJson(*ladder), numerics::toMarkdown(*ladder));
    return status ? 0 : fail(status.error());
}

int runErrors(const Settings& settings) {
    const Result<numerics::Report> report = measureAll(settings);
    if (!report) {
        return fail(report.error());
    }
    const Status status = writeReport(settings, numerics::toJson(*report), numerics::toMarkdown(*report));
    if (!status) {
        return fail(status.error());
    }
    return std::ranges::all_of(report->rows, &numerics::ReportRow::passes) ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        Settings settings;
        CLI::App app("Measures the error of every function of the shaders that needs no device.");
        app.add_option("--inputs", settings.measure.inputs, "Inputs of each function")
            ->capture_default_str()
            ->check(CLI::PositiveNumber);
        app.add_option("--seed", settings.measure.seed, "Seed of the inputs")->capture_default_str();
        std::set<std::string> functions;
        for (const numerics::Probe& probe : numerics::allProbes()) {
            functions.emplace(probe.function);
        }
        CLI::Option* const one =
            app.add_option("--function", settings.function, "Measure this function alone")
                ->check(CLI::IsMember(functions));
        app.add_option("--report", settings.document, "Markdown file whose generated region is replaced")
            ->excludes(one);
        app.add_option("--json", settings.json, "JSON file to write");
        app.add_option("--device", settings.device,
                       "Part of the name of the Vulkan device (default: the first)");
        CLI::Option* const ladder =
            app.add_flag("--ladder", settings.ladder,
                         "Measure what precision costs: instructions and time beside errors. Needs no ray "
                         "tracing and no validation layers");
        app.add_option("--rounds", settings.rounds, "Times that the ladder measures each kernel")
            ->capture_default_str()
            ->check(CLI::Range(1, 1000))
            ->needs(ladder);
        app.add_option("--from", settings.from,
                       "Take the ladder from the JSON of an earlier run, perhaps elsewhere")
            ->needs(ladder)
            ->check(CLI::ExistingFile);
        app.add_option("--marker", settings.marker,
                       "Name of the region of --report (default: numerics, or ladder)");
        CLI11_PARSE(app, argc, argv);
        if (settings.marker.empty()) {
            settings.marker = settings.ladder ? "ladder" : "numerics";
        }
        return settings.ladder ? runLadder(settings) : runErrors(settings);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "glint_numerics: error: %s\n", error.what());
        return 1;
    }
}
