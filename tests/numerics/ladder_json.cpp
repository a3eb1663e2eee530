#include "ladder_report.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <stdexcept>
#include <string>

namespace glint::numerics {
namespace {

using Json = nlohmann::ordered_json;

Json jsonOf(const Spread& spread) {
    return {{"median", spread.median},
            {"low", spread.low},
            {"high", spread.high},
            {"q1", spread.q1},
            {"q3", spread.q3}};
}

Json jsonOf(const RungErrors& errors) {
    // JSON has no infinity, so it is null.
    const Json worst = std::isfinite(errors.worst) ? Json(errors.worst) : Json(nullptr);
    const Json median = std::isfinite(errors.median) ? Json(errors.median) : Json(nullptr);
    return {{"worst", worst},
            {"median", median},
            {"notFinite", errors.notFinite},
            {"undecided", errors.undecided}};
}

Json jsonOf(const Rung& rung) {
    return {{"rung", nameOf(rung.kind)},
            {"instructions", rung.instructions ? Json(*rung.instructions) : Json(nullptr)},
            {"nanoseconds", jsonOf(rung.nanoseconds)},
            {"ratio", rung.ratio ? jsonOf(*rung.ratio) : Json(nullptr)},
            {"tie", rung.tie},
            {"error", rung.errors ? jsonOf(*rung.errors) : Json(nullptr)}};
}

Spread spreadFrom(const Json& json) {
    return {json.at("median"), json.at("low"), json.at("high"), json.at("q1"), json.at("q3")};
}

double errorFrom(const Json& json) {
    return json.is_null() ? std::numeric_limits<double>::infinity() : json.get<double>();
}

Rung rungFrom(const Json& json) {
    Rung rung;
    rung.kind = RungKind::Textbook;
    const auto name = json.at("rung").get<std::string>();
    while (nameOf(rung.kind) != name) {
        if (rung.kind == RungKind::Double) {
            throw std::runtime_error("there is no rung " + name);
        }
        rung.kind = static_cast<RungKind>(static_cast<int>(rung.kind) + 1);
    }
    if (!json.at("instructions").is_null()) {
        rung.instructions = json.at("instructions").get<std::uint32_t>();
    }
    rung.nanoseconds = spreadFrom(json.at("nanoseconds"));
    if (!json.at("ratio").is_null()) {
        rung.ratio = spreadFrom(json.at("ratio"));
    }
    rung.tie = json.at("tie");
    const Json& error = json.at("error");
    if (!error.is_null()) {
        rung.errors = RungErrors{errorFrom(error.at("worst")), errorFrom(error.at("median")),
                                 error.at("notFinite"), error.at("undecided")};
    }
    return rung;
}

LadderRow rowFrom(const Json& json) {
    const auto name = json.at("name").get<std::string>();
    const std::vector<Probe> probes = ladderProbes();
    const auto probe = std::ranges::find(probes, name, &Probe::function);
    if (probe == probes.end()) {
        throw std::runtime_error("there is no function " + name);
    }
    LadderRow row{*probe, {}};
    for (const Json& rung : json.at("rungs")) {
        row.rungs.push_back(rungFrom(rung));
    }
    return row;
}

}  // namespace

std::string toJson(const Ladder& ladder) {
    Json json;
    json["device"] = ladder.device;
    json["half"] = ladder.hasHalf;
    json["inputs"] = ladder.options.inputs;
    json["seed"] = ladder.options.seed;
    json["rounds"] = ladder.options.rounds;
    json["functions"] = Json::array();
    for (const LadderRow& row : ladder.rows) {
        Json rungs = Json::array();
        for (const Rung& rung : row.rungs) {
            rungs.push_back(jsonOf(rung));
        }
        json["functions"].push_back({{"name", row.probe.function}, {"rungs", std::move(rungs)}});
    }
    return json.dump(2) + "\n";
}

Result<Ladder> ladderFromJson(const std::string& text) {
    try {
        const Json json = Json::parse(text);
        Ladder ladder;
        ladder.device = json.at("device");
        ladder.hasHalf = json.at("half");
        ladder.options.inputs = json.at("inputs");
        ladder.options.seed = json.at("seed");
        ladder.options.rounds = json.at("rounds");
        for (const Json& row : json.at("functions")) {
            ladder.rows.push_back(rowFrom(row));
        }
        return ladder;
    } catch (const std::exception& error) {
        return makeError("ladder-format", "", std::string("is no ladder that can be read: ") + error.what(),
                         "measure it with this version: glint_numerics --ladder --json FILE");
    }
}

}  // namespace glint::numerics
