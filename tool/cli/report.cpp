#include "cli/report.h"

#include "base/lists.h"
#include "emit/package/manifest.h"

#include <glint/renderer_options.h>

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <iterator>

namespace glint {

static base::Fields fieldsOf(const TrafficRow*) {
    using T = TrafficRow;
    return {base::output<&T::pass>("pass", "The pass."),
            base::output<&T::unit>("unit", "What it moves these bytes for."),
            base::output<&T::read>("read", "Bytes read for each."),
            base::output<&T::written>("written", "Bytes written for each.")};
}

}  // namespace glint

namespace glint::cli {

base::Json materialsToJson(const gltf::SceneList& scenes, std::span<const int> materials) {
    return listOf(materials, [&](int material) -> base::Json {
        const gltf::SceneList::Place place = scenes.place(material);
        return {{"scene", place.scene}, {"index", place.index}, {"name", scenes.materialName(material)}};
    });
}

base::Json droppedToJson(const gltf::SceneList& scenes, const compiler::Plan& plan) {
    return listOf(plan.dropped, [&](const compiler::DroppedFeature& dropped) -> base::Json {
        return {{"feature", dropped.feature},
                {"reason", dropped.reason},
                {"materials", materialsToJson(scenes, dropped.materials)}};
    });
}

std::string droppedText(const compiler::Plan& plan) {
    Rows rows;
    for (const compiler::DroppedFeature& dropped : plan.dropped) {
        rows.push_back(
            {"  " + dropped.feature, base::counted(dropped.materials.size(), "material"), dropped.reason});
    }
    return rows.empty() ? std::string() : "\ndropped\n" + formatFields(rows);
}

base::Json stagesToJson(const compiler::CompiledPackage* package, int shaderId) {
    base::Json stages = base::Json::object();
    if (package == nullptr) {
        return stages;
    }
    for (const compiler::CompiledModule& module : package->modules) {
        const bool ofCase = package::findRole(module.key.role)->repeated == package::Repeated::ByCase;
        if (ofCase && module.key.index == static_cast<std::uint32_t>(shaderId)) {
            base::Json entry{{"file", module.file}};
            entry.update(base::jsonOf(module.statistics));
            stages[std::string(compiler::stageName(module.key))] = std::move(entry);
        }
    }
    return stages;
}

std::string tracerName(const package::ModuleKey& key) {
    return key.tracer == 0 ? std::string()
                           : std::string(package::nameOf(static_cast<package::Tracer>(key.tracer)));
}

std::string orderingName(const package::ModuleKey& key) {
    const bool ordered = package::findRole(key.role)->repeated == package::Repeated::ByOrdering;
    return ordered ? std::string(package::nameOf(static_cast<package::Ordering>(key.index))) : std::string();
}

namespace {

// A row, and how many of its unit a frame had.
struct CountedRow {
    TrafficRow row;
    double count = 0.0;
};

base::Fields fieldsOf(const CountedRow*) {
    return {base::output<&CountedRow::row>("", ""),
            base::output<&CountedRow::count>("count", "How many of them the last sample had.")};
}

std::vector<CountedRow> rowsOf(const TrafficReport& report) {
    return base::mapped<CountedRow>(trafficRows(report.shape), [&](const TrafficRow& row) {
        return CountedRow{row, report.counts[row.unit]};
    });
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

base::Fields fieldsOf(const TrafficReport*) {
    using T = TrafficReport;
    using base::output;
    return {output("bytesPerPixel", "Bytes read and written, for each pixel.",
                   [](const T& it) {
                       const TrafficSum sum = sumTraffic(trafficRows(it.shape), it.counts);
                       return bytesOfPixel(sum.read + sum.written, it.counts);
                   }),
            output("read", "Bytes read.",
                   [](const T& it) { return sumTraffic(trafficRows(it.shape), it.counts).read; }),
            output("written", "Bytes written.",
                   [](const T& it) { return sumTraffic(trafficRows(it.shape), it.counts).written; }),
            output<rowsOf>("passes", "The bytes of each pass.")};
}

std::string toText(const TrafficReport& report) {
    Rows rows{{"bytes moved by", "for each", "of which", "read", "written", "a pixel"}};
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

base::Fields fieldsOf(const StrategyTraffic*) {
    return {base::output<&StrategyTraffic::strategy>("strategy", "The strategy."),
            base::output<&StrategyTraffic::passes>("passes", "The bytes of each pass.")};
}

std::vector<StrategyTraffic> trafficOf(const Package& package) {
    std::vector<StrategyTraffic> list;
    forEachStrategy(package, [&](const package::StrategyInfo& info) {
        list.push_back({info.name, trafficRows(shapeOf(package, info.strategy))});
    });
    return list;
}

std::string trafficTable(const Package& package) {
    // By column, which those of units that no strategy has are not.
    std::vector<std::vector<std::string>> columns{{"bytes moved for each"}};
    std::array<bool, std::size(kTrafficUnitNames)> isMoved{};
    for (const Named<TrafficUnit>& unit : kTrafficUnitNames) {
        columns.push_back({std::string(unit.name)});
    }
    forEachStrategy(package, [&](const package::StrategyInfo& info) {
        columns.front().emplace_back(info.name);
        const auto bytes = bytesByUnit(trafficRows(shapeOf(package, info.strategy)));
        for (std::size_t i = 0; i < isMoved.size(); ++i) {
            columns[i + 1].push_back(bytes[i] > 0 ? fmt::format("{}", bytes[i]) : "-");
            isMoved[i] = isMoved[i] || bytes[i] > 0;
        }
    });
    Rows rows(columns.front().size());
    for (std::size_t i = 0; i < columns.size(); ++i) {
        for (std::size_t row = 0; row < rows.size() && (i == 0 || isMoved[i - 1]); ++row) {
            rows[row].push_back(columns[i][row]);
        }
    }
    return formatTable(rows);
}

}  // namespace glint::cli
