// The table of comparisons, for people and for scripts.
#include "oracle/spec/bounds.h"
#include "oracle/spec/comparison.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace glint::spec {
namespace {

std::string lightOf(const Comparison& row) {
    const std::string lighting = kLightingNames[static_cast<std::size_t>(row.lighting)];
    return row.lighting == Lighting::Lights ? lighting
                                            : lighting + ", " + kMapNames[static_cast<std::size_t>(row.map)];
}

std::string textOf(const std::vector<Approximation>& list) {
    std::string text;
    for (const Approximation& one : list) {
        text += fmt::format("{}{} {:+.1f} %{}", text.empty() ? "" : "; ", one.what, 100.0 * one.share,
                            one.why.empty() ? "" : fmt::format(" ({})", one.why));
    }
    return text;
}

nlohmann::ordered_json arrayOf(const Vec3& v) {
    return nlohmann::ordered_json::array({v.x, v.y, v.z});
}

}  // namespace

std::string toMarkdown(const std::vector<Comparison>& comparisons) {
    std::string text =
        "| group | material | light | compensation | device / specification | by n·v | relative difference | "
        "predicted | device / predicted | noise | approximation "
        "|\n|---|---|---|---|---|---|---|---|---|---|---|\n";
    for (const Comparison& row : comparisons) {
        std::string zones;
        for (std::size_t i = 0; i < 3; ++i) {
            zones += i > 0 ? ", " : "";
            zones += row.viewsOfZone[i] > 0
                         ? fmt::format("{:.3f}", farthestRatio(row.zones[i].device, row.zones[i].plain))
                         : "none";
        }
        text += fmt::format("| {} | {} | {} | {} | {:.4f} | {} | {:.4f} | {:.4f} | {:.4f} | {:.4f} | {} |\n",
                            row.group, row.name, lightOf(row), row.compensation ? "on" : "off", row.ratio(),
                            zones, row.relativeDifference, row.predictedRatio(), row.statedRatio(),
                            row.noise(), textOf(row.approximations));
    }
    return text;
}

std::string toJson(const std::vector<Comparison>& comparisons) {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const Comparison& row : comparisons) {
        const Bound bound = boundOf(row);
        nlohmann::ordered_json approximations = nlohmann::ordered_json::array();
        for (const Approximation& one : row.approximations) {
            approximations.push_back({{"what", one.what}, {"share", one.share}, {"why", one.why}});
        }
        nlohmann::ordered_json zones = nlohmann::ordered_json::object();
        for (std::size_t i = 0; i < 3; ++i) {
            if (row.viewsOfZone[i] > 0) {
                zones[kZoneNames[i]] = {{"device", arrayOf(row.zones[i].device)},
                                        {"specification", arrayOf(row.zones[i].plain)},
                                        {"predicted", arrayOf(row.zones[i].stated)}};
            }
        }
        all.push_back({{"group", row.group},
                       {"material", row.name},
                       {"light", lightOf(row)},
                       {"compensation", row.compensation},
                       {"ratio", row.ratio()},
                       {"relativeDifference", row.relativeDifference},
                       {"predictedRatio", row.predictedRatio()},
                       {"statedRatio", row.statedRatio()},
                       {"statedDifference", row.statedDifference},
                       {"noise", row.noise()},
                       {"bound", bound.relative},
                       {"boundBecause", bound.why},
                       {"device", arrayOf(row.whole.device)},
                       {"specification", arrayOf(row.whole.plain)},
                       {"predicted", arrayOf(row.whole.stated)},
                       {"zones", zones},
                       {"approximations", approximations}});
    }
    return all.dump(2) + "\n";
}

}  // namespace glint::spec
