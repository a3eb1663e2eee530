#include "report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace glint::numerics {
namespace {

bool within(const ErrorStatistics& statistics, const Bounds& bounds) {
    return statistics.notFinite() == 0 && statistics.worst() <= bounds.worst &&
           statistics.median() <= bounds.median;
}

// Formats inputs so that they fit into a table; the JSON has all of them.
std::string formatShort(std::span<const float> inputs) {
    constexpr std::size_t kMost = 10;
    return inputs.size() <= kMost ? formatInputs(inputs) : fmt::format("{} numbers", inputs.size());
}

nlohmann::json jsonOf(const ErrorStatistics& statistics) {
    // JSON has no infinity, so it is null.
    const double worst = statistics.worst();
    return {{"worst", std::isfinite(worst) ? nlohmann::json(worst) : nlohmann::json(nullptr)},
            {"median", statistics.median()},
            {"notFinite", statistics.notFinite()},
            {"worstOutput", statistics.worstOutput()},
            {"worstInputs", statistics.worstInputs()}};
}

}  // namespace

bool ReportRow::passes() const {
    return within(result.device, probe.bounds) && within(result.single, probe.bounds) &&
           (!probe.decides() || static_cast<double>(result.undecided) <=
                                    probe.undecidedShare * static_cast<double>(result.inputs));
}

std::string formatError(double error) {
    if (error == 0.0) {
        return "exact";
    }
    if (error < 1e-10) {
        return "< 1e-10";
    }
    return std::isfinite(error) ? fmt::format("{:.1e}", error) : "not finite";
}

std::string formatInputs(std::span<const float> inputs) {
    return fmt::format("({})", fmt::join(inputs, ", "));
}

std::string toMarkdown(const Report& report) {
    std::string text = fmt::format("{} inputs a function, seed {}, on {}.\n\n", report.options.inputs,
                                   report.options.seed, report.device);
    text +=
        "| function | worst | median | C++ worst | bound | worst input | textbook worst | textbook median | "
        "its "
        "worst input |\n|---|---|---|---|---|---|---|---|---|\n";
    for (const ReportRow& row : report.rows) {
        const ProbeResult& result = row.result;
        text += fmt::format("| `{}` | {} | {} | {} | {} | {} |", row.probe.function,
                            formatError(result.device.worst()), formatError(result.device.median()),
                            formatError(result.single.worst()), formatError(row.probe.bounds.worst),
                            formatShort(result.device.worstInputs()));
        text += result.textbook ? fmt::format(" {} | {} | {} |\n", formatError(result.textbook->worst()),
                                              formatError(result.textbook->median()),
                                              formatShort(result.textbook->worstInputs()))
                                : " | | |\n";
    }
    return text;
}

std::string toJson(const Report& report) {
    nlohmann::ordered_json json;
    json["device"] = report.device;
    json["inputs"] = report.options.inputs;
    json["seed"] = report.options.seed;
    json["functions"] = nlohmann::json::array();
    for (const ReportRow& row : report.rows) {
        nlohmann::ordered_json function;
        function["name"] = row.probe.function;
        function["passes"] = row.passes();
        function["bound"] = {{"worst", row.probe.bounds.worst},
                             {"median", row.probe.bounds.median},
                             {"floorShare", row.probe.bounds.floorShare}};
        function["device"] = jsonOf(row.result.device);
        function["cpp"] = jsonOf(row.result.single);
        function["undecided"] = row.result.undecided;
        if (row.result.textbook) {
            function["textbook"] = jsonOf(*row.result.textbook);
        }
        json["functions"].push_back(std::move(function));
    }
    return json.dump(2) + "\n";
}

}  // namespace glint::numerics
