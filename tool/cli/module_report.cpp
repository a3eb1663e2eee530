#include "cli/module_report.h"

#include "emit/json.h"

#include <string>

namespace glint {

Json statisticsToJson(const SpirvStatistics& statistics) {
    return {{"bytes", statistics.bytes},
            {"instructions", statistics.instructions},
            {"textureFetches", statistics.textureFetches},
            {"rayQueries", statistics.rayQueries},
            {"branches", statistics.branches}};
}

Json stagesToJson(const CompiledPackage* package, int shaderId) {
    Json stages = Json::object();
    if (package == nullptr) {
        return stages;
    }
    for (const CompiledModule& module : package->modules) {
        const bool ofCase = package::findRole(module.key.role)->repeated == package::Repeated::ByCase;
        if (ofCase && module.key.index == static_cast<std::uint32_t>(shaderId)) {
            Json entry{{"file", module.file}};
            entry.update(statisticsToJson(module.statistics));
            stages[std::string(stageName(module.key))] = std::move(entry);
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

}  // namespace glint
