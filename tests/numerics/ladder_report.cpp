#include "ladder_report.h"

#include "report.h"

#include <fmt/format.h>

#include <algorithm>

namespace glint::numerics {
namespace {

std::string timeText(const Spread& spread) {
    if (spread.low <= 0.0) {
        return fmt::format("below {:.2g}", std::max(spread.high, 0.01));
    }
    return spread.median < 100.0 ? fmt::format("{:.2g}", spread.median)
                                 : fmt::format("{:.0f}", spread.median);
}

// Returns the ratio's median and quartiles, or a text that says that no difference is visible.
std::string ratioText(const Rung& rung) {
    if (!rung.ratio) {
        return "";
    }
    const Spread& ratio = *rung.ratio;
    const std::string text = fmt::format("{:.2f} ({:.2f} to {:.2f})", ratio.median, ratio.q1, ratio.q3);
    return rung.tie ? text + ", tie" : text;
}

std::string shareText(double share) {
    return share < 0.001 ? "below 0.1 %" : fmt::format("{:.1f} %", 100.0 * share);
}

std::string worstText(const RungErrors& errors) {
    std::string text =
        errors.notFinite > 0.0 ? "not finite, " + shareText(errors.notFinite) : formatError(errors.worst);
    return errors.undecided > 0.001 ? text + "; decides otherwise, " + shareText(errors.undecided) : text;
}

struct Cells {
    std::string function;
    std::string rung;
    std::string instructions;
    std::string time;
    std::string ratio;
    std::string worst;
    std::string median;
};

std::vector<Cells> cellsOf(const Ladder& ladder) {
    std::vector<Cells> rows;
    for (const LadderRow& row : ladder.rows) {
        for (const Rung& rung : row.rungs) {
            rows.push_back({std::string(row.probe.function), std::string(nameOf(rung.kind)),
                            rung.instructions ? fmt::format("{}", *rung.instructions) : "",
                            timeText(rung.nanoseconds), ratioText(rung),
                            rung.errors ? worstText(*rung.errors) : "the truth",
                            rung.errors ? formatError(rung.errors->median) : ""});
        }
    }
    return rows;
}

std::string headline(const Ladder& ladder) {
    return fmt::format("{} inputs a function, {} rounds, seed {}, on {}.{}", ladder.options.inputs,
                       ladder.options.rounds, ladder.options.seed, ladder.device,
                       ladder.hasHalf ? "" : " The device has no 16-bit arithmetic.");
}

// Summarises how Glint's functions compare with textbooks.
std::string summary(const Ladder& ladder) {
    const LadderCounts counts = countRungs(ladder);
    return fmt::format(
        "Compared with their textbook forms, {} of Glint's functions in float are faster, {} are slower and "
        "{} "
        "tie; {} are too short to measure.",
        counts.faster, counts.slower, counts.ties, counts.unknown);
}

}  // namespace

std::string toText(const Ladder& ladder) {
    std::string text = headline(ladder) + "\n" + summary(ladder) + "\n";
    std::string last;
    for (const Cells& cells : cellsOf(ladder)) {
        text += fmt::format("{:<36} {:<13} {:>5} instructions {:>10} ns  {:<26} worst {:<9} median {}\n",
                            cells.function == last ? "" : cells.function, cells.rung, cells.instructions,
                            cells.time, cells.ratio, cells.worst, cells.median);
        last = cells.function;
    }
    return text;
}

std::string toMarkdown(const Ladder& ladder) {
    std::string text =
        headline(ladder) + " " + summary(ladder) +
        "\n\n| function | rung | instructions | ns | time over that of the first rung | worst error "
        "| median error |\n|---|---|---|---|---|---|---|\n";
    std::string last;
    for (const Cells& cells : cellsOf(ladder)) {
        text += fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n",
                            cells.function == last ? "" : "`" + cells.function + "`", cells.rung,
                            cells.instructions, cells.time, cells.ratio, cells.worst, cells.median);
        last = cells.function;
    }
    return text;
}

}  // namespace glint::numerics
