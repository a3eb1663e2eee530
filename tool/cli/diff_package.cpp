#include "cli/diff_package.h"

#include "base/files.h"
#include "base/json_depth.h"
#include "cli/report.h"
#include "cli/table.h"

#include <glint/package.h>

#include <exception>
#include <string_view>

namespace glint {

namespace {

// Returns "a, b" for a list, "none" for null, and otherwise the value as it is.
std::string valueText(const Json& value) {
    if (value.is_array()) {
        std::vector<std::string> words;
        for (const Json& element : value) {
            words.push_back(valueText(element));
        }
        return join(words);
    }
    return value.is_null() ? "none" : value.is_string() ? value.get<std::string>() : value.dump();
}

// Returns the settings that decided how the package was made. Throws if the manifest lacks one.
std::vector<std::pair<std::string, std::string>> settingsOf(const Json& manifest) {
    std::vector<std::pair<std::string, std::string>> settings;
    for (const char* name : {"toolVersion", "strategies", "tracers", "merge", "maxShaders", "alpha"}) {
        settings.emplace_back(name, valueText(manifest.at(name)));
    }
    for (const auto& [name, value] : manifest.at("settings").items()) {
        settings.emplace_back(name, valueText(value));
    }
    Json variants = Json::array();
    for (const Json& scene : manifest.at("scenes")) {
        variants.push_back(scene.at("variant"));
    }
    settings.emplace_back("variant", valueText(variants));
    return settings;
}

void readCases(const Json& manifest, DiffPackage& package) {
    for (const Json& shader : manifest.at("shaders")) {
        package.cases[shader.at("id").get<int>()].name = shader.at("name").get<std::string>();
    }
    for (const Json& key : manifest.at("keys")) {
        package.cases[key.at("shaderId").get<int>()].keys.insert(
            key.at("features").get<std::vector<std::string>>());
    }
}

void readMaterials(const Json& manifest, DiffPackage& package) {
    for (const Json& scene : manifest.at("scenes")) {
        package.scenes.push_back(scene.at("name").get<std::string>());
    }
    struct Use {
        std::string name;
        std::set<int> shaderIds;
    };
    std::map<std::pair<std::size_t, int>, Use> uses;  // by scene and index
    for (const Json& shader : manifest.at("shaders")) {
        for (const Json& material : shader.at("materials")) {
            Use& use = uses[{material.at("scene").get<std::size_t>(), material.at("index").get<int>()}];
            use.name = material.at("name").get<std::string>();
            use.shaderIds.insert(shader.at("id").get<int>());
        }
    }
    for (auto& [place, use] : uses) {
        DiffMaterial material{package.scenes.at(place.first), std::move(use.name)};
        while (package.materials.contains(material)) {
            ++material.sameNamed;
        }
        package.materials[material] = std::move(use.shaderIds);
    }
}

void readTotals(const Json& manifest, DiffPackage& package) {
    std::uint64_t bytes = 0;
    for (const Json& file : manifest.at("files")) {
        bytes += file.at("bytes").get<std::uint64_t>();
        if (file.at("file") == package::kTablesFile) {
            package.tables = file.at("hash").get<std::string>();
        }
    }
    const Json& counts = manifest.at("counts");
    const auto add = [&](const char* label, const char* name) {
        package.totals.emplace_back(label, counts.at(name).get<std::uint64_t>());
    };
    add("materials", "materials");
    add("keys", "keysPresent");
    add("shaders", "cases");
    add("modules", "modules");
    add("unique SPIR-V", "uniqueSpirv");
    add("SPIR-V bytes", "spirvBytes");
    package.totals.emplace_back("package bytes", bytes);
}

Result<DiffPackage> readManifestPart(const std::filesystem::path& folder) {
    const std::filesystem::path path = folder / package::kManifestFile;
    const Result<Bytes> bytes = readFile(path);
    if (!bytes) {
        return bytes.error();
    }
    const auto unreadable = [&](const std::string& why) {
        return makeError("manifest-format", path.string(), "is no manifest that can be read: " + why,
                         "compile the package again");
    };
    if (nestsTooDeep(*bytes)) {
        return unreadable("nests too deep");
    }
    try {
        const Json manifest = Json::parse(bytes->begin(), bytes->end());
        DiffPackage package;
        package.settings = settingsOf(manifest);
        readCases(manifest, package);
        readMaterials(manifest, package);
        readTotals(manifest, package);
        return package;
    } catch (const std::exception& error) {
        return unreadable(error.what());
    }
}

}  // namespace

Result<DiffPackage> readDiffPackage(const std::filesystem::path& folder) {
    const Result<Package> loaded = Package::load(folder);
    if (!loaded) {
        return loaded.error();
    }
    Result<DiffPackage> package = readManifestPart(folder);
    if (!package) {
        return package.error();
    }
    for (const package::ModuleEntry& entry : loaded->modules()) {
        package::ModuleKey key{entry.role, entry.index, entry.tracer};
        const Result<SpirvStatistics> statistics = measureSpirv(loaded->spirv(key));
        if (!statistics) {
            return statistics.error();
        }
        DiffModule module{std::string(loaded->string(entry.file)), entry.hash, *statistics};
        if (package::findRole(entry.role)->repeated == package::Repeated::ByCase) {
            key.index = 0;
            package->cases[static_cast<int>(entry.index)].modules[key] = std::move(module);
        } else {
            package->passes[key] = std::move(module);
        }
    }
    return package;
}

}  // namespace glint
