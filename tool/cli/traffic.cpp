#include "cli/traffic.h"

#include "cli/table.h"

#include <glint/package_modules.h>
#include <glint/renderer_options.h>

#include <fmt/format.h>

#include <array>
#include <vector>

namespace glint::cli {
namespace {

base::Json toJson(const TrafficRow& row) {
    return {{"pass", std::string(row.pass)},
            {"unit", std::string(nameOf(row.unit))},
            {"read", row.read},
            {"written", row.written}};
}

// The shape of the frames that a program draws as they come: none adds to another.
TrafficShape shapeOf(const Package& package, package::Strategy strategy) {
    RendererOptions options;
    options.strategy = strategy;
    options.accumulate = false;
    return trafficShape(package, options);
}

// Returns the bytes for one of each unit, in the order of the units.
std::array<std::uint32_t, std::size(kTrafficUnitNames)> bytesByUnit(const std::vector<TrafficRow>& rows) {
    std::array<std::uint32_t, std::size(kTrafficUnitNames)> bytes{};
    for (const TrafficRow& row : rows) {
        bytes[static_cast<std::size_t>(row.unit)] += row.read + row.written;
    }
    return bytes;
}

double bytesOfPixel(double bytes, const TrafficCounts& counts) {
    return bytes / counts[TrafficUnit::Pixel];
}

template <typename Visit>
void forEachStrategy(const Package& package, const Visit& visit) {
    for (const package::StrategyInfo& info : package::strategyTable()) {
        if (package.supports(info.strategy)) {
            visit(info);
        }
    }
}

}  // namespace

base::Json toJson(const TrafficReport& report) {
    const std::vector<TrafficRow> rows = trafficRows(report.shape);
    const TrafficSum sum = sumTraffic(rows, report.counts);
    base::Json passes = base::Json::array();
    for (const TrafficRow& row : rows) {
        base::Json entry = toJson(row);
        entry["count"] = report.counts[row.unit];
        passes.push_back(std::move(entry));
    }
    return {{"bytesPerPixel", bytesOfPixel(sum.read + sum.written, report.counts)},
            {"read", sum.read},
            {"written", sum.written},
            {"passes", std::move(passes)}};
}

std::string toText(const TrafficReport& report) {
    std::vector<std::vector<std::string>> rows{
        {"bytes moved by", "for each", "of which", "read", "written", "a pixel"}};
    for (const TrafficRow& row : trafficRows(report.shape)) {
        const double count = report.counts[row.unit];
        rows.push_back(
            {std::string(row.pass), std::string(nameOf(row.unit)), fmt::format("{:.0f}", count),
             fmt::format("{}", row.read), fmt::format("{}", row.written),
             fmt::format("{:.1f}", bytesOfPixel(count * (row.read + row.written), report.counts))});
    }
    return formatTable(rows);
}

std::string summaryOf(const TrafficReport& report) {
    const TrafficSum sum = sumTraffic(trafficRows(report.shape), report.counts);
    return fmt::format("{:.0f} a pixel read, {:.0f} written", bytesOfPixel(sum.read, report.counts),
                       bytesOfPixel(sum.written, report.counts));
}

base::Json trafficToJson(const Package& package) {
    base::Json list = base::Json::array();
    forEachStrategy(package, [&](const package::StrategyInfo& info) {
        base::Json passes = base::Json::array();
        for (const TrafficRow& row : trafficRows(shapeOf(package, info.strategy))) {
            passes.push_back(toJson(row));
        }
        list.push_back(base::Json{{"strategy", std::string(info.name)}, {"passes", std::move(passes)}});
    });
    return list;
}

std::string trafficTable(const Package& package) {
    std::vector<std::string> header{"bytes moved for each"};
    for (const Named<TrafficUnit>& unit : kTrafficUnitNames) {
        header.emplace_back(unit.name);
    }
    std::vector<std::vector<std::string>> rows{std::move(header)};
    forEachStrategy(package, [&](const package::StrategyInfo& info) {
        std::vector<std::string>& row = rows.emplace_back();
        row.emplace_back(info.name);
        for (const std::uint32_t bytes : bytesByUnit(trafficRows(shapeOf(package, info.strategy)))) {
            row.push_back(bytes > 0 ? fmt::format("{}", bytes) : "-");
        }
    });
    return formatTable(rows);
}

}  // namespace glint::cli
