// The bytes that the passes of a frame move, as JSON and as tables.
#pragma once

#include "base/fields.h"

#include <glint/frame_traffic.h>
#include <glint/package.h>

#include <string>
#include <string_view>
#include <vector>

namespace glint::cli {

// The bytes that a frame moved. The rows are those of its shape.
struct TrafficReport {
    TrafficShape shape;
    TrafficCounts counts;
};
base::Fields fieldsOf(const TrafficReport*);
std::string toText(const TrafficReport& report);
// "X bytes a pixel moved".
std::string summaryOf(const TrafficReport& report);

struct StrategyTraffic {
    std::string_view strategy;
    std::vector<TrafficRow> passes;
};
base::Fields fieldsOf(const StrategyTraffic*);
// The bytes that frames of a package move for each pixel, ray and hit, by strategy.
std::vector<StrategyTraffic> trafficOf(const Package& package);
std::string trafficTable(const Package& package);

}  // namespace glint::cli
