// glint-verify: the proofs of `glint check-materials --prove`. It takes the same command line as glint.
#include "base/json.h"
#include "cli/command_line.h"
#include "cli/console.h"
#include "cli/table.h"
#include "verify/prove_materials.h"

#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace glint::verify {

namespace {

using cli::Console;
using cli::Detail;

std::string toText(const std::vector<FeatureProofOutcome>& outcomes, Detail detail) {
    cli::Rows rows{{"feature", "proof", "undecided", "boxes", "what the bounds can't exclude"}};
    for (const FeatureProofOutcome& outcome : outcomes) {
        const bool isOpen = outcome.state == FeatureProofState::Undecided;
        rows.push_back({outcome.feature, std::string(nameOf(outcome.state)),
                        isOpen ? fmt::format("{:.2g}", outcome.undecidedShare) : "-",
                        fmt::format("{}", outcome.boxes),
                        isOpen ? fmt::format("{}, {}", outcome.message, outcome.place) : outcome.message});
    }
    return cli::formatTable(rows, detail);
}

base::Json toJson(const FeatureProofOutcome& outcome) {
    return {{"feature", outcome.feature},
            {"declaration", outcome.declaration},
            {"state", nameOf(outcome.state)},
            {"undecidedShare", outcome.undecidedShare},
            {"boxes", outcome.boxes},
            {"message", base::textOrNull(outcome.message)},
            {"place", base::textOrNull(outcome.place)}};
}

int proveAndReport(const Console& console, const std::vector<std::string>& packs, std::uint64_t boxes) {
    const Result<std::vector<FeatureProofOutcome>> outcomes = proveMaterials({packs, boxes}, console);
    if (!outcomes) {
        return cli::fail(console, outcomes.error());
    }
    if (console.isJson()) {
        base::Json proofs = base::Json::array();
        for (const FeatureProofOutcome& outcome : *outcomes) {
            proofs.push_back(toJson(outcome));
        }
        console.result(base::Json{{"proofs", proofs}});
    } else {
        console.print(toText(*outcomes, console.isVerbose() ? Detail::Whole : Detail::Short));
    }
    bool failed = false;
    for (const FeatureProofOutcome& outcome : *outcomes) {
        if (const std::optional<Diagnostic> failure = failureOf(outcome)) {
            console.report(*failure);
            failed = true;
        }
    }
    return failed ? cli::kExitFailed : cli::kExitDone;
}

}  // namespace

}  // namespace glint::verify

int main(int argc, char** argv) {
    return glint::cli::runCommandLine(argc, argv, {.proveMaterials = glint::verify::proveAndReport});
}
