// glint inspect: shows the contents of a package.
#include "cli/command_line.h"
#include "cli/inspect/pipelines.h"
#include "cli/options/options.h"
#include "cli/report.h"
#include "cli/table.h"
#include "emit/package/manifest.h"
#include "inspect/package.h"
#include "plan/plan.h"
#include "resolve/resolve.h"
#include "settings/descriptor.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <memory>

namespace glint::cli {

namespace {

base::Json describe(const inspect::InspectedPackage& inspected, const inspect::InspectedModule& module) {
    const package::RoleInfo& info = *package::findRole(module.entry->role);
    const bool isCase = info.repeated == package::Repeated::ByCase;
    return {{"role", std::string(info.name)},
            {"shaderId", isCase ? base::Json(module.entry->index) : base::Json(nullptr)},
            {"tracer", base::textOrNull(tracerName(module.key()))},
            {"ordering", base::textOrNull(orderingName(module.key()))},
            {"file", inspected.file(module)}};
}

base::Json modulesToJson(const inspect::InspectedPackage& inspected) {
    base::Json list = base::Json::array();
    for (const inspect::InspectedModule& module : inspected.modules) {
        base::Json entry = describe(inspected, module);
        entry.update(base::jsonOf(module.statistics));
        list.push_back(std::move(entry));
    }
    return list;
}

base::Json stagesOf(const inspect::InspectedPackage& inspected, std::uint32_t shaderId) {
    base::Json stages = base::Json::object();
    for (const inspect::InspectedModule* module : inspected.modulesOf(shaderId)) {
        base::Json entry{{"file", inspected.file(*module)}};
        entry.update(base::jsonOf(module->statistics));
        stages[std::string(compiler::stageName(module->key()))] = std::move(entry);
    }
    return stages;
}

base::Json shadersToJson(const inspect::InspectedPackage& inspected) {
    base::Json list = base::Json::array();
    std::uint32_t id = 0;
    for (const package::CaseEntry& shader : inspected.package.cases()) {
        base::Json materials = base::Json::array();
        const auto found = inspected.materials.find(id);
        if (found != inspected.materials.end()) {
            for (const inspect::MaterialPlace& material : found->second) {
                materials.push_back(base::Json{{"scene", material.first},
                                               {"index", material.second},
                                               {"name", inspected.materialName(material)}});
            }
        }
        list.push_back(base::Json{{"id", id},
                                  {"name", std::string(inspected.package.string(shader.name))},
                                  {"always", inspected.package.featureNames(shader.always)},
                                  {"sometimes", inspected.package.featureNames(shader.sometimes)},
                                  {"keys", shader.keyCount},
                                  {"materials", materials},
                                  {"stages", stagesOf(inspected, id)}});
        ++id;
    }
    return list;
}

base::Json scenesToJson(const inspect::InspectedPackage& inspected) {
    base::Json list = base::Json::array();
    for (std::uint32_t i = 0; i < inspected.package.sceneCount(); ++i) {
        const PackageScene scene = inspected.package.scene(i);
        list.push_back(base::Json{{"name", std::string(scene.name)},
                                  {"variant", base::textOrNull(inspected.variantOf(i))},
                                  {"materials", scene.materials.size()},
                                  {"primitives", scene.primitives.size()},
                                  {"textures", scene.textures.size()},
                                  {"samplers", scene.samplers.size()}});
    }
    return list;
}

package::ShadowPlacement firstShadowsOf(const Package& package) {
    return package.shape().defersFirstShadows() ? package::ShadowPlacement::Deferred
                                                : package::ShadowPlacement::Inline;
}

std::string bindingsOf(const Package& package) {
    compiler::Settings settings;
    settings.compile.bindings = package.bindings();
    return std::ranges::find(compiler::settingsTable(), "bindings", &compiler::Descriptor::name)
        ->values.text(settings);
}

std::string lightsOf(const Package& package) {
    return package.lightSamples() == 0 ? "all" : fmt::format("{}", package.lightSamples());
}

std::string skyOf(const Package& package) {
    return package.environmentMap() ? "map" : "gradient";
}

std::string sceneTable(const inspect::InspectedPackage& inspected) {
    Rows rows{{"scene", "variant", "materials", "primitives", "textures", "samplers"}};
    for (std::uint32_t i = 0; i < inspected.package.sceneCount(); ++i) {
        const PackageScene scene = inspected.package.scene(i);
        const std::string variant = inspected.variantOf(i);
        rows.push_back({std::string(scene.name), variant.empty() ? "-" : variant,
                        fmt::format("{}", scene.materials.size()), fmt::format("{}", scene.primitives.size()),
                        fmt::format("{}", scene.textures.size()), fmt::format("{}", scene.samplers.size())});
    }
    return formatTable(rows);
}

// Returns the first few names, and how many more there are.
std::string materialsText(const inspect::InspectedPackage& inspected, std::uint32_t shaderId) {
    const auto found = inspected.materials.find(shaderId);
    if (found == inspected.materials.end()) {
        return "-";
    }
    std::vector<std::string> names;
    for (const inspect::MaterialPlace& material : found->second) {
        names.push_back(inspected.materialName(material));
    }
    return base::firstOf(names, 3);
}

// Features that a shader has; their names where there is room for them.
std::string featuresText(const std::vector<std::string>& names, Detail detail) {
    return detail == Detail::Whole ? base::join(names) : fmt::format("{}", names.size());
}

std::string shaderTable(const inspect::InspectedPackage& inspected, Detail detail) {
    Rows rows{{"shader", "keys", "always", "sometimes", "materials"}};
    std::uint32_t id = 0;
    for (const package::CaseEntry& shader : inspected.package.cases()) {
        rows.push_back({shaderTitle(id, inspected.package.string(shader.name), detail),
                        fmt::format("{}", shader.keyCount),
                        featuresText(inspected.package.featureNames(shader.always), detail),
                        featuresText(inspected.package.featureNames(shader.sometimes), detail),
                        materialsText(inspected, id)});
        ++id;
    }
    return formatTable(rows, detail);
}

// Returns the shader's ID or the ordering, if a role has several modules.
std::string whichText(const inspect::InspectedModule& module) {
    const bool isCase = package::findRole(module.entry->role)->repeated == package::Repeated::ByCase;
    const std::string ordering = orderingName(module.key());
    return isCase ? fmt::format(" {}", module.entry->index) : ordering.empty() ? "" : " " + ordering;
}

std::string titleOf(const inspect::InspectedModule& module) {
    return std::string(package::roleName(module.entry->role)) + whichText(module);
}

std::string moduleTable(const inspect::InspectedPackage& inspected, Detail detail) {
    Rows rows{{"module", "tracer", "file", "bytes", "instructions", "fetches", "queries", "branches"}};
    for (const inspect::InspectedModule& module : inspected.modules) {
        const std::string tracer = tracerName(module.key());
        const compiler::SpirvStatistics& it = module.statistics;
        rows.push_back({titleOf(module), tracer.empty() ? "-" : tracer, inspected.file(module),
                        fmt::format("{}", it.bytes), fmt::format("{}", it.instructions),
                        fmt::format("{}", it.textureFetches), fmt::format("{}", it.rayQueries),
                        fmt::format("{}", it.branches)});
    }
    return formatTable(rows, detail);
}

std::string hitLobesText(const inspect::Manifest& manifest) {
    return manifest.hitLobes.size() == static_cast<std::size_t>(std::ranges::count_if(manifest.features, &compiler::ManifestFeature::lobe))
               ? "all"
               : base::join(manifest.hitLobes);
}

std::vector<std::string> layerNames(const Package& package) {
    std::vector<std::string> names;
    for (const package::PackageLayer& layer : package.layers()) {
        names.push_back(layer.name);
    }
    return names;
}

std::string layersText(const Package& package) {
    return package.layers().empty() ? "none"
                                    : fmt::format("{}; {} bytes a pixel", base::join(layerNames(package)),
                                                  package::bytesOf(package.layers()));
}

base::Json layersToJson(const Package& package) {
    base::Json list = base::Json::array();
    for (const package::PackageLayer& layer : package.layers()) {
        const package::LayerFormatInfo& format = package::infoOf(layer.info->format);
        list.push_back(base::Json{{"name", layer.name},
                                  {"channels", std::string(layer.info->channels)},
                                  {"format", std::string(format.qualifier)},
                                  {"bytes", format.bytes}});
    }
    return list;
}

base::Json toJson(const inspect::InspectedPackage& inspected) {
    const Package& package = inspected.package;
    const inspect::Manifest& manifest = inspected.manifest;
    return {
        {"package", inspected.folder},
        {"version", package::kVersion},
        {"tool", manifest.toolVersion},
        {"strategies", compiler::strategyNames(package.shape().strategies)},
        {"tracers", compiler::tracerNames(package.shape().tracers)},
        {"merge", manifest.merge},
        {"alpha", nameOf(package.alpha())},
        {"host", manifest.host},
        {"packs", manifest.packs},
        {"scenes", scenesToJson(inspected)},
        {"settings",
         {{"hitLobes", manifest.hitLobes},
          {"lights", package.lightSamples() == 0 ? base::Json("all") : base::Json(package.lightSamples())},
          {"emissiveLights", package.emission() != nullptr},
          {"skyLight", package.skyLight()},
          {"sizedLights", package.sizedLights()},
          {"energyCompensation", manifest.setting("energyCompensation") == "on"},
          {"trustTextures", manifest.setting("trustTextures") == "on"},
          {"textureLod", std::string(manifest.setting("textureLod"))},
          {"textureLevels", package.textureLevels()},
          {"layers",
           package.layers().empty() ? "none" : fmt::format("{}", fmt::join(layerNames(package), ","))},
          {"precision", package::bitsOf(package.precision())},
          {"shadows", std::string(package::nameOf(package.shape().shadows))},
          {"firstShadows", std::string(package::nameOf(firstShadowsOf(package)))},
          {"shadowThrough", std::string(package::nameOf(package.shadowThrough()))},
          {"hitRecord", std::string(package::nameOf(package.hitRecord()))},
          {"sampleRecord", std::string(package::nameOf(package.sampleRecord()))},
          {"bounces", package.shape().maxBounces},
          {"fallback", package.shape().fallback},
          {"passes", std::string(package::nameOf(package.passes()))},
          {"answer", std::string(package::nameOf(package.answer()))},
          {"bindings", bindingsOf(package)},
          {"positionFetch", package.positionFetch()},
          {"sky", skyOf(package)}}},
        {"counts",
         {{"cases", inspected.caseCount()},
          {"buckets", package.bucketCount()},
          {"bytesPerMaterial", package.scene(0).materials.recordBytes},
          {"modules", package.modules().size()},
          {"uniqueSpirv", inspected.uniqueFiles()}}},
        {"layers", layersToJson(package)},
        {"traffic",
         package.passes() == package::Passes::Frame ? base::jsonOf(trafficOf(package)) : base::Json::array()},
        {"spirvBytes", inspected.spirvBytes()},
        {"shaders", shadersToJson(inspected)},
        {"modules", modulesToJson(inspected)}};
}

std::string toText(const inspect::InspectedPackage& inspected, Detail detail) {
    const Package& package = inspected.package;
    const inspect::Manifest& manifest = inspected.manifest;
    const std::string summary = formatFields(
        {{"package", inspected.folder},
         {"made by", fmt::format("glint {}, format {}", manifest.toolVersion, package::kVersion)},
         {"strategies", base::join(compiler::strategyNames(package.shape().strategies))},
         {"tracers", base::join(compiler::tracerNames(package.shape().tracers))},
         {"shadow rays", std::string(package::nameOf(package.shape().shadows))},
         {"first shadow rays", std::string(package::nameOf(firstShadowsOf(package)))},
         {"shadows through", std::string(package::nameOf(package.shadowThrough()))},
         {"hit record", package.hitsInSamples() ? std::string("in the record of its sample")
                                                : std::string(package::nameOf(package.hitRecord()))},
         {"sample record", std::string(package::nameOf(package.sampleRecord()))},
         {"bounces", std::to_string(package.shape().maxBounces)},
         {"fallback", package.shape().fallback ? "yes" : "no"},
         {"passes", std::string(package::nameOf(package.passes()))},
         {"answer", std::string(package::nameOf(package.answer()))},
         {"bindings", bindingsOf(package)},
         {"position fetch", package.positionFetch() ? "yes" : "no"},
         {"sky", skyOf(package)},
         {"merge", manifest.merge},
         {"alpha", std::string(nameOf(package.alpha()))},
         {"host", manifest.host.empty() ? "Glint's own" : base::join(manifest.host)},
         {"packs", manifest.packs.empty() ? "none" : base::join(manifest.packs)},
         {"hit lobes", hitLobesText(manifest)},
         {"lights of a surface", lightsOf(package)},
         {"energy compensation", std::string(manifest.setting("energyCompensation"))},
         {"trust textures", std::string(manifest.setting("trustTextures"))},
         {"texture LOD", std::string(manifest.setting("textureLod"))},
         {"precision", fmt::format("{}", package::bitsOf(package.precision()))},
         {"layers", layersText(package)},
         {"bytes a material", fmt::format("{}", inspected.package.scene(0).materials.recordBytes)},
         {"cases", fmt::format("{}", inspected.caseCount())},
         {"SPIR-V", fmt::format("{} modules, {} unique, {}", package.modules().size(),
                                inspected.uniqueFiles(), formatBytes(inspected.spirvBytes()))}});
    const std::string traffic =
        package.passes() == package::Passes::Frame ? trafficTable(package) + "\n" : std::string();
    return summary + "\n" + traffic + sceneTable(inspected) + "\n" + shaderTable(inspected, detail) + "\n" +
           moduleTable(inspected, detail);
}

base::Json toJson(const inspect::InspectedPackage& inspected, const std::vector<inspect::Disassembly>& list) {
    base::Json modules = base::Json::array();
    for (const inspect::Disassembly& entry : list) {
        base::Json module = describe(inspected, *entry.module);
        module["text"] = entry.text;
        modules.push_back(std::move(module));
    }
    return {{"package", inspected.folder}, {"disassembly", modules}};
}

std::string toText(const inspect::InspectedPackage& inspected,
                   const std::vector<inspect::Disassembly>& list) {
    std::string text;
    for (const inspect::Disassembly& entry : list) {
        const std::string tracer = tracerName(entry.module->key());
        text += fmt::format("{}; {}: {}{}\n{}", text.empty() ? "" : "\n", inspected.file(*entry.module),
                            titleOf(*entry.module), tracer.empty() ? "" : ", " + tracer, entry.text);
    }
    return text;
}

struct InspectArguments {
    std::string folder;
    std::string disassemble;  // empty: an overview instead
    PackagePipelineArguments pipelines;
};

Result<int> show(const Console& console, const InspectArguments& arguments) {
    console.progress("reading " + arguments.folder);
    GLINT_TRY(const auto package, Package::load(arguments.folder));
    if (arguments.pipelines.enabled) {
        return showPipelines(console, package, arguments.folder, arguments.pipelines);
    }
    GLINT_TRY(const auto manifest, inspect::readManifest(arguments.folder));
    GLINT_TRY(const auto inspected, inspect::inspectPackage(package, manifest, arguments.folder));
    if (!arguments.disassemble.empty()) {
        GLINT_TRY(const auto list, inspect::disassembleModules(inspected, arguments.disassemble));
        console.isJson() ? console.result(toJson(inspected, list)) : console.print(toText(inspected, list));
    } else if (console.isJson()) {
        console.result(toJson(inspected));
    } else {
        console.print(toText(inspected, console.isVerbose() ? Detail::Whole : Detail::Short));
    }
    return kExitDone;
}

}  // namespace

void addInspect(CLI::App& app, Action& chosen) {
    auto arguments = std::make_shared<InspectArguments>();
    CLI::App& command = addCommand(
        app, {.name = "inspect",
              .what = "Show what a package contains",
              .examples = {"glint inspect scene.glint", "glint inspect scene.glint --disassemble 0"},
              .usual = {"--disassemble", "--verbose", "--json"}});
    addText(command, "DIR", arguments->folder, "DIR", "folder of the package").required();
    addText(command, "--disassemble", arguments->disassemble, "ID|NAME",
            "print modules as SPIR-V assembly instead: those of a shader by ID or name, of a role, or of a "
            "file (default: off)");
    addPipelineReportOptions(command, arguments->pipelines);
    command.get_option("--disassemble")->excludes(command.get_option("--pipelines"));
    command.callback([arguments, &chosen] {
        chosen = [arguments](const Console& console) { return show(console, *arguments); };
    });
}

}  // namespace glint::cli
