#include "cli/report.h"

#include "cli/table.h"

#include <fmt/format.h>

#include <system_error>

namespace glint {

std::string toText(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

namespace {

// Returns "/materials/3" for "scene.gltf#/materials/3", or an empty text if the place has no JSON pointer.
std::string pointerOf(const std::string& where) {
    const std::size_t begin = where.find("#/");
    return begin == std::string::npos ? std::string() : where.substr(begin + 1);
}

}  // namespace

Json toJson(const Diagnostic& diagnostic) {
    static constexpr const char* kNames[] = {"note", "warning", "error"};
    return {{"severity", kNames[static_cast<int>(diagnostic.severity)]},
            {"id", diagnostic.id},
            {"where", diagnostic.where},
            {"pointer", textOrNull(pointerOf(diagnostic.where))},
            {"message", diagnostic.message},
            {"hint", diagnostic.hint}};
}

Json toJson(std::span<const Diagnostic> diagnostics) {
    Json list = Json::array();
    for (const Diagnostic& diagnostic : diagnostics) {
        list.push_back(toJson(diagnostic));
    }
    return list;
}

Json featuresToJson(FeatureMask mask) {
    Json list = Json::array();
    for (const std::string_view name : featureNames(mask)) {
        list.push_back(std::string(name));
    }
    return list;
}

Json textOrNull(const std::string& text) {
    return text.empty() ? Json(nullptr) : Json(text);
}

Json materialsToJson(const SceneList& scenes, std::span<const int> materials) {
    Json list = Json::array();
    for (const int material : materials) {
        const SceneList::Place place = scenes.place(material);
        list.push_back(
            Json{{"scene", place.scene}, {"index", place.index}, {"name", scenes.materialName(material)}});
    }
    return list;
}

Json droppedToJson(const SceneList& scenes, const Plan& plan) {
    Json list = Json::array();
    for (const DroppedFeature& dropped : plan.dropped) {
        list.push_back(Json{{"feature", dropped.feature},
                            {"reason", dropped.reason},
                            {"materials", materialsToJson(scenes, dropped.materials)}});
    }
    return list;
}

std::string featureList(FeatureMask mask) {
    std::vector<std::string> names;
    for (const std::string_view name : featureNames(mask)) {
        names.emplace_back(name);
    }
    return join(names);
}

std::string droppedText(const Plan& plan) {
    std::vector<std::vector<std::string>> rows;
    for (const DroppedFeature& dropped : plan.dropped) {
        const std::size_t count = dropped.materials.size();
        rows.push_back({"  " + dropped.feature, fmt::format("{} material{}", count, count == 1 ? "" : "s"),
                        dropped.reason});
    }
    return rows.empty() ? std::string() : "\ndropped\n" + formatFields(rows);
}

Status checkOutputFile(const std::filesystem::path& file) {
    std::error_code error;
    const std::filesystem::path parent = file.has_parent_path() ? file.parent_path() : ".";
    if (!std::filesystem::is_directory(parent, error)) {
        return makeError("output-folder", file.string(),
                         "can't be written, because its folder does not exist",
                         "make the folder " + parent.string() + " first");
    }
    if (std::filesystem::is_directory(file, error)) {
        return makeError("output-folder", file.string(), "is a folder", "name a file within it");
    }
    return okStatus();
}

}  // namespace glint
