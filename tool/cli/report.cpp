#include "cli/report.h"

#include "cli/table.h"
#include "emit/package/json.h"

#include <fmt/format.h>

namespace glint::cli {

base::Json featuresToJson(const materials::MaterialModel& model, materials::FeatureMask mask) {
    base::Json list = base::Json::array();
    for (const std::string_view name : model.names(mask)) {
        list.push_back(std::string(name));
    }
    return list;
}

base::Json materialsToJson(const gltf::SceneList& scenes, std::span<const int> materials) {
    base::Json list = base::Json::array();
    for (const int material : materials) {
        const gltf::SceneList::Place place = scenes.place(material);
        list.push_back(base::Json{
            {"scene", place.scene}, {"index", place.index}, {"name", scenes.materialName(material)}});
    }
    return list;
}

base::Json droppedToJson(const gltf::SceneList& scenes, const compiler::Plan& plan) {
    base::Json list = base::Json::array();
    for (const compiler::DroppedFeature& dropped : plan.dropped) {
        list.push_back(base::Json{{"feature", dropped.feature},
                                  {"reason", dropped.reason},
                                  {"materials", materialsToJson(scenes, dropped.materials)}});
    }
    return list;
}

std::string featureList(const materials::MaterialModel& model, materials::FeatureMask mask) {
    std::vector<std::string> names;
    for (const std::string_view name : model.names(mask)) {
        names.emplace_back(name);
    }
    return base::join(names);
}

std::string droppedText(const compiler::Plan& plan) {
    std::vector<std::vector<std::string>> rows;
    for (const compiler::DroppedFeature& dropped : plan.dropped) {
        const std::size_t count = dropped.materials.size();
        rows.push_back({"  " + dropped.feature, fmt::format("{} material{}", count, count == 1 ? "" : "s"),
                        dropped.reason});
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

}  // namespace glint::cli
