// glint diff: shows the differences between two packages.
#include "inspect/diff.h"

#include "cli/command_line.h"
#include "cli/options/options.h"
#include "cli/report.h"
#include "cli/table.h"
#include "emit/package/manifest.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

namespace glint::cli {

namespace {

struct DiffSides {
    std::string nameBefore;  // folders, as given
    std::string nameAfter;
    const inspect::DiffPackage& before;
    const inspect::DiffPackage& after;
};

// A scene may have a hundred thousand materials, and nobody reads more than a page of them.
constexpr std::size_t kMaxMaterials = 40;

std::string_view nameOf(inspect::ShaderChangeKind kind) {
    constexpr std::string_view kNames[] = {"added", "removed", "moved", "renamed",
                                           "keys",  "merged",  "split", "regrouped"};
    return kNames[static_cast<std::size_t>(kind)];
}

std::string_view changeOf(bool before, bool after) {
    return before && after ? "changed" : after ? "added" : "removed";
}

// "1 Pbr"; empty beyond the end of the list.
std::string shaderAt(const std::vector<int>& ids, std::size_t place, const inspect::DiffPackage& package,
                     Detail detail) {
    return place < ids.size() ? shaderTitle(static_cast<std::uint64_t>(ids[place]),
                                            package.cases.at(ids[place]).name, detail)
                              : std::string();
}

// Returns "+1: normals" for one key, "+3" for several.
std::string keyCount(char sign, const Rows& keys) {
    if (keys.empty()) {
        return {};
    }
    const std::string one =
        keys.front().empty() ? std::string("no features") : fmt::format("{}", fmt::join(keys.front(), " "));
    return keys.size() == 1 ? fmt::format("{}1: {}", sign, one) : fmt::format("{}{}", sign, keys.size());
}

std::string keyChanges(const inspect::ShaderChange& change) {
    const std::string added = keyCount('+', change.keysAdded);
    const std::string removed = keyCount('-', change.keysRemoved);
    return added + (added.empty() || removed.empty() ? "" : ", ") + removed;
}

std::string moduleName(const inspect::ModuleChange& change) {
    std::string name(package::roleName(change.key.role));
    const auto id = [](const std::optional<int>& value) {
        return value ? fmt::format("{}", *value) : std::string("-");
    };
    if (change.idBefore || change.idAfter) {
        const bool moved = change.idBefore && change.idAfter && change.idBefore != change.idAfter;
        name += moved ? fmt::format(" {} -> {}", id(change.idBefore), id(change.idAfter))
                      : fmt::format(" {}", id(change.idBefore ? change.idBefore : change.idAfter));
    }
    for (const std::string& word : {orderingName(change.key), tracerName(change.key)}) {
        name += word.empty() ? std::string() : fmt::format(" {}", word);
    }
    return name;
}

// Returns "12 -> 14", or "12" if the value is the same.
std::string step(std::uint64_t before, std::uint64_t after) {
    return before == after ? fmt::format("{}", before) : fmt::format("{} -> {}", before, after);
}

std::string settingTable(const inspect::PackageDiff& diff, const DiffSides& sides) {
    Rows rows{{"setting", sides.nameBefore, sides.nameAfter}};
    for (const inspect::SettingChange& change : diff.settings) {
        rows.push_back({change.name, change.before, change.after});
    }
    return rows.size() > 1 ? formatTable(rows) + "\n" : std::string();
}

std::string shaderTable(const inspect::PackageDiff& diff, const DiffSides& sides, Detail detail) {
    Rows rows{{"shaders", "before", "after", "keys"}};
    for (const inspect::ShaderChange& change : diff.shaders) {
        const std::size_t count = std::max(change.before.size(), change.after.size());
        for (std::size_t i = 0; i < count; ++i) {
            rows.push_back({i == 0 ? std::string(nameOf(change.kind)) : "",
                            shaderAt(change.before, i, sides.before, detail),
                            shaderAt(change.after, i, sides.after, detail),
                            i == 0 ? keyChanges(change) : ""});
        }
    }
    // Not as a table of numbers, though cells begin with IDs.
    return rows.size() > 1 ? formatFields(rows, detail) + "\n" : std::string();
}

std::string moduleTable(const inspect::PackageDiff& diff) {
    Rows rows{{"code", "module", "bytes", "instructions", "fetches"}};
    for (const inspect::ModuleChange& change : diff.modules) {
        const compiler::SpirvStatistics before =
            change.before != nullptr ? change.before->statistics : compiler::SpirvStatistics{};
        const compiler::SpirvStatistics after =
            change.after != nullptr ? change.after->statistics : compiler::SpirvStatistics{};
        rows.push_back({std::string(changeOf(change.before != nullptr, change.after != nullptr)),
                        moduleName(change), step(before.bytes, after.bytes),
                        step(before.instructions, after.instructions),
                        step(before.textureFetches, after.textureFetches)});
    }
    return rows.size() > 1 ? formatTable(rows) + "\n" : std::string();
}

std::string materialName(const inspect::DiffMaterial& material) {
    std::string name = material.scene.empty() ? "" : material.scene + ": ";
    name += material.name.empty() ? "(no name)" : material.name;
    return name + (material.sameNamed > 0 ? fmt::format(" #{}", material.sameNamed + 1) : std::string());
}

std::string materialTable(const inspect::PackageDiff& diff) {
    Rows rows{{"materials", "name", "shaders"}};
    const auto ids = [](const std::vector<int>& list) {
        return list.empty() ? std::string("-") : fmt::format("{}", fmt::join(list, ", "));
    };
    const std::size_t shown = std::min(diff.materials.size(), kMaxMaterials);
    for (std::size_t i = 0; i < shown; ++i) {
        const inspect::MaterialChange& change = diff.materials[i];
        rows.push_back({std::string(changeOf(!change.before.empty(), !change.after.empty())),
                        materialName(change.material),
                        fmt::format("{} -> {}", ids(change.before), ids(change.after))});
    }
    if (rows.size() == 1) {
        return {};
    }
    const std::size_t more = diff.materials.size() - shown;
    return formatFields(rows) + (more > 0 ? fmt::format("and {} more, which --json lists\n", more) : "") +
           "\n";
}

std::string totalTable(const inspect::PackageDiff& diff) {
    Rows rows{{"total", "before", "after", "change"}};
    for (const inspect::TotalChange& change : diff.totals) {
        const bool grows = change.after > change.before;
        rows.push_back({change.name, fmt::format("{}", change.before), fmt::format("{}", change.after),
                        fmt::format("{}{}", grows ? "+" : "-",
                                    grows ? change.after - change.before : change.before - change.after)});
    }
    return rows.size() > 1 ? formatTable(rows) + "\n" : std::string();
}

base::Json idsToJson(const std::vector<int>& ids, const inspect::DiffPackage& package) {
    return listOf(ids, [&](int id) -> base::Json {
        const inspect::DiffCase& shader = package.cases.at(id);
        return {{"id", id}, {"name", shader.name}, {"keys", shader.keys.size()}};
    });
}

base::Json moduleToJson(const inspect::DiffModule* module, std::optional<int> shaderId) {
    if (module == nullptr) {
        return nullptr;
    }
    base::Json json{{"shaderId", base::orNull(shaderId)}, {"file", module->file}};
    json.update(base::jsonOf(module->statistics));
    return json;
}

base::Json toJson(const inspect::ModuleChange& change) {
    return {{"change", changeOf(change.before != nullptr, change.after != nullptr)},
            {"role", std::string(package::roleName(change.key.role))},
            {"ordering", base::textOrNull(orderingName(change.key))},
            {"tracer", base::textOrNull(tracerName(change.key))},
            {"before", moduleToJson(change.before, change.idBefore)},
            {"after", moduleToJson(change.after, change.idAfter)}};
}

base::Json toJson(const inspect::MaterialChange& change) {
    return {{"change", changeOf(!change.before.empty(), !change.after.empty())},
            {"scene", base::textOrNull(change.material.scene)},
            {"name", change.material.name},
            {"sameNamed", change.material.sameNamed},
            {"before", change.before},
            {"after", change.after}};
}

std::string diffText(const inspect::PackageDiff& diff, const DiffSides& sides, Detail detail) {
    std::string text = settingTable(diff, sides) + shaderTable(diff, sides, detail) + moduleTable(diff) +
                       materialTable(diff) + totalTable(diff);
    if (diff.tablesDiffer) {
        text += "tables.bin differs\n";
    }
    return text + fmt::format("the same: {} shaders, {} modules, {} materials\n", diff.sameShaders,
                              diff.sameModules, diff.sameMaterials);
}

base::Json diffJson(const inspect::PackageDiff& diff, const DiffSides& sides) {
    const auto valueToJson = [](const auto& change) -> base::Json {
        return {{"name", change.name}, {"before", change.before}, {"after", change.after}};
    };
    const auto shaderToJson = [&](const inspect::ShaderChange& change) -> base::Json {
        return {{"change", nameOf(change.kind)},
                {"before", idsToJson(change.before, sides.before)},
                {"after", idsToJson(change.after, sides.after)},
                {"keysAdded", change.keysAdded},
                {"keysRemoved", change.keysRemoved}};
    };
    const auto changeToJson = [](const auto& change) { return toJson(change); };
    return {
        {"a", sides.nameBefore},
        {"b", sides.nameAfter},
        {"differ", !diff.isEmpty()},
        {"settings", listOf(diff.settings, valueToJson)},
        {"shaders", listOf(diff.shaders, shaderToJson)},
        {"modules", listOf(diff.modules, changeToJson)},
        {"materials", listOf(diff.materials, changeToJson)},
        {"totals", listOf(diff.totals, valueToJson)},
        {"tablesDiffer", diff.tablesDiffer},
        {"same",
         {{"shaders", diff.sameShaders}, {"modules", diff.sameModules}, {"materials", diff.sameMaterials}}}};
}

struct DiffArguments {
    std::string before;
    std::string after;
    bool exitCode = false;
};

Result<int> diff(const Console& console, const DiffArguments& arguments) {
    GLINT_TRY(const auto before, inspect::readDiffPackage(arguments.before));
    GLINT_TRY(const auto after, inspect::readDiffPackage(arguments.after));
    const inspect::PackageDiff difference = inspect::comparePackages(before, after);
    const DiffSides sides{arguments.before, arguments.after, before, after};
    answer(
        console, [&] { return diffJson(difference, sides); },
        [&](Detail detail) { return diffText(difference, sides, detail); });
    return arguments.exitCode && !difference.isEmpty() ? kExitFailed : kExitDone;
}

}  // namespace

void addDiff(CLI::App& app, Action& chosen) {
    auto arguments = std::make_shared<DiffArguments>();
    CLI::App& command =
        addCommand(app, {.name = "diff",
                         .what = "Show the differences between two packages",
                         .examples = {"glint diff before.glint after.glint",
                                      "glint diff before.glint after.glint --exit-code --quiet"},
                         .usual = {"--exit-code", "--verbose", "--json"}});
    addText(command, "A", arguments->before, "DIR", "folder of the package before").required();
    addText(command, "B", arguments->after, "DIR", "folder of the package after").required();
    addFlag(command, "--exit-code", arguments->exitCode, "exit 1 if anything differs");
    command.callback([arguments, &chosen] {
        chosen = [arguments](const Console& console) { return diff(console, *arguments); };
    });
}

}  // namespace glint::cli
