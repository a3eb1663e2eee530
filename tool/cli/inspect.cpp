// glint inspect: what a package holds.
#include "cli/command_line.h"
#include "cli/commands.h"
#include "cli/manifest.h"
#include "cli/report.h"
#include "cli/table.h"
#include "emit/modules.h"
#include "spirv/statistics.h"

#include <glint/package.h>

#include <fmt/format.h>

#include <algorithm>
#include <interop/scene.h>
#include <map>
#include <memory>
#include <set>

namespace glint {

namespace {

struct InspectArguments {
    std::string folder;
    bool json = false;
};

struct Module {
    const package::ModuleEntry* entry = nullptr;
    SpirvStatistics statistics;
};

struct Contents {
    // Those that are not retired.
    std::size_t cases() const {
        return static_cast<std::size_t>(std::ranges::count_if(
            package.cases(), [](const package::CaseEntry& entry) { return entry.keyCount > 0; }));
    }

    const Package& package;
    const Manifest& manifest;
    std::vector<Module> modules;
    std::map<std::uint32_t, std::set<std::pair<std::uint32_t, std::uint32_t>>>
        materials;  // (scene, index) by shader ID
};

Result<Contents> gather(const Package& package, const Manifest& manifest) {
    Contents contents{package, manifest, {}, {}};
    for (const package::ModuleEntry& entry : package.modules()) {
        const Result<SpirvStatistics> statistics =
            measureSpirv(package.spirv({entry.role, entry.index, entry.tracer}));
        if (!statistics) {
            return statistics.error();
        }
        contents.modules.push_back({&entry, *statistics});
    }
    for (std::uint32_t scene = 0; scene < package.sceneCount(); ++scene) {
        for (const package::PrimitiveEntry& primitive : package.scene(scene).primitives) {
            contents.materials[primitive.shaderId].insert({scene, primitive.materialIndex});
        }
    }
    return contents;
}

std::string nameOf(const Contents& contents, const std::pair<std::uint32_t, std::uint32_t>& material) {
    const auto found = contents.manifest.materialNames.find(material);
    return found != contents.manifest.materialNames.end() ? found->second
                                                          : fmt::format("material {}", material.second);
}

// Modules that share a file count once.
std::uint64_t spirvBytes(const Contents& contents, std::size_t& files) {
    std::map<std::string_view, std::uint64_t> bytes;
    for (const Module& module : contents.modules) {
        bytes[contents.package.string(module.entry->file)] = module.entry->bytes;
    }
    std::uint64_t total = 0;
    for (const auto& [file, size] : bytes) {
        total += size;
    }
    files = bytes.size();
    return total;
}

Json modulesToJson(const Contents& contents) {
    Json list = Json::array();
    for (const Module& module : contents.modules) {
        const package::RoleInfo& info = *package::findRole(module.entry->role);
        const bool isCase = info.repeated == package::Repeated::ByCase;
        list.push_back(Json{{"role", std::string(info.name)},
                            {"shaderId", isCase ? Json(module.entry->index) : Json(nullptr)},
                            {"file", std::string(contents.package.string(module.entry->file))},
                            {"bytes", module.entry->bytes},
                            {"instructions", module.statistics.instructions},
                            {"textureFetches", module.statistics.textureFetches},
                            {"rayQueries", module.statistics.rayQueries},
                            {"branches", module.statistics.branches}});
    }
    return list;
}

Json shadersToJson(const Contents& contents) {
    Json list = Json::array();
    std::uint32_t id = 0;
    for (const package::CaseEntry& shader : contents.package.cases()) {
        Json materials = Json::array();
        const auto found = contents.materials.find(id);
        if (found != contents.materials.end()) {
            for (const auto& material : found->second) {
                materials.push_back(Json{{"scene", material.first},
                                         {"index", material.second},
                                         {"name", nameOf(contents, material)}});
            }
        }
        list.push_back(Json{{"id", id},
                            {"name", std::string(contents.package.string(shader.name))},
                            {"always", featuresToJson(shader.always)},
                            {"sometimes", featuresToJson(shader.sometimes)},
                            {"keys", shader.keyCount},
                            {"materials", materials}});
        ++id;
    }
    return list;
}

// Empty: none.
std::string variantOf(const Contents& contents, std::uint32_t scene) {
    return scene < contents.manifest.variants.size() ? contents.manifest.variants[scene] : std::string();
}

Json scenesToJson(const Contents& contents) {
    Json list = Json::array();
    for (std::uint32_t i = 0; i < contents.package.sceneCount(); ++i) {
        const PackageScene scene = contents.package.scene(i);
        list.push_back(Json{{"name", std::string(scene.name)},
                            {"variant", textOrNull(variantOf(contents, i))},
                            {"materials", scene.materials.size()},
                            {"primitives", scene.primitives.size()},
                            {"textures", scene.textures.size()},
                            {"samplers", scene.samplers.size()}});
    }
    return list;
}

Json toJson(const Contents& contents, const std::string& folder) {
    std::size_t files = 0;
    const std::uint64_t bytes = spirvBytes(contents, files);
    const Package& package = contents.package;
    return {{"package", folder},
            {"version", package::kVersion},
            {"tool", contents.manifest.toolVersion},
            {"strategies", strategyNames(package.shape().strategies)},
            {"tracers", tracerNames(package.shape().tracers)},
            {"merge", contents.manifest.merge},
            {"alpha", package.alphaTested() ? "tested" : "opaque"},
            {"scenes", scenesToJson(contents)},
            {"settings",
             {{"hitLobes", contents.manifest.hitLobes},
              {"energyCompensation", contents.manifest.energyCompensation},
              {"textureLod", contents.manifest.textureLod},
              {"shadows", std::string(package::nameOf(package.shape().shadows))},
              {"hitRecord", std::string(package::nameOf(package.hitRecord()))},
              {"sky", package.environmentMap() ? "map" : "gradient"}}},
            {"counts",
             {{"cases", contents.cases()},
              {"buckets", package.bucketCount()},
              {"modules", package.modules().size()},
              {"uniqueSpirv", files}}},
            {"spirvBytes", bytes},
            {"shaders", shadersToJson(contents)},
            {"modules", modulesToJson(contents)}};
}

std::string sceneTable(const Contents& contents) {
    std::vector<std::vector<std::string>> rows{
        {"scene", "variant", "materials", "primitives", "textures", "samplers"}};
    for (std::uint32_t i = 0; i < contents.package.sceneCount(); ++i) {
        const PackageScene scene = contents.package.scene(i);
        const std::string variant = variantOf(contents, i);
        rows.push_back({std::string(scene.name), variant.empty() ? "-" : variant,
                        fmt::format("{}", scene.materials.size()), fmt::format("{}", scene.primitives.size()),
                        fmt::format("{}", scene.textures.size()), fmt::format("{}", scene.samplers.size())});
    }
    return formatTable(rows);
}

std::string shaderTable(const Contents& contents) {
    std::vector<std::vector<std::string>> rows{{"id", "shader", "keys", "materials", "always", "sometimes"}};
    std::uint32_t id = 0;
    for (const package::CaseEntry& shader : contents.package.cases()) {
        const auto found = contents.materials.find(id);
        const std::size_t materials = found == contents.materials.end() ? 0 : found->second.size();
        rows.push_back({fmt::format("{}", id), std::string(contents.package.string(shader.name)),
                        fmt::format("{}", shader.keyCount), fmt::format("{}", materials),
                        featureList(shader.always), featureList(shader.sometimes)});
        ++id;
    }
    return formatTable(rows);
}

std::string moduleTable(const Contents& contents) {
    std::vector<std::vector<std::string>> rows{
        {"module", "file", "bytes", "instructions", "fetches", "queries", "branches"}};
    for (const Module& module : contents.modules) {
        const package::RoleInfo& info = *package::findRole(module.entry->role);
        const std::string which =
            info.repeated == package::Repeated::ByCase ? fmt::format(" {}", module.entry->index)
            : info.repeated == package::Repeated::ByOrdering
                ? fmt::format(" {}", package::nameOf(static_cast<package::Ordering>(module.entry->index)))
                : std::string();
        rows.push_back(
            {std::string(info.name) + which, std::string(contents.package.string(module.entry->file)),
             fmt::format("{}", module.entry->bytes), fmt::format("{}", module.statistics.instructions),
             fmt::format("{}", module.statistics.textureFetches),
             fmt::format("{}", module.statistics.rayQueries), fmt::format("{}", module.statistics.branches)});
    }
    return formatTable(rows);
}

std::string hitLobesText(const Manifest& manifest) {
    return manifest.hitLobes.size() == featureNames(kLobeMask).size() ? "all" : join(manifest.hitLobes);
}

std::string toText(const Contents& contents, const std::string& folder) {
    std::size_t files = 0;
    const std::uint64_t bytes = spirvBytes(contents, files);
    const Package& package = contents.package;
    const std::string summary = formatFields(
        {{"package", folder},
         {"made by", fmt::format("glint {}, format {}", contents.manifest.toolVersion, package::kVersion)},
         {"strategies", join(strategyNames(package.shape().strategies))},
         {"tracers", join(tracerNames(package.shape().tracers))},
         {"shadow rays", std::string(package::nameOf(package.shape().shadows))},
         {"hit record", std::string(package::nameOf(package.hitRecord()))},
         {"merge", contents.manifest.merge},
         {"alpha", package.alphaTested() ? "tested" : "opaque"},
         {"hit lobes", hitLobesText(contents.manifest)},
         {"energy compensation", contents.manifest.energyCompensation ? "on" : "off"},
         {"texture LOD", contents.manifest.textureLod},
         {"cases", fmt::format("{}", contents.cases())},
         {"SPIR-V",
          fmt::format("{} modules, {} unique, {}", package.modules().size(), files, formatBytes(bytes))}});
    return summary + "\n" + sceneTable(contents) + "\n" + shaderTable(contents) + "\n" +
           moduleTable(contents);
}

int inspect(const Console& console, const InspectArguments& arguments) {
    const auto fail = [&](const Diagnostic& error) {
        console.report(error);
        return kExitFailed;
    };
    const Result<Package> package = Package::load(arguments.folder);
    if (!package) {
        return fail(package.error());
    }
    const Result<Manifest> manifest = readManifest(arguments.folder);
    if (!manifest) {
        return fail(manifest.error());
    }
    const Result<Contents> contents = gather(*package, *manifest);
    if (!contents) {
        return fail(contents.error());
    }
    console.print(arguments.json ? glint::toText(toJson(*contents, arguments.folder))
                                 : toText(*contents, arguments.folder));
    return kExitDone;
}

}  // namespace

void addInspect(CLI::App& app, Action& chosen) {
    auto arguments = std::make_shared<InspectArguments>();
    CLI::App& command = addCommand(app, "inspect", "Show what a package holds", "glint inspect scene.glint");
    addText(command, "DIR", arguments->folder, "DIR", "folder of the package").required();
    addFlag(command, "--json", arguments->json, "print as JSON");
    command.callback([arguments, &chosen] {
        chosen = [arguments](const Console& console) { return inspect(console, *arguments); };
    });
}

}  // namespace glint
