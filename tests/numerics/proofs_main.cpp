// glint_proofs: proves the claims about the shaders' functions, and says how far it came.
#include "base/files.h"
#include "document_region.h"
#include "proofs.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

namespace {

namespace numerics = glint::numerics;
namespace verify = glint::verify;

struct Settings {
    std::string only;
    std::uint64_t boxes = 0;
    std::string report;
    int describe = 0;
};

struct Row {
    const numerics::Proof* proof = nullptr;
    verify::ProofResult result;
    double seconds = 0.0;  // of processor time
};

std::string resultOf(const verify::ProofResult& result) {
    switch (result.state) {
        case verify::ProofState::Proved:
            return "proved";
        case verify::ProofState::Undecided:
            return fmt::format("{:.1e} undecided", result.undecidedShare);
        case verify::ProofState::Refuted:
            break;
    }
    return "refuted";
}

// The domain without the errors of vectors' lengths, which all vectors have.
std::string domainOf(const verify::Claim& claim) {
    std::string text;
    for (const verify::InputRange& input : claim.inputs) {
        if (input.scale != verify::Scale::Whole && !input.name.starts_with("azimuth")) {
            text += fmt::format("{}{}: {:.4g} to {:.4g}", text.empty() ? "" : "; ", input.name, input.low,
                                input.high);
        }
    }
    return text;
}

void printRow(const Row& row) {
    fmt::print("{:28} {:>18} {:9} boxes {:7.2f} s\n", row.proof->name, resultOf(row.result), row.result.boxes,
               row.seconds);
    if (row.result.counterexample) {
        std::string inputs;
        for (const double input : row.result.counterexample->inputs) {
            inputs += fmt::format(" {:.9g}", input);
        }
        fmt::print("    {}, for{}\n", row.result.counterexample->what, inputs);
    } else if (!row.result.undecidedWhy.empty()) {
        std::string box;
        for (const verify::Interval& side : row.result.undecidedBox) {
            box += fmt::format(" [{:.7g}, {:.7g}]", side.low, side.high);
        }
        fmt::print("    {}, for{}\n", row.result.undecidedWhy, box);
    }
    std::fflush(stdout);
}

std::string tableOf(const std::vector<Row>& rows, std::uint64_t boxes) {
    std::string text = fmt::format(
        "At most {} boxes a claim, or 20000 where these decide a claim about few numbers; seconds of "
        "processor time.\n\n",
        boxes);
    text += "| function | domain | claim | result | boxes | s |\n|---|---|---|---|---|---|\n";
    for (const Row& row : rows) {
        text += fmt::format("| `{}` | {} | {} | {} | {} | {:.2f} |\n", row.proof->function,
                            domainOf(row.proof->claim), row.proof->bound, resultOf(row.result),
                            row.result.boxes, row.seconds);
    }
    text += "\n| no claim about | because |\n|---|---|\n";
    for (const numerics::Unclaimed& unclaimed : numerics::unclaimedFunctions()) {
        text += fmt::format("| {} | {} |\n", unclaimed.function, unclaimed.reason);
    }
    return text;
}

glint::Status writeReport(const std::string& file, const std::string& table) {
    const glint::Result<glint::base::Bytes> bytes = glint::base::readFile(file);
    if (!bytes) {
        return bytes.error();
    }
    const glint::Result<std::string> document =
        numerics::replaceRegion({bytes->begin(), bytes->end()}, "proofs", table);
    return document ? glint::base::writeFile(file, *document) : glint::Status(document.error());
}

int run(const Settings& settings) {
    std::vector<numerics::Proof> proofs;
    for (const numerics::Proof& proof : numerics::allProofs()) {
        if (proof.name.find(settings.only) != std::string_view::npos) {
            proofs.push_back(proof);
        }
    }
    const glint::Result<std::vector<verify::Program>> programs = numerics::compileProofs(proofs);
    if (!programs) {
        fmt::print(stderr, "{}\n", toString(programs.error()));
        return 1;
    }
    std::vector<Row> rows;
    bool refuted = false;
    for (std::size_t k = 0; k < proofs.size(); ++k) {
        for (std::size_t output = 0; settings.describe > 0 && output < proofs[k].claim.outputs.size();
             ++output) {
            const verify::Program& program = (*programs)[k];
            fmt::print("{} = {}\n", proofs[k].claim.outputs[output].name,
                       verify::describe(program, program.outputs[output], settings.describe));
        }
        verify::ProofOptions options;
        options.mostBoxes = std::max(settings.boxes, proofs[k].boxes);
        const std::clock_t start = std::clock();
        Row row{&proofs[k], verify::prove((*programs)[k], proofs[k].claim, options), 0.0};
        row.seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
        printRow(row);
        refuted = refuted || row.result.state == verify::ProofState::Refuted;
        rows.push_back(std::move(row));
    }
    if (!settings.report.empty()) {
        if (const glint::Status status = writeReport(settings.report, tableOf(rows, settings.boxes));
            !status) {
            fmt::print(stderr, "{}\n", toString(status.error()));
            return 1;
        }
    }
    return refuted ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app("Proves claims about the functions of the shaders on intervals");
    Settings settings;
    settings.boxes = 2000;
    app.add_option("--only", settings.only, "the claims whose name contains this");
    app.add_option("--boxes", settings.boxes, "the most boxes for each claim")->capture_default_str();
    app.add_option("--describe", settings.describe, "prints what outputs are, to this depth");
    app.add_option("--report", settings.report, "Markdown file whose region `proofs` is replaced");
    CLI11_PARSE(app, argc, argv);
    return run(settings);
}
