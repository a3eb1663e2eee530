#include "inspect/diff.h"

#include "base/lists.h"
#include "base/text.h"
#include "emit/package/manifest.h"

#include <glint/package.h>

#include <algorithm>
#include <iterator>
#include <tuple>

namespace glint::inspect {

namespace {

// Returns "a, b", or "none" for an empty list.
std::string listText(const std::vector<std::string>& words) {
    return words.empty() ? "none" : base::join(words);
}

// Returns the settings with which the package was made.
std::vector<std::pair<std::string, std::string>> settingsOf(const compiler::Manifest& manifest) {
    std::vector<std::pair<std::string, std::string>> settings{
        {"toolVersion", manifest.toolVersion},
        {"strategies", listText(manifest.strategies)},
        {"tracers", listText(manifest.tracers)},
        {"merge", manifest.merge},
        {"maxShaders", manifest.maxShaders ? std::to_string(*manifest.maxShaders) : "none"},
        {"alpha", manifest.alpha},
        {"host", listText(manifest.host)},
        {"packs", listText(manifest.packs)},
        {"hitLobes", listText(manifest.hitLobes)}};
    for (const auto& [name, text] : manifest.settings) {
        settings.emplace_back(name, text == "on" ? "true" : text == "off" ? "false" : text);
    }
    const auto variantOf = [](const compiler::ManifestScene& scene) {
        return scene.variant.empty() ? "none" : scene.variant;
    };
    settings.emplace_back("variant", base::join(base::mapped<std::string>(manifest.scenes, variantOf)));
    return settings;
}

void readCases(const compiler::Manifest& manifest, DiffPackage& package) {
    for (const compiler::ManifestCase& shader : manifest.shaders) {
        package.cases[static_cast<int>(shader.id)].name = shader.name;
    }
    for (const compiler::ManifestKey& key : manifest.keys) {
        package.cases[static_cast<int>(key.shaderId)].keys.insert(key.features);
    }
}

// Returns false if a shader has a material of a scene that is not there.
bool readMaterials(const compiler::Manifest& manifest, DiffPackage& package) {
    package.scenes = base::mapped<std::string>(manifest.scenes, &compiler::ManifestScene::name);
    struct Use {
        std::string name;
        std::set<int> shaderIds;
    };
    std::map<std::pair<std::size_t, std::uint32_t>, Use> uses;  // by scene and index
    for (const compiler::ManifestCase& shader : manifest.shaders) {
        for (const auto& [place, name] : shader.materials) {
            if (place.scene >= package.scenes.size()) {
                return false;
            }
            Use& use = uses[{place.scene, place.index}];
            use.name = name;
            use.shaderIds.insert(static_cast<int>(shader.id));
        }
    }
    for (auto& [place, use] : uses) {
        DiffMaterial material{package.scenes[place.first], std::move(use.name)};
        while (package.materials.contains(material)) {
            ++material.sameNamed;
        }
        package.materials[material] = std::move(use.shaderIds);
    }
    return true;
}

void readTotals(const compiler::Manifest& manifest, DiffPackage& package) {
    std::uint64_t bytes = 0;
    for (const compiler::ManifestFile& file : manifest.files) {
        bytes += file.bytes;
        if (file.file == package::kTablesFile) {
            package.tables = file.hash;
        }
    }
    const compiler::ManifestCounts& counts = manifest.counts;
    package.totals = {{"materials", counts.materials},
                      {"keys", counts.keysPresent},
                      {"shaders", counts.cases},
                      {"modules", counts.modules},
                      {"unique SPIR-V", counts.uniqueSpirv},
                      {"SPIR-V bytes", counts.spirvBytes},
                      {"package bytes", bytes}};
}

using FeatureSet = std::vector<std::string>;

std::vector<SettingChange> compareSettings(const DiffPackage& before, const DiffPackage& after) {
    std::vector<SettingChange> changes;
    const auto find = [](const DiffPackage& package, const std::string& name) {
        const auto found =
            std::ranges::find(package.settings, name, &std::pair<std::string, std::string>::first);
        return found != package.settings.end() ? found->second : std::string("-");
    };
    for (const auto& [name, value] : before.settings) {
        if (const std::string now = find(after, name); now != value) {
            changes.push_back({name, value, now});
        }
    }
    for (const auto& [name, value] : after.settings) {
        if (std::ranges::find(before.settings, name, &std::pair<std::string, std::string>::first) ==
            before.settings.end()) {
            changes.push_back({name, "-", value});
        }
    }
    return changes;
}

// Shaders of both packages that have keys in common, directly or through other shaders.
struct Group {
    std::set<int> before;
    std::set<int> after;
    std::set<FeatureSet> keysBefore;
    std::set<FeatureSet> keysAfter;
};

class Grouper {
public:
    Grouper(const DiffPackage& before, const DiffPackage& after) : before_(before), after_(after) {
        collect(before, holdersBefore_);
        collect(after, holdersAfter_);
    }

    std::vector<Group> groups() {
        std::vector<Group> groups;
        for (const auto& [id, shader] : before_.cases) {
            if (!seenBefore_.contains(id)) {
                groups.push_back(follow({{true, id}}));
            }
        }
        for (const auto& [id, shader] : after_.cases) {
            if (!seenAfter_.contains(id)) {
                groups.push_back(follow({{false, id}}));
            }
        }
        return groups;
    }

private:
    using Holders = std::map<FeatureSet, int>;  // the shader of each key

    static void collect(const DiffPackage& package, Holders& holders) {
        for (const auto& [id, shader] : package.cases) {
            for (const FeatureSet& key : shader.keys) {
                holders[key] = id;
            }
        }
    }

    // Follows keys from shader to shader. Each element of `open` says whether the shader is of the earlier
    // package, and its ID.
    Group follow(std::vector<std::pair<bool, int>> open) {
        Group group;
        while (!open.empty()) {
            const auto [isBefore, id] = open.back();
            open.pop_back();
            if (!(isBefore ? seenBefore_ : seenAfter_).insert(id).second) {
                continue;
            }
            const DiffCase& shader = (isBefore ? before_ : after_).cases.at(id);
            (isBefore ? group.before : group.after).insert(id);
            (isBefore ? group.keysBefore : group.keysAfter).insert(shader.keys.begin(), shader.keys.end());
            const Holders& others = isBefore ? holdersAfter_ : holdersBefore_;
            for (const FeatureSet& key : shader.keys) {
                if (const auto found = others.find(key); found != others.end()) {
                    open.emplace_back(!isBefore, found->second);
                }
            }
        }
        return group;
    }

    const DiffPackage& before_;
    const DiffPackage& after_;
    Holders holdersBefore_;
    Holders holdersAfter_;
    std::set<int> seenBefore_;
    std::set<int> seenAfter_;
};

// Returns nothing if the shaders are the same.
std::optional<ShaderChangeKind> kindOf(const Group& group, const DiffPackage& before,
                                       const DiffPackage& after) {
    if (group.before.empty()) {
        return ShaderChangeKind::Added;
    }
    if (group.after.empty()) {
        return ShaderChangeKind::Removed;
    }
    if (group.before.size() > 1) {
        return group.after.size() > 1 ? ShaderChangeKind::Regrouped : ShaderChangeKind::Merged;
    }
    if (group.after.size() > 1) {
        return ShaderChangeKind::Split;
    }
    if (group.before != group.after) {
        return ShaderChangeKind::Moved;
    }
    const int id = *group.before.begin();
    if (before.cases.at(id).name != after.cases.at(id).name) {
        return ShaderChangeKind::Renamed;
    }
    return group.keysBefore != group.keysAfter ? std::optional(ShaderChangeKind::Keys) : std::nullopt;
}

ShaderChange toChange(const Group& group, ShaderChangeKind kind) {
    ShaderChange change{
        kind, {group.before.begin(), group.before.end()}, {group.after.begin(), group.after.end()}, {}, {}};
    std::ranges::set_difference(group.keysAfter, group.keysBefore, std::back_inserter(change.keysAdded));
    std::ranges::set_difference(group.keysBefore, group.keysAfter, std::back_inserter(change.keysRemoved));
    return change;
}

// Pairs the shaders of a group that are to be compared: if each side has one, these two, otherwise those with
// the same ID. Each shader is in one pair, maybe without a partner.
std::vector<std::pair<std::optional<int>, std::optional<int>>> pairsOf(const Group& group) {
    if (group.before.size() == 1 && group.after.size() == 1) {
        return {{*group.before.begin(), *group.after.begin()}};
    }
    std::vector<std::pair<std::optional<int>, std::optional<int>>> pairs;
    for (const int id : group.before) {
        pairs.emplace_back(id, group.after.contains(id) ? std::optional(id) : std::nullopt);
    }
    for (const int id : group.after) {
        if (!group.before.contains(id)) {
            pairs.emplace_back(std::nullopt, id);
        }
    }
    return pairs;
}

using Modules = std::map<package::ModuleKey, DiffModule>;

void compareModules(const Modules& before, const Modules& after, std::optional<int> idBefore,
                    std::optional<int> idAfter, PackageDiff& diff) {
    for (const auto& [key, module] : before) {
        const auto now = after.find(key);
        if (now != after.end() && now->second.hash == module.hash) {
            ++diff.sameModules;
        } else {
            diff.modules.push_back(
                {key, idBefore, idAfter, &module, now != after.end() ? &now->second : nullptr});
        }
    }
    for (const auto& [key, module] : after) {
        if (!before.contains(key)) {
            diff.modules.push_back({key, idBefore, idAfter, nullptr, &module});
        }
    }
}

void compareShaders(const DiffPackage& before, const DiffPackage& after, PackageDiff& diff) {
    static const Modules kNone;
    const auto modulesOf = [](const DiffPackage& package, std::optional<int> id) -> const Modules& {
        return id ? package.cases.at(*id).modules : kNone;
    };
    for (const Group& group : Grouper(before, after).groups()) {
        if (const std::optional<ShaderChangeKind> kind = kindOf(group, before, after)) {
            diff.shaders.push_back(toChange(group, *kind));
        } else {
            ++diff.sameShaders;
        }
        for (const auto& [was, is] : pairsOf(group)) {
            compareModules(modulesOf(before, was), modulesOf(after, is), was, is, diff);
        }
    }
    const auto idOf = [](const ShaderChange& change) {
        return change.before.empty() ? change.after.front() : change.before.front();
    };
    std::ranges::stable_sort(
        diff.shaders, {}, [&](const ShaderChange& change) { return std::tuple(change.kind, idOf(change)); });
}

// The scene's name is part of the key only if there are several scenes.
std::map<DiffMaterial, std::set<int>> materialsOf(const DiffPackage& package, bool named) {
    std::map<DiffMaterial, std::set<int>> materials;
    for (const auto& [material, shaderIds] : package.materials) {
        materials[{named ? material.scene : std::string(), material.name, material.sameNamed}] = shaderIds;
    }
    return materials;
}

void compareMaterials(const DiffPackage& before, const DiffPackage& after, PackageDiff& diff) {
    const bool named = before.scenes.size() != 1 || after.scenes.size() != 1;
    const std::map<DiffMaterial, std::set<int>> was = materialsOf(before, named);
    const std::map<DiffMaterial, std::set<int>> is = materialsOf(after, named);
    const auto toList = [](const std::set<int>& ids) { return std::vector<int>(ids.begin(), ids.end()); };
    for (const auto& [material, ids] : was) {
        const auto now = is.find(material);
        if (now != is.end() && now->second == ids) {
            ++diff.sameMaterials;
        } else {
            diff.materials.push_back(
                {material, toList(ids), now != is.end() ? toList(now->second) : std::vector<int>()});
        }
    }
    for (const auto& [material, ids] : is) {
        if (!was.contains(material)) {
            diff.materials.push_back({material, {}, toList(ids)});
        }
    }
    std::ranges::sort(diff.materials, {}, &MaterialChange::material);
}

// Cases come first, by ID, then passes, in the order of the package.
auto orderOf(const ModuleChange& change) {
    const std::optional<int> id = change.idBefore ? change.idBefore : change.idAfter;
    return std::tuple(!id, id.value_or(0), change.key);
}

}  // namespace

Result<DiffPackage> readDiffPackage(const std::filesystem::path& folder) {
    GLINT_TRY(const auto loaded, Package::load(folder));
    GLINT_TRY(const auto manifest, compiler::readManifest(folder));
    DiffPackage package;
    package.settings = settingsOf(manifest);
    readCases(manifest, package);
    if (!readMaterials(manifest, package)) {
        return makeError("manifest-format", (folder / package::kManifestFile).string(),
                         "has a material of a scene that it lacks", "compile the package again");
    }
    readTotals(manifest, package);
    for (const package::ModuleEntry& entry : loaded.modules()) {
        package::ModuleKey key{entry.role, entry.index, entry.tracer};
        GLINT_TRY(const auto statistics, compiler::measureSpirv(loaded.spirv(key)));
        DiffModule module{std::string(loaded.string(entry.file)), entry.hash, statistics};
        if (package::findRole(entry.role)->repeated == package::Repeated::ByCase) {
            key.index = 0;
            package.cases[static_cast<int>(entry.index)].modules[key] = std::move(module);
        } else {
            package.passes[key] = std::move(module);
        }
    }
    return package;
}

PackageDiff comparePackages(const DiffPackage& before, const DiffPackage& after) {
    PackageDiff diff;
    diff.settings = compareSettings(before, after);
    compareShaders(before, after, diff);
    compareModules(before.passes, after.passes, std::nullopt, std::nullopt, diff);
    std::ranges::stable_sort(diff.modules, {}, orderOf);
    compareMaterials(before, after, diff);
    for (std::size_t i = 0; i < before.totals.size(); ++i) {
        const auto& [name, value] = before.totals[i];
        if (value != after.totals[i].second) {
            diff.totals.push_back({name, value, after.totals[i].second});
        }
    }
    diff.tablesDiffer = before.tables != after.tables;
    return diff;
}

}  // namespace glint::inspect
