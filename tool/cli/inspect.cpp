// glint inspect: shows the contents of a package.
#include "base/lists.h"
#include "cli/command_line.h"
#include "cli/options/options.h"
#include "cli/render/report.h"
#include "cli/report.h"
#include "emit/package/manifest.h"
#include "inspect/pipelines.h"
#include "resolve/resolve.h"
#include "settings/descriptor.h"

#include <glint/measure/observer.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <set>

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
    return listOf(inspected.modules, [&](const inspect::InspectedModule& module) {
        base::Json entry = describe(inspected, module);
        entry.update(base::jsonOf(module.statistics));
        return entry;
    });
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

// Returns the materials that have the shader.
std::set<inspect::MaterialPlace> materialsOf(const inspect::InspectedPackage& inspected,
                                             std::uint32_t shaderId) {
    const auto found = inspected.materials.find(shaderId);
    return found == inspected.materials.end() ? std::set<inspect::MaterialPlace>() : found->second;
}

base::Json shadersToJson(const inspect::InspectedPackage& inspected) {
    const auto materialToJson = [&](const inspect::MaterialPlace& material) -> base::Json {
        return {{"scene", material.first},
                {"index", material.second},
                {"name", inspected.materialName(material)}};
    };
    std::uint32_t id = 0;
    return listOf(inspected.package.cases(), [&](const package::CaseEntry& shader) -> base::Json {
        const std::uint32_t own = id++;
        return {{"id", own},
                {"name", std::string(inspected.package.string(shader.name))},
                {"always", inspected.package.featureNames(shader.always)},
                {"sometimes", inspected.package.featureNames(shader.sometimes)},
                {"keys", shader.keyCount},
                {"materials", listOf(materialsOf(inspected, own), materialToJson)},
                {"stages", stagesOf(inspected, own)}};
    });
}

base::Json scenesToJson(const inspect::InspectedPackage& inspected) {
    base::Json list = base::Json::array();
    for (std::uint32_t i = 0; i < inspected.package.sceneCount(); ++i) {
        const PackageScene scene = inspected.package.scene(i);
        list.push_back({{"name", std::string(scene.name)},
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
    const std::vector<std::string> names = base::mapped<std::string>(
        materialsOf(inspected, shaderId),
        [&](const inspect::MaterialPlace& material) { return inspected.materialName(material); });
    return names.empty() ? "-" : base::firstOf(names, 3);
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
    return manifest.hitLobes.size() == static_cast<std::size_t>(std::ranges::count_if(
                                           manifest.features, &compiler::ManifestFeature::lobe))
               ? "all"
               : base::join(manifest.hitLobes);
}

std::vector<std::string> layerNames(const Package& package) {
    return base::mapped<std::string>(package.layers(), &package::PackageLayer::name);
}

std::string layersText(const Package& package) {
    return package.layers().empty() ? "none"
                                    : fmt::format("{}; {} bytes a pixel", base::join(layerNames(package)),
                                                  package::bytesOf(package.layers()));
}

base::Json layersToJson(const Package& package) {
    return listOf(package.layers(), [](const package::PackageLayer& layer) -> base::Json {
        const package::LayerInfo::FormatInfo& format = package::infoOf(layer.info->format);
        return {{"name", layer.name},
                {"channels", std::string(layer.info->channels)},
                {"format", std::string(format.qualifier)},
                {"bytes", format.bytes}};
    });
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
          {"diskLights", package.diskLights()},
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
    const auto entryToJson = [&](const inspect::Disassembly& entry) {
        base::Json module = describe(inspected, *entry.module);
        module["text"] = entry.text;
        return module;
    };
    return {{"package", inspected.folder}, {"disassembly", listOf(list, entryToJson)}};
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

// --- glint inspect --pipelines: what the compiler of the device makes of a package ---

using inspect::FactInfo;
using inspect::ReportedPipeline;

constexpr const char* kSortByName = "name";

std::vector<std::string> sortWords() {
    std::vector<std::string> words{kSortByName};
    for (const FactInfo& info : inspect::factTable()) {
        words.emplace_back(info.name);
    }
    return words;
}

// Returns null for the name.
const FactInfo* factNamed(const std::string& name) {
    const auto found = std::ranges::find(inspect::factTable(), name, &FactInfo::name);
    return found == inspect::factTable().end() ? nullptr : &*found;
}

// Returns one value if both are the same, "before → after" otherwise.
std::string cellOf(const FactInfo& info, const ReportedPipeline& pipeline, const ReportedPipeline* before) {
    const std::string text = factText(info, pipeline.facts);
    const std::string other = before == nullptr ? text : factText(info, before->facts);
    return text == other ? text : other + " → " + text;
}

std::vector<std::string> rowOf(const ReportedPipeline& pipeline, const ReportedPipeline* before,
                               bool traces) {
    std::vector<std::string> row{pipeline.name};
    if (traces) {
        row.push_back(pipeline.tracer.empty() ? "-" : pipeline.tracer);
    }
    row.push_back(pipeline.subgroupSize > 0 ? std::to_string(pipeline.subgroupSize) : "-");
    if (!pipeline.failure.empty()) {
        row.push_back("failed");
        return row;
    }
    for (const FactInfo& info : inspect::factTable()) {
        row.push_back(cellOf(info, pipeline, before));
    }
    return row;
}

// Whether pipelines differ in their tracer.
bool haveTracers(const inspect::PipelineReport& report) {
    std::set<std::string> tracers;
    for (const ReportedPipeline& pipeline : report.pipelines) {
        tracers.insert(pipeline.tracer);
    }
    tracers.erase("");
    return tracers.size() > 1;
}

// Returns the table, with the facts of `other` beside those of `report` unless it is null.
std::string pipelineTable(const inspect::PipelineReport& report, const inspect::PipelineReport* other,
                          Detail detail) {
    const bool traces = haveTracers(report);
    Rows rows{{"pipeline"}};
    if (traces) {
        rows.front().emplace_back("tracer");
    }
    rows.front().emplace_back("subgroup");
    for (const FactInfo& info : inspect::factTable()) {
        rows.front().emplace_back(info.column);
    }
    for (const ReportedPipeline& pipeline : report.pipelines) {
        rows.push_back(
            rowOf(pipeline, other == nullptr ? nullptr : findCounterpart(*other, pipeline), traces));
    }
    return formatTable(rows, detail);
}

std::string toText(const inspect::PipelineReport& report, const inspect::PipelineReport* other,
                   const std::string& sort, Detail detail) {
    Rows fields{{"package", report.package},
                {"device",
                 fmt::format("{} ({}), subgroups of {}", report.device, report.driver, report.subgroupSize)},
                {"pipelines", fmt::format("{}, by {}", report.pipelines.size(), sort)}};
    if (other != nullptr) {
        fields.push_back(
            {"before →", fmt::format("{} on {} ({})", other->package, other->device, other->driver)});
    }
    std::string text = formatFields(fields) + "\n" + pipelineTable(report, other, detail);
    if (other != nullptr) {
        std::vector<std::string> gone;
        for (const ReportedPipeline& pipeline : other->pipelines) {
            if (inspect::findCounterpart(report, pipeline) == nullptr) {
                gone.push_back(pipeline.name);
            }
        }
        text += gone.empty() ? "" : "\n" + formatFields({{"only before", base::join(gone)}}, detail);
    }
    return text;
}

struct PackagePipelineArguments {
    bool enabled = false;
    std::string device;         // part of its name; empty: the first suitable one
    std::string sort = "cost";  // name of a fact, or "name"
    std::string compare;        // a report or a package; empty: nothing
    std::string budget;         // a file; empty: none
    std::int64_t threads = 0;
    bool validate = false;
};

Result<inspect::PipelineReport> make(const Console& console, const Package& package,
                                     const std::string& folder, const PackagePipelineArguments& arguments) {
    console.progress("making the pipelines of " + folder);
    GLINT_TRY(const auto manifest, inspect::readManifest(folder));
    HeadlessOptions options;
    options.deviceName = arguments.device;
    options.validation = arguments.validate ? Validation::On : Validation::Off;
    options.pipelineStatistics = true;
    inspect::requirePackage(package, options);
    GLINT_TRY(auto context, Context::createHeadless(options));
    Result<inspect::PipelineReport> report = inspect::reportPipelines(
        *context, package, manifest, folder, static_cast<std::uint32_t>(arguments.threads));
    if (Status valid = measure::checkValidation(console, *context); report && !valid) {
        return valid.error();
    }
    return report;
}

// Makes or reads the report to compare with.
Result<inspect::PipelineReport> obtainOther(const Console& console,
                                            const PackagePipelineArguments& arguments) {
    if (!std::filesystem::is_directory(arguments.compare)) {
        return inspect::readPipelineReport(arguments.compare);
    }
    GLINT_TRY(const auto package, Package::load(arguments.compare));
    return make(console, package, arguments.compare, arguments);
}

// Reports pipelines that could not be made, statistics that are missing, and budgets that are exceeded.
// Returns whether all is well.
bool judge(const Console& console, const inspect::PipelineReport& report,
           const std::optional<inspect::PipelineBudget>& budget) {
    bool good = true;
    const auto tell = [&](const Diagnostic& diagnostic) {
        console.report(diagnostic);
        good = good && diagnostic.severity != Severity::Error;
    };
    for (const ReportedPipeline& pipeline : report.pipelines) {
        if (!pipeline.failure.empty()) {
            tell(makeError(
                "pipeline-failed", report.package,
                fmt::format("{} could not be made on {}: {}", pipeline.name, report.device, pipeline.failure),
                "update the driver, or report the module to its makers"));
        }
    }
    if (!report.hasStatistics) {
        tell(Diagnostic{Severity::Note, "pipeline-statistics", report.device,
                        "has no VK_KHR_pipeline_executable_properties: there are no statistics",
                        "use another device"});
    }
    if (budget) {
        std::ranges::for_each(overBudget(report, *budget), tell);
    }
    return good;
}

void addPipelineReportOptions(CLI::App& command, PackagePipelineArguments& arguments) {
    const OptionGroup group(command, "Pipelines");
    CLI::Option* const pipelines =
        &addFlag(command, "--pipelines", arguments.enabled,
                 "make every pipeline of the package on the device, and show what its driver says of them");
    const auto ofPipelines = [&](CLI::Option& option) { option.needs(pipelines); };
    addDeviceChoice(command, arguments.device, arguments.validate);
    ofPipelines(*command.get_option("--device"));
    ofPipelines(*command.get_option("--validate"));
    ofPipelines(addChoice(command, "--sort", arguments.sort, sortWords(), "what the list is sorted by"));
    ofPipelines(
        addText(command, "--compare", arguments.compare, "FILE|DIR",
                "show what was before beside it: a report of --json, or another package (default: nothing)"));
    ofPipelines(addText(command, "--budget", arguments.budget, "FILE",
                        "report an error where a pipeline exceeds a limit of the file (default: no limits)"));
    ofPipelines(addInteger(command, "--pipeline-threads", arguments.threads, 0, 1024,
                           "threads that make pipelines; 0: as many as the machine runs at once"));
}

// Makes the pipelines of the package in `folder` and prints the report. Returns the exit code.
Result<int> showPipelines(const Console& console, const Package& package, const std::string& folder,
                          const PackagePipelineArguments& arguments) {
    std::optional<inspect::PipelineBudget> budget;
    if (!arguments.budget.empty()) {
        GLINT_TRY(budget, inspect::readPipelineBudget(arguments.budget));
    }
    std::optional<inspect::PipelineReport> other;
    if (!arguments.compare.empty()) {
        GLINT_TRY(other, obtainOther(console, arguments));
    }
    GLINT_TRY(auto report, make(console, package, folder, arguments));
    sortPipelines(report, factNamed(arguments.sort));
    const bool good = judge(console, report, budget);
    const auto toJson = [&] {
        base::Json json = base::jsonOf(report);
        json["compared"] = other ? base::jsonOf(*other) : base::Json(nullptr);
        for (base::Json& pipeline : other ? json["compared"]["pipelines"] : json["compared"]) {
            pipeline.erase("executables");
        }
        return json;
    };
    answer(console, toJson,
           [&](Detail detail) { return toText(report, other ? &*other : nullptr, arguments.sort, detail); });
    return good ? kExitDone : kExitFailed;
}

// --- The command ---

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
        answer(
            console, [&] { return toJson(inspected, list); },
            [&](Detail) { return toText(inspected, list); });
    } else {
        answer(
            console, [&] { return toJson(inspected); },
            [&](Detail detail) { return toText(inspected, detail); });
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
