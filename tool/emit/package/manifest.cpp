#include "emit/package/manifest.h"

#include "base/json.h"
#include "emit/context.h"
#include "emit/package/json.h"
#include "resolve/host.h"
#include "resolve/resolve.h"
#include "settings/table.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <utility>
#include <vector>

namespace glint::compiler {

using ManifestJson = nlohmann::ordered_json;

namespace {

// Returns the path relative to the scene's folder, because a package must not tell where it was built.
std::string relativeName(const std::string& path, const std::string& scenePath) {
    const std::filesystem::path folder = std::filesystem::path(scenePath).parent_path().lexically_normal();
    const std::filesystem::path file = std::filesystem::path(path).lexically_normal();
    const std::filesystem::path relative = folder.empty() ? file : file.lexically_relative(folder);
    const bool isBelow = !relative.empty() && relative.is_relative() && *relative.begin() != "..";
    return (isBelow ? relative : file.filename()).generic_string();
}

ManifestJson sources(const gltf::Scene& scene) {
    ManifestJson list = ManifestJson::array();
    for (const gltf::SourceFile& file : scene.files) {
        list.push_back({{"file", relativeName(file.path, scene.path)},
                        {"bytes", file.bytes},
                        {"hash", base::hexHash(file.hash)}});
    }
    return list;
}

ManifestJson features(const materials::MaterialModel& model) {
    ManifestJson list = ManifestJson::array();
    for (const materials::Feature& feature : model.features) {
        list.push_back({{"name", feature.name},
                        {"bit", feature.bit},
                        {"lobe", feature.isLobe},
                        {"macro", feature.macro},
                        {"gltf", feature.gltf},
                        {"neutral", feature.neutralText()}});
    }
    return list;
}

// Returns "textureLod" for "texture-lod".
std::string memberName(std::string_view setting) {
    std::string name;
    for (std::size_t i = 0; i < setting.size(); ++i) {
        const bool starts = i > 0 && setting[i - 1] == '-';
        if (setting[i] != '-') {
            name += starts ? static_cast<char>(setting[i] - 'a' + 'A') : setting[i];
        }
    }
    return name;
}

// Returns what a setting is written as: switches as booleans, numbers as numbers.
ManifestJson valueOf(const std::string& text) {
    if (text == "on" || text == "off") {
        return text == "on";
    }
    const ManifestJson number = ManifestJson::parse(text, nullptr, false);
    return number.is_number() ? number : ManifestJson(text);
}

ManifestJson settingsOf(const materials::MaterialModel& model, const CompileSettings& compile) {
    Settings settings;
    settings.compile = compile;
    ManifestJson object{{"hitLobes", model.names(compile.plan.keys.keptLobes & model.lobes)}};
    for (const Descriptor& row : settingsTable()) {
        if (row.recorded) {
            object[memberName(row.name)] = valueOf(row.values.text(settings));
        }
    }
    object["sky"] = compile.environmentMap ? "map" : "gradient";
    return object;
}

// The files were read when the modules were made, so they are there.
ManifestJson hostNames(const CompileSettings& settings) {
    const Result<std::vector<std::string>> names = replacedHostFiles(settings.host);
    return names ? ManifestJson(*names) : ManifestJson::array();
}

// Returns the names of the declarations of packs.
ManifestJson packNames(const materials::MaterialModel& model) {
    std::set<std::string> names;
    for (const materials::FeatureCode& code : model.code) {
        if (code.isOfPack) {
            names.insert(code.name);
        }
    }
    return names;
}

// Returns the budget of cases, or null if there is none.
ManifestJson maxShadersOf(const PlanOptions& options) {
    const int budget = budgetOf(options);
    return budget > 0 ? ManifestJson(budget) : ManifestJson(nullptr);
}

ManifestJson materialsToJson(const gltf::SceneList& scenes, const std::vector<int>& materials) {
    ManifestJson list = ManifestJson::array();
    for (const int material : materials) {
        const gltf::SceneList::Place place = scenes.place(material);
        list.push_back({{"scene", place.scene},
                        {"index", place.index},
                        {"name", scenes.materials()[static_cast<std::size_t>(material)].name}});
    }
    return list;
}

// The places have no names; shaders[] has those.
ManifestJson materialPlaces(const gltf::SceneList& scenes, const std::vector<int>& materials) {
    ManifestJson list = ManifestJson::array();
    for (const int material : materials) {
        const gltf::SceneList::Place place = scenes.place(material);
        list.push_back({{"scene", place.scene}, {"index", place.index}});
    }
    return list;
}

ManifestJson sceneList(const gltf::SceneList& scenes) {
    ManifestJson list = ManifestJson::array();
    for (std::size_t i = 0; i < scenes.scenes().size(); ++i) {
        const gltf::Scene& scene = scenes.scenes()[i];
        list.push_back(
            {{"name", scenes.name(i)},
             {"source", std::filesystem::path(scene.path).filename().string()},
             {"variant", scene.variant.empty() ? ManifestJson(nullptr) : ManifestJson(scene.variant)},
             {"materials", scene.materials.size()},
             {"primitives", scenes.primitivesOf(i).count},
             {"sources", sources(scene)}});
    }
    return list;
}

ManifestJson moduleEntry(const CompiledModule& module) {
    return {{"name", module.name},
            {"file", module.file},
            {"bytes", module.statistics.bytes},
            {"instructions", module.statistics.instructions},
            {"textureFetches", module.statistics.textureFetches},
            {"rayQueries", module.statistics.rayQueries},
            {"branches", module.statistics.branches},
            {"features", package::featuresOf(module.spirv)},
            {"hash", base::hexHash(module.hash)}};
}

// Lists a case's own modules by strategy. In the uber shader a case is a function, which is listed under
// passes.
ManifestJson stages(const CompiledPackage& package, int shaderId) {
    ManifestJson object = ManifestJson::object();
    for (const CompiledModule& module : package.modules) {
        const bool ofCase = package::findRole(module.key.role)->repeated == package::Repeated::ByCase;
        if (ofCase && module.key.index == static_cast<std::uint32_t>(shaderId)) {
            object[std::string(stageName(module.key))] = moduleEntry(module);
        }
    }
    return object;
}

ManifestJson shaders(const gltf::SceneList& scenes, const CompiledPackage& package) {
    ManifestJson list = ManifestJson::array();
    for (const Case& shaderCase : package.plan.cases) {
        if (shaderCase.isRetired()) {
            continue;
        }
        list.push_back({{"id", shaderCase.shaderId},
                        {"name", shaderCase.name},
                        {"always", package.plan.model->names(shaderCase.always)},
                        {"sometimes", package.plan.model->names(shaderCase.sometimes)},
                        {"keys", shaderCase.keys.size()},
                        {"share", roundedShare(shaderCase.share)},
                        {"reason", toString(shaderCase.reason)},
                        {"materials", materialsToJson(scenes, shaderCase.materials)},
                        {"stages", stages(package, shaderCase.shaderId)}});
    }
    return list;
}

ManifestJson passes(const CompiledPackage& package) {
    ManifestJson list = ManifestJson::array();
    for (const CompiledModule& module : package.modules) {
        if (package::findRole(module.key.role)->repeated != package::Repeated::ByCase) {
            ManifestJson entry = {{"role", package::roleName(module.key.role)}};
            entry.update(moduleEntry(module));
            list.push_back(std::move(entry));
        }
    }
    return list;
}

ManifestJson keys(const gltf::SceneList& scenes, const CompiledPackage& package) {
    ManifestJson list = ManifestJson::array();
    for (const Key& key : package.plan.keys) {
        list.push_back({{"features", package.plan.model->names(key.mask)},
                        {"mask", fmt::format("{:#018x}", key.mask)},
                        {"primitives", key.primitives.size()},
                        {"materials", materialPlaces(scenes, key.materials)},
                        {"share", roundedShare(key.share)},
                        {"shaderId", key.shaderId}});
    }
    return list;
}

ManifestJson dropped(const gltf::SceneList& scenes, const CompiledPackage& package) {
    ManifestJson list = ManifestJson::array();
    for (const DroppedFeature& feature : package.plan.dropped) {
        list.push_back({{"feature", feature.feature},
                        {"materials", materialPlaces(scenes, feature.materials)},
                        {"reason", feature.reason}});
    }
    return list;
}

ManifestJson counts(const gltf::SceneList& scenes, const CompiledPackage& package) {
    return {{"materials", scenes.materials().size()},
            {"keysPossible", base::jsonOf(wholeNumber(package.plan.keysPossible))},
            {"keysPresent", package.plan.keys.size()},
            {"cases", caseCount(package.plan)},
            {"modules", package.modules.size()},
            {"uniqueSpirv", package.uniqueSpirv},
            {"spirvBytes", package.spirvBytes}};
}

ManifestJson files(const CompiledPackage& package) {
    ManifestJson list = ManifestJson::array();
    for (const PackageFile& file : package.files) {
        list.push_back({{"file", file.name},
                        {"bytes", file.bytes.size()},
                        {"hash", base::hexHash(base::hashBytes(file.bytes))}});
    }
    return list;
}

// The manifest may come from anywhere, so its names must not lead out of the package's folder.
bool staysInside(const std::filesystem::path& name) {
    return !name.empty() && name.is_relative() &&
           std::ranges::all_of(name, [](const std::filesystem::path& part) {
               return !part.empty() && part != "." && part != "..";
           });
}

}  // namespace

namespace {

// The attributes of packs that shaders read, in the order of their values.
ManifestJson vertexAttributes(const Plan& plan) {
    const materials::FeatureMask used =
        plan.always | plan.sometimes | plan.primaryAlways | plan.primarySometimes;
    ManifestJson list = ManifestJson::array();
    for (const materials::VertexAttribute& attribute : plan.model->attributes) {
        const materials::Feature& feature = plan.model->features[static_cast<std::size_t>(attribute.feature)];
        if ((feature.mask() & used) == 0) {
            continue;
        }
        ManifestJson fallback = nullptr;
        if (attribute.fallback) {
            fallback = std::vector<float>(attribute.fallback->begin(),
                                          attribute.fallback->begin() + attribute.channels);
        }
        list.push_back(ManifestJson{{"name", attribute.name},
                                    {"gltf", attribute.gltf},
                                    {"feature", feature.name},
                                    {"channels", attribute.channels},
                                    {"default", fallback}});
    }
    return list;
}

}  // namespace

std::string makeManifest(const gltf::SceneList& scenes, const CompiledPackage& package,
                         const CompileSettings& settings) {
    ManifestJson manifest;
    manifest["format"] = kManifestFormat;
    manifest["version"] = package::kVersion;
    manifest["toolVersion"] = toolVersion();
    manifest["scenes"] = sceneList(scenes);
    manifest["strategies"] = strategyNames(settings.strategies);
    manifest["strategyChoice"] = base::jsonOf(settings.strategyChoice);
    manifest["tracers"] = tracerNames(settings.tracers);
    manifest["merge"] = nameOf(settings.plan.merge);
    manifest["maxShaders"] = maxShadersOf(settings.plan);
    manifest["alpha"] = nameOf(settings.plan.keys.alpha);
    manifest["host"] = hostNames(settings);
    manifest["packs"] = packNames(*package.plan.model);
    manifest["settings"] = settingsOf(*package.plan.model, settings);
    manifest["counts"] = counts(scenes, package);
    manifest["buckets"] = 1 + package.plan.cases.size();
    manifest["effects"] = base::jsonOf(package.plan.effects.decisions);
    manifest["features"] = features(*package.plan.model);
    manifest["vertexAttributes"] = vertexAttributes(package.plan);
    manifest["shaders"] = shaders(scenes, package);
    manifest["passes"] = passes(package);
    manifest["keys"] = keys(scenes, package);
    manifest["dropped"] = dropped(scenes, package);
    manifest["files"] = files(package);
    // Names come from the scene. Bytes that are not UTF-8 are replaced rather than refused.
    return manifest.dump(2, ' ', false, ManifestJson::error_handler_t::replace) + "\n";
}

std::set<std::string, std::less<>> manifestFiles(std::string_view text) {
    if (base::nestsTooDeep({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()})) {
        return {};
    }
    const ManifestJson manifest = ManifestJson::parse(text, nullptr, false);
    if (!manifest.is_object() || manifest.value("format", ManifestJson()) != ManifestJson(kManifestFormat)) {
        return {};
    }
    std::set<std::string, std::less<>> names{package::kManifestFile, package::kTablesFile};
    const ManifestJson list = manifest.value("files", ManifestJson::array());
    for (const ManifestJson& file : list) {
        const ManifestJson name = file.is_object() ? file.value("file", ManifestJson()) : ManifestJson();
        if (name.is_string() && staysInside(name.get<std::string>())) {
            names.insert(name.get<std::string>());
        }
    }
    return names;
}

}  // namespace glint::compiler
