// The bytes that the passes of a frame move, as JSON and as tables.
#pragma once

#include "base/json.h"

#include <glint/internal/frame_traffic.h>
#include <glint/package.h>

#include <string>

namespace glint::cli {

// The bytes that a frame moved. The rows are those of its shape.
struct TrafficReport {
    TrafficShape shape;
    TrafficCounts counts;
};
base::Json toJson(const TrafficReport& report);
std::string toText(const TrafficReport& report);
// "X bytes a pixel moved".
std::string summaryOf(const TrafficReport& report);

// The bytes that frames of a package move for each pixel, ray and hit, by strategy.
base::Json trafficToJson(const Package& package);
std::string trafficTable(const Package& package);

}  // namespace glint::cli
