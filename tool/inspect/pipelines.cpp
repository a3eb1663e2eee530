#include "inspect/pipelines.h"

#include "base/text.h"
#include "emit/compile.h"
#include "inspect/gpu_tables.h"
#include "inspect/package.h"
#include "resolve/resolve.h"

#include <glint/package_modules.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <initializer_list>
#include <map>
#include <numeric>
#include <utility>

namespace glint::inspect {

namespace {

constexpr FactInfo kFacts[] = {
    {"registers", "registers", &PipelineFacts::registers, false},
    {"spills", "spills", &PipelineFacts::spills, false},
    {"scratchBytes", "scratch", &PipelineFacts::scratchBytes, false},
    {"codeBytes", "code", &PipelineFacts::codeBytes, false},
    {"occupancy", "occupancy", &PipelineFacts::occupancy, true},
    {"cost", "cost", &PipelineFacts::cost, false},
};

// The statistics of an executable by name.
class Statistics {
public:
    explicit Statistics(const PipelineExecutable& executable) : executable_(executable) {}

    std::optional<double> operator()(std::string_view name) const {
        const auto found = std::ranges::find(executable_.statistics, name, &PipelineStatistic::name);
        return found == executable_.statistics.end() ? std::nullopt : std::optional(number(*found));
    }
    // Returns the sum of the statistics whose names have one of these words, whatever their case.
    std::optional<double> withWord(std::initializer_list<std::string_view> words) const {
        std::optional<double> sum;
        for (const PipelineStatistic& statistic : executable_.statistics) {
            std::string name = statistic.name;
            std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
            const bool fits = std::ranges::any_of(
                words, [&](std::string_view word) { return name.find(word) != std::string::npos; });
            if (fits) {
                sum = sum.value_or(0.0) + number(statistic);
            }
        }
        return sum;
    }

private:
    static double number(const PipelineStatistic& statistic) {
        return std::visit([](auto value) { return static_cast<double>(value); }, statistic.value);
    }

    const PipelineExecutable& executable_;
};

std::optional<double> scaled(std::optional<double> value, double factor) {
    return value ? std::optional(*value * factor) : std::nullopt;
}

constexpr double kLanes = 64.0;  // the lanes of PipelineFacts::cost

double widthOf(const PipelineExecutable& executable) {
    return executable.subgroupSize > 0 ? executable.subgroupSize : kLanes;
}

// RADV (Mesa 25.0: src/amd/vulkan/radv_shader.c, src/amd/compiler/aco_statistics.cpp). "Subgroups per SIMD"
// counts a subgroup of 64 lanes twice. "Inverse Throughput" is that of 64 lanes, whatever the subgroup; or,
// if that is more, "Latency" over the subgroups in flight.
PipelineFacts radvFacts(const Statistics& named, double width) {
    constexpr double kMostSubgroups = 16.0;  // of a SIMD, from RDNA 2 on
    constexpr double kSmallestWidth = 32.0;
    PipelineFacts facts;
    facts.registers = named("VGPRs");
    facts.spills = named.withWord({"spilled"});
    facts.scratchBytes = scaled(named("Scratch size"), 1.0 / width);
    facts.codeBytes = named("Code size");
    const std::optional<double> subgroups = scaled(named("Subgroups per SIMD"), kSmallestWidth / width);
    facts.occupancy = scaled(subgroups, 1.0 / kMostSubgroups);
    facts.cost = named("Inverse Throughput");
    return facts;
}

// turnip (Mesa 25.0: src/freedreno/vulkan/tu_shader.cc, src/freedreno/ir3/ir3.c). A register has four
// components. An instruction takes a cycle; the other subgroups of a core hide the waits of one.
PipelineFacts turnipFacts(const Statistics& named, double width) {
    constexpr double kMostSubgroups = 16.0;  // of a core, Adreno 6xx and 7xx
    constexpr double kComponents = 4.0;
    constexpr double kInstructionBytes = 8.0;
    constexpr double kCodeWraps = 65536.0;  // turnip keeps the size, in words, in 16 bits
    constexpr double kWordBytes = 4.0;
    PipelineFacts facts;
    facts.registers = scaled(named("Registers used"), kComponents);
    const std::optional<double> stores = named("STP Count");
    const std::optional<double> loads = named("LDP Count");
    if (stores && loads) {
        facts.spills = *stores + *loads;
    }
    const std::optional<double> instructions = named("Instruction Count");
    facts.codeBytes = named("Code size");
    if (facts.codeBytes && instructions) {
        double words = *facts.codeBytes;
        while (words * kWordBytes + kInstructionBytes < *instructions * kWordBytes) {
            words += kCodeWraps;
        }
        facts.codeBytes = words * kWordBytes;
    }
    const std::optional<double> subgroups = named("Max Waves Per Core");
    facts.occupancy = scaled(subgroups, 1.0 / kMostSubgroups);
    const double stalls = named("Estimated cycles stalled on SS").value_or(0.0) +
                          named("Estimated cycles stalled on SY").value_or(0.0);
    if (instructions && subgroups.value_or(0.0) > 0.0) {
        facts.cost = (*instructions + stalls / *subgroups) * kLanes / width;
    }
    return facts;
}

// ANV (Mesa 25.0: src/intel/vulkan/anv_pipeline.c). A register holds 32 bytes for all lanes of a subgroup. A
// core always runs as many subgroups, so that narrow ones leave lanes unused.
PipelineFacts anvFacts(const Statistics& named, double width) {
    constexpr double kRegisterWords = 8.0;
    constexpr double kInstructionBytes = 16.0;  // before they are compacted
    constexpr double kWidest = 32.0;
    PipelineFacts facts;
    facts.registers = scaled(named("Max live registers"), kRegisterWords / width);
    facts.spills = named("Spill Count");
    facts.scratchBytes = scaled(named("Scratch Memory Size"), 1.0 / width);
    facts.codeBytes = scaled(named("Instruction Count"), kInstructionBytes);
    facts.occupancy = std::min(width / kWidest, 1.0);
    facts.cost = scaled(named("Cycle Count"), kLanes / width);
    return facts;
}

// Other drivers, such as NVIDIA's: finds statistics by words in their names.
PipelineFacts otherFacts(const Statistics& named) {
    PipelineFacts facts;
    facts.registers = named.withWord({"register", "vgpr"});
    facts.spills = named.withWord({"spill"});
    facts.scratchBytes = named.withWord({"local memory", "scratch"});
    facts.codeBytes = named.withWord({"binary size", "code size", "size of code"});
    return facts;
}

void merge(std::optional<double>& into, const std::optional<double>& value, auto&& combine) {
    if (value) {
        into = into ? combine(*into, *value) : *value;
    }
}

constexpr auto kLargest = [](double a, double b) { return std::max(a, b); };
constexpr auto kSmallest = [](double a, double b) { return std::min(a, b); };
constexpr auto kSum = [](double a, double b) { return a + b; };

}  // namespace

std::span<const FactInfo> factTable() {
    return kFacts;
}

PipelineFacts factsOf(const PipelineExecutable& executable) {
    const Statistics named(executable);
    if (named("Subgroups per SIMD")) {
        return radvFacts(named, widthOf(executable));
    }
    if (named("Max Waves Per Core")) {
        return turnipFacts(named, widthOf(executable));
    }
    if (named("Max live registers")) {
        return anvFacts(named, widthOf(executable));
    }
    return otherFacts(named);
}

PipelineFacts factsOf(std::span<const PipelineExecutable> executables) {
    PipelineFacts all;
    for (const PipelineExecutable& executable : executables) {
        const PipelineFacts facts = factsOf(executable);
        merge(all.registers, facts.registers, kLargest);
        merge(all.spills, facts.spills, kSum);
        merge(all.scratchBytes, facts.scratchBytes, kLargest);
        merge(all.codeBytes, facts.codeBytes, kSum);
        merge(all.occupancy, facts.occupancy, kSmallest);
        merge(all.cost, facts.cost, kLargest);
    }
    return all;
}

namespace {

ReportedModule describe(const InspectedPackage& inspected, const InspectedModule& module) {
    ReportedModule reported;
    reported.role = package::roleName(module.entry->role);
    if (package::findRole(module.entry->role)->repeated == package::Repeated::ByCase) {
        reported.shaderId = module.entry->index;
        const auto share = inspected.manifest.shares.find(module.entry->index);
        reported.share = share != inspected.manifest.shares.end() ? share->second : 0.0;
    }
    reported.file = inspected.file(module);
    reported.instructions = module.statistics.instructions;
    reported.textureFetches = module.statistics.textureFetches;
    return reported;
}

std::vector<ReportedModule> modulesOf(const InspectedPackage& inspected, const PackagePipeline& pipeline) {
    std::vector<ReportedModule> modules;
    for (const package::ModuleKey& key : pipeline.modules) {
        const auto found = std::ranges::find(inspected.modules, key, &InspectedModule::key);
        if (found != inspected.modules.end()) {
            modules.push_back(describe(inspected, *found));
        }
    }
    return modules;
}

ReportedPipeline reportOf(const InspectedPackage& inspected, PackagePipeline pipeline) {
    ReportedPipeline reported;
    reported.name = pipeline.statistics.name;
    for (const package::Tracer tracer : package::kTracers) {
        if (pipeline.modules.front().tracer == tracer) {
            reported.tracer = nameOf(tracer);
        }
    }
    reported.strategies = compiler::strategyNames(pipeline.strategies);
    reported.modules = modulesOf(inspected, pipeline);
    reported.creationMs = pipeline.statistics.creationMs;
    reported.failure = pipeline.failure ? pipeline.failure->message : std::string();
    reported.executables = std::move(pipeline.statistics.executables);
    reported.facts = factsOf(reported.executables);
    for (const PipelineExecutable& executable : reported.executables) {
        reported.subgroupSize = std::max(reported.subgroupSize, executable.subgroupSize);
    }
    return reported;
}

}  // namespace

void requirePackage(const Package& package, HeadlessOptions& options) {
    options.positionFetch = package.positionFetch();
    options.shaderClock = (package::demandsOf(package.layers()) & package::kLayerClock) != 0;
    options.shaderFloat16 = package.precision() == package::ShadingPrecision::Half;
}

Result<PipelineReport> reportPipelines(Context& context, const Package& package, const Manifest& manifest,
                                       const std::string& name, std::uint32_t threads) {
    GLINT_TRY(const auto inspected, inspectPackage(package, manifest, name));
    GLINT_TRY(auto pipelines, makePackagePipelines(context, package, threads));
    PipelineReport report;
    report.package = name;
    report.merge = manifest.merge;
    report.shadows = package::nameOf(package.shape().shadows);
    report.precision = package::bitsOf(package.precision());
    report.device = context.deviceName();
    report.driver = context.driverName();
    report.deviceType = context.deviceType() == VK_PHYSICAL_DEVICE_TYPE_CPU ? "cpu" : "gpu";
    report.subgroupSize = context.subgroupSize();
    report.hasStatistics = context.handles().pipelineStatistics;
    for (PackagePipeline& pipeline : pipelines) {
        report.pipelines.push_back(reportOf(inspected, std::move(pipeline)));
    }
    return report;
}

namespace {

// Returns the instructions of a pipeline's SPIR-V, with the weight of fetches. Modules with the same file
// count once.
double weightOf(const ReportedPipeline& pipeline) {
    std::map<std::string_view, double> weights;
    for (const ReportedModule& module : pipeline.modules) {
        weights[module.file] = compiler::weightOf({1.0, module.instructions, module.textureFetches});
    }
    double sum = 0.0;
    for (const auto& [file, weight] : weights) {
        sum += weight;
    }
    return sum;
}

double shareOf(const ReportedPipeline& pipeline) {
    double share = 0.0;
    for (const ReportedModule& module : pipeline.modules) {
        share += module.share;
    }
    return share;
}

compiler::ModuleCost summarize(const std::vector<const ReportedPipeline*>& pipelines) {
    compiler::ModuleCost all;
    all.role = pipelines.front()->modules.front().role;
    all.tracer = pipelines.front()->tracer;
    all.modules = static_cast<std::uint32_t>(pipelines.size());
    const auto sumShares = [](double sum, const ReportedPipeline* one) { return sum + shareOf(*one); };
    const double shares = std::accumulate(pipelines.begin(), pipelines.end(), 0.0, sumShares);
    for (const ReportedPipeline* const pipeline : pipelines) {
        const double part =
            shares > 0.0 ? shareOf(*pipeline) / shares : 1.0 / static_cast<double>(pipelines.size());
        const PipelineFacts& facts = pipeline->facts;
        all.cost += part * facts.cost.value_or(0.0);
        all.weight += part * weightOf(*pipeline);
        all.occupancy += part * facts.occupancy.value_or(0.0);
        all.leastOccupancy = std::min(all.leastOccupancy, facts.occupancy.value_or(1.0));
        all.registers = std::max(all.registers, facts.registers.value_or(0.0));
        all.spills += facts.spills.value_or(0.0);
        all.scratchBytes = std::max(all.scratchBytes, facts.scratchBytes.value_or(0.0));
        all.codeBytes += facts.codeBytes.value_or(0.0);
    }
    return all;
}

}  // namespace

compiler::PackageCosts summarize(const PipelineReport& report) {
    std::map<std::pair<std::string, std::string>, std::vector<const ReportedPipeline*>> byRole;
    for (const ReportedPipeline& pipeline : report.pipelines) {
        if (pipeline.failure.empty() && !pipeline.modules.empty()) {
            byRole[{pipeline.modules.front().role, pipeline.tracer}].push_back(&pipeline);
        }
    }
    compiler::PackageCosts costs{report.package, report.merge, report.shadows, report.precision, {}};
    for (const auto& [role, pipelines] : byRole) {
        costs.modules.push_back(summarize(pipelines));
    }
    return costs;
}

void sortPipelines(PipelineReport& report, const FactInfo* fact) {
    std::ranges::stable_sort(report.pipelines, {}, &ReportedPipeline::name);
    if (fact == nullptr) {
        return;
    }
    const double sign = fact->isLeast ? 1.0 : -1.0;
    std::ranges::stable_sort(report.pipelines, {}, [&](const ReportedPipeline& pipeline) {
        const std::optional<double>& value = pipeline.facts.*fact->member;
        return std::pair(!value, sign * value.value_or(0.0));
    });
}

namespace {

base::Json stagesToJson(VkShaderStageFlags stages) {
    constexpr std::pair<VkShaderStageFlagBits, const char*> kNames[] = {
        {VK_SHADER_STAGE_VERTEX_BIT, "vertex"},       {VK_SHADER_STAGE_FRAGMENT_BIT, "fragment"},
        {VK_SHADER_STAGE_COMPUTE_BIT, "compute"},     {VK_SHADER_STAGE_RAYGEN_BIT_KHR, "ray-generation"},
        {VK_SHADER_STAGE_ANY_HIT_BIT_KHR, "any-hit"}, {VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR, "closest-hit"},
        {VK_SHADER_STAGE_MISS_BIT_KHR, "miss"}};
    base::Json list = base::Json::array();
    for (const auto& [bit, name] : kNames) {
        if ((stages & bit) != 0) {
            list.push_back(name);
        }
    }
    return list;
}

// The names match the alternatives of PipelineStatistic::value.
constexpr std::array kFormats{"bool", "int64", "uint64", "float64"};
static_assert(kFormats.size() == std::variant_size_v<decltype(PipelineStatistic::value)>);

base::Json toJson(const PipelineExecutable& executable) {
    base::Json statistics = base::Json::array();
    for (const PipelineStatistic& statistic : executable.statistics) {
        statistics.push_back(
            {{"name", statistic.name},
             {"description", statistic.description},
             {"format", kFormats[statistic.value.index()]},
             {"value", std::visit([](auto value) { return base::Json(value); }, statistic.value)}});
    }
    return {{"name", executable.name},
            {"description", executable.description},
            {"stages", stagesToJson(executable.stages)},
            {"subgroupSize", executable.subgroupSize},
            {"statistics", std::move(statistics)}};
}

base::Json toJson(std::span<const PipelineExecutable> executables) {
    base::Json list = base::Json::array();
    for (const PipelineExecutable& executable : executables) {
        list.push_back(toJson(executable));
    }
    return list;
}

base::Json toJson(const ReportedPipeline& pipeline, bool withExecutables) {
    base::Json modules = base::Json::array();
    for (const ReportedModule& module : pipeline.modules) {
        modules.push_back({{"role", module.role},
                           {"shaderId", base::orNull(module.shaderId)},
                           {"file", module.file},
                           {"share", module.share},
                           {"instructions", module.instructions},
                           {"textureFetches", module.textureFetches}});
    }
    base::Json json{{"name", pipeline.name},
                    {"tracer", base::textOrNull(pipeline.tracer)},
                    {"strategies", pipeline.strategies},
                    {"modules", std::move(modules)},
                    {"subgroupSize", pipeline.subgroupSize},
                    {"creationMs", base::orNull(pipeline.creationMs)},
                    {"failure", base::textOrNull(pipeline.failure)},
                    {"facts", toJson(pipeline.facts)}};
    if (withExecutables) {
        json["executables"] = toJson(pipeline.executables);
    }
    return json;
}

}  // namespace

std::string textOf(const PipelineStatistic& statistic) {
    return std::visit([](auto value) { return fmt::format("{}", value); }, statistic.value);
}

base::Json toJson(const PipelineStatistics& pipeline) {
    return {{"name", pipeline.name},
            {"creationMs", base::orNull(pipeline.creationMs)},
            {"cacheHit", base::orNull(pipeline.cacheHit)},
            {"executables", toJson(pipeline.executables)}};
}

base::Json toJson(const PipelineFacts& facts) {
    base::Json json = base::Json::object();
    for (const FactInfo& info : kFacts) {
        json[std::string(info.name)] = base::orNull(facts.*info.member);
    }
    return json;
}

namespace {

// The numbers of a ModuleCost by their names in reports; tables have those that choices read.
constexpr std::pair<const char*, double compiler::ModuleCost::*> kModuleNumbers[] = {
    {"cost", &compiler::ModuleCost::cost},
    {"weight", &compiler::ModuleCost::weight},
    {"occupancy", &compiler::ModuleCost::occupancy},
    {"leastOccupancy", &compiler::ModuleCost::leastOccupancy},
    {"registers", &compiler::ModuleCost::registers},
    {"spills", &compiler::ModuleCost::spills},
    {"scratchBytes", &compiler::ModuleCost::scratchBytes},
    {"codeBytes", &compiler::ModuleCost::codeBytes}};

// The estimates are not accurate beyond four digits after the point.
double rounded(double value) {
    constexpr double kDigits = 1e4;
    return std::round(value * kDigits) / kDigits;
}

base::Json summaryToJson(const compiler::PackageCosts& costs) {
    base::Json list = base::Json::array();
    for (const compiler::ModuleCost& module : costs.modules) {
        base::Json entry{
            {"role", module.role}, {"tracer", base::textOrNull(module.tracer)}, {"modules", module.modules}};
        for (const auto& [name, member] : kModuleNumbers) {
            entry[name] = rounded(module.*member);
        }
        list.push_back(std::move(entry));
    }
    return list;
}

}  // namespace

base::Json toJson(const PipelineReport& report, bool withExecutables) {
    base::Json pipelines = base::Json::array();
    for (const ReportedPipeline& pipeline : report.pipelines) {
        pipelines.push_back(toJson(pipeline, withExecutables));
    }
    return {{"format", "glint-pipelines"},
            {"version", 1},
            {"package", report.package},
            {"merge", report.merge},
            {"shadows", report.shadows},
            {"precision", report.precision},
            {"device",
             {{"name", report.device},
              {"driver", report.driver},
              {"type", report.deviceType},
              {"subgroupSize", report.subgroupSize},
              {"statistics", report.hasStatistics}}},
            {"summary", summaryToJson(summarize(report))},
            {"pipelines", std::move(pipelines)}};
}

namespace {

constexpr std::uint64_t kMaxReportBytes = 1ULL << 28;
constexpr double kMostOfFact = 1e15;
constexpr std::uint64_t kMaxSubgroup = 1024;
constexpr std::uint64_t kMaxShaderId = 1ULL << 24;

std::string textOrEmpty(base::JsonReader& reader, const base::Json& object, const std::string& place,
                        const char* name) {
    const base::Json* const value = reader.member(object, place, name);
    return value == nullptr || value->is_null() ? std::string() : reader.text(object, place, name);
}

PipelineFacts readFacts(base::JsonReader& reader, const base::Json& json, const std::string& place) {
    PipelineFacts facts;
    for (const FactInfo& info : kFacts) {
        const std::string name(info.name);
        const base::Json* const value = reader.member(json, place, name.c_str());
        if (value != nullptr && !value->is_null()) {
            facts.*info.member = reader.number(json, place, name.c_str(), 0.0, kMostOfFact);
        }
    }
    return facts;
}

ReportedModule readModule(base::JsonReader& reader, const base::Json& json, const std::string& place) {
    ReportedModule module;
    module.role = reader.text(json, place, "role");
    const base::Json* const shaderId = reader.member(json, place, "shaderId");
    if (shaderId != nullptr && !shaderId->is_null()) {
        module.shaderId = static_cast<std::uint32_t>(reader.count(json, place, "shaderId", kMaxShaderId));
    }
    module.file = reader.text(json, place, "file");
    module.share = reader.number(json, place, "share", 0.0, 1.0);
    module.instructions = reader.number(json, place, "instructions", 0.0, kMostOfFact);
    module.textureFetches = reader.number(json, place, "textureFetches", 0.0, kMostOfFact);
    return module;
}

ReportedPipeline readPipeline(base::JsonReader& reader, const base::Json& json, const std::string& place) {
    ReportedPipeline pipeline;
    pipeline.name = reader.text(json, place, "name");
    pipeline.tracer = textOrEmpty(reader, json, place, "tracer");
    pipeline.strategies = reader.texts(json, place, "strategies");
    reader.each(json, place, "modules", [&](const base::Json& module, const std::string& there) {
        pipeline.modules.push_back(readModule(reader, module, there));
    });
    pipeline.subgroupSize =
        static_cast<std::uint32_t>(reader.count(json, place, "subgroupSize", kMaxSubgroup));
    pipeline.failure = textOrEmpty(reader, json, place, "failure");
    const base::Json* const facts = reader.member(json, place, "facts");
    if (facts != nullptr) {
        pipeline.facts = readFacts(reader, *facts, place + "/facts");
    }
    return pipeline;
}

base::JsonReader reportReader(const std::filesystem::path& file) {
    return {file, "pipeline-report", "give a file that glint inspect --pipelines --json wrote"};
}

}  // namespace

PipelineReport readPipelineReport(base::JsonReader& reader, const base::Json& json,
                                  const std::string& place) {
    PipelineReport report;
    if (reader.text(json, place, "format") != "glint-pipelines" && reader.ok()) {
        reader.fail(place + "/format", "is not \"glint-pipelines\"");
    }
    if (reader.count(json, place, "version", kMaxShaderId) != 1 && reader.ok()) {
        reader.fail(place + "/version", "is not 1, which this glint reads");
    }
    report.package = reader.text(json, place, "package");
    report.merge = reader.text(json, place, "merge");
    report.shadows = reader.text(json, place, "shadows");
    report.precision = static_cast<std::uint32_t>(reader.count(json, place, "precision", 32));
    const base::Json* const device = reader.member(json, place, "device");
    if (device != nullptr) {
        const std::string there = place + "/device";
        report.device = reader.text(*device, there, "name");
        report.driver = reader.text(*device, there, "driver");
        report.deviceType = reader.text(*device, there, "type");
        report.subgroupSize =
            static_cast<std::uint32_t>(reader.count(*device, there, "subgroupSize", kMaxSubgroup));
        report.hasStatistics = reader.flag(*device, there, "statistics");
    }
    reader.each(json, place, "pipelines", [&](const base::Json& pipeline, const std::string& there) {
        report.pipelines.push_back(readPipeline(reader, pipeline, there));
    });
    return report;
}

Result<PipelineReport> readPipelineReport(const std::filesystem::path& file) {
    base::JsonReader reader = reportReader(file);
    GLINT_TRY(const auto json, reader.read(kMaxReportBytes));
    PipelineReport report = readPipelineReport(reader, json, "");
    return reader.ok() ? Result<PipelineReport>(std::move(report)) : Result<PipelineReport>(reader.error());
}

namespace {

compiler::PackageCosts readCosts(base::JsonReader& reader, const base::Json& json, const std::string& place) {
    compiler::PackageCosts costs;
    costs.package = reader.text(json, place, "package");
    costs.merge = reader.text(json, place, "merge");
    costs.shadows = reader.text(json, place, "shadows");
    costs.precision = static_cast<std::uint32_t>(reader.count(json, place, "precision", 32));
    if (reader.ok() && !valueNamed<package::ShadowPlacement>(costs.shadows)) {
        reader.fail(place + "/shadows", "is neither \"inline\" nor \"deferred\"");
    }
    if (reader.ok() && costs.precision != 16 && costs.precision != 32) {
        reader.fail(place + "/precision", "is neither 16 nor 32");
    }
    reader.each(json, place, "summary", [&](const base::Json& entry, const std::string& there) {
        compiler::ModuleCost module;
        module.role = reader.text(entry, there, "role");
        module.tracer = textOrEmpty(reader, entry, there, "tracer");
        module.modules = static_cast<std::uint32_t>(reader.count(entry, there, "modules", kMaxShaderId));
        module.cost = reader.number(entry, there, "cost", 0.0, kMostOfFact);
        module.weight = reader.number(entry, there, "weight", 0.0, kMostOfFact);
        module.occupancy = reader.number(entry, there, "occupancy", 0.0, 1.0);
        module.spills = reader.number(entry, there, "spills", 0.0, kMostOfFact);
        module.scratchBytes = reader.number(entry, there, "scratchBytes", 0.0, kMostOfFact);
        costs.modules.push_back(std::move(module));
    });
    return costs;
}

compiler::GpuCosts readGpu(base::JsonReader& reader, const base::Json& json) {
    compiler::GpuCosts gpu;
    if (reader.text(json, "", "format") != "glint-gpu" && reader.ok()) {
        reader.fail("/format", "is not \"glint-gpu\"");
    }
    if (reader.count(json, "", "version", kMaxShaderId) != 1 && reader.ok()) {
        reader.fail("/version", "is not 1, which this glint reads");
    }
    gpu.name = reader.text(json, "", "name");
    gpu.device = reader.text(json, "", "device");
    gpu.driver = reader.text(json, "", "driver");
    gpu.subgroupSize = reader.number(json, "", "subgroupSize", 1.0, static_cast<double>(kMaxSubgroup));
    reader.each(json, "", "packages", [&](const base::Json& entry, const std::string& place) {
        gpu.packages.push_back(readCosts(reader, entry, place));
    });
    if (reader.ok() && gpu.packages.empty()) {
        reader.fail("/packages", "is empty");
    }
    return gpu;
}

}  // namespace

compiler::GpuCosts gpuOf(std::string name, std::span<const PipelineReport> reports) {
    compiler::GpuCosts gpu;
    gpu.name = std::move(name);
    gpu.device = reports.front().device;
    gpu.driver = reports.front().driver;
    gpu.subgroupSize = reports.front().subgroupSize;
    for (const PipelineReport& report : reports) {
        gpu.packages.push_back(summarize(report));
    }
    return gpu;
}

std::vector<std::string> builtInGpus() {
    std::vector<std::string> names;
    for (const base::BuiltinFile& file : gpuTables()) {
        names.emplace_back(file.name.substr(0, file.name.rfind('.')));
    }
    return names;
}

Result<compiler::GpuCosts> readGpuCosts(const std::string& nameOrFile) {
    base::JsonReader reader(
        nameOrFile, "gpu-table",
        "give a table that scripts/gpu_table.py wrote, or one of: " + base::join(builtInGpus()));
    const auto read = [&reader](const base::Json& json) {
        compiler::GpuCosts gpu = readGpu(reader, json);
        return reader.ok() ? Result<compiler::GpuCosts>(std::move(gpu))
                           : Result<compiler::GpuCosts>(reader.error());
    };
    for (const base::BuiltinFile& file : gpuTables()) {
        if (file.name == nameOrFile + ".json") {
            return read(base::Json::parse(file.text));
        }
    }
    constexpr std::uint64_t kMaxTableBytes = 1ULL << 24;
    const std::vector<std::string> names = builtInGpus();
    if (std::error_code error; !std::filesystem::exists(nameOrFile, error)) {
        return makeError("gpu-unknown", nameOrFile,
                         fmt::format("is neither a file nor a GPU that Glint has a table of{}",
                                     base::suggestion(nameOrFile, names)),
                         "the GPUs are: " + base::join(names));
    }
    GLINT_TRY(const auto json, reader.read(kMaxTableBytes));
    return read(json);
}

const ReportedPipeline* findCounterpart(const PipelineReport& report, const ReportedPipeline& pipeline) {
    const ReportedPipeline* named = nullptr;
    std::size_t count = 0;
    for (const ReportedPipeline& other : report.pipelines) {
        if (other.name == pipeline.name) {
            if (other.tracer == pipeline.tracer) {
                return &other;
            }
            named = &other;
            ++count;
        }
    }
    return count == 1 ? named : nullptr;
}

namespace {

bool fitsPattern(std::string_view text, std::string_view pattern) {
    const std::size_t star = pattern.find('*');
    if (star == std::string_view::npos) {
        return text == pattern;
    }
    const std::string_view head = pattern.substr(0, star);
    if (!text.starts_with(head)) {
        return false;
    }
    const std::string_view rest = pattern.substr(star + 1);
    for (std::size_t at = head.size(); at <= text.size(); ++at) {
        if (fitsPattern(text.substr(at), rest)) {
            return true;
        }
    }
    return false;
}

PipelineBudget::Rule readRule(base::JsonReader& reader, const base::Json& json, const std::string& place) {
    PipelineBudget::Rule rule;
    rule.pipelines = reader.text(json, place, "pipelines");
    for (const auto& item : json.items()) {
        const std::string& name = item.key();
        const std::string pointer = place + "/" + name;
        const auto* const fact = std::ranges::find(kFacts, name, &FactInfo::name);
        if (fact != std::end(kFacts)) {
            rule.limits.*fact->member = reader.number(json, place, name.c_str(), 0.0, kMostOfFact);
        } else if (name == "device") {
            rule.device = reader.text(json, place, "device");
        } else if (name != "pipelines" && name != "reason") {
            reader.fail(pointer, "is no member of a budget");
        }
    }
    return rule;
}

bool isFor(const PipelineBudget::Rule& rule, const PipelineReport& report) {
    return report.device.find(rule.device) != std::string::npos;
}

// Returns "name (file.spv)".
std::string titleOf(const ReportedPipeline& pipeline) {
    return pipeline.modules.empty() ? pipeline.name
                                    : fmt::format("{} ({})", pipeline.name, pipeline.modules.front().file);
}

Diagnostic exceeded(const PipelineReport& report, const PipelineBudget& budget,
                    const ReportedPipeline& pipeline, const FactInfo& fact, double limit) {
    const std::optional<double>& value = pipeline.facts.*fact.member;
    const std::string what =
        value ? fmt::format("{} is {}, and the budget is {} {:g}", fact.name, fmt::format("{:g}", *value),
                            fact.isLeast ? "at least" : "at most", limit)
              : fmt::format("the driver reports no {}, which has a budget of {:g}", fact.name, limit);
    return makeError("pipeline-budget", report.package,
                     fmt::format("{} on {}: {}", titleOf(pipeline), report.device, what),
                     fmt::format("make the module smaller, or change the rule in {}", budget.file));
}

}  // namespace

Result<PipelineBudget> readPipelineBudget(const std::filesystem::path& file) {
    base::JsonReader reader(file, "pipeline-budget-file",
                            "docs/cli.md, \"Budgets of pipelines\", describes the file");
    constexpr std::uint64_t kMaxBudgetBytes = 1ULL << 24;
    GLINT_TRY(const auto json, reader.read(kMaxBudgetBytes));
    PipelineBudget budget;
    budget.file = file.string();
    if (reader.text(json, "", "format") != "glint-pipeline-budget" && reader.ok()) {
        reader.fail("/format", "is not \"glint-pipeline-budget\"");
    }
    reader.each(json, "", "budgets", [&](const base::Json& rule, const std::string& place) {
        budget.rules.push_back(readRule(reader, rule, place));
    });
    if (reader.ok() && budget.rules.empty()) {
        reader.fail("/budgets", "is empty");
    }
    return reader.ok() ? Result<PipelineBudget>(std::move(budget)) : Result<PipelineBudget>(reader.error());
}

std::vector<Diagnostic> overBudget(const PipelineReport& report, const PipelineBudget& budget) {
    std::vector<Diagnostic> found;
    // Rules for other devices count as used, unless all are for others.
    std::vector<bool> used;
    for (const PipelineBudget::Rule& rule : budget.rules) {
        used.push_back(!isFor(rule, report));
    }
    if (std::ranges::count(used, true) == std::ssize(used)) {
        found.push_back(makeWarning("pipeline-budget-unused", budget.file,
                                    fmt::format("has no rule for {}", report.device),
                                    "add rules for the device, or use another one"));
    }
    for (const ReportedPipeline& pipeline : report.pipelines) {
        if (!pipeline.failure.empty()) {
            continue;  // a failed pipeline is an error by itself
        }
        PipelineFacts limits;
        for (std::size_t i = 0; i < budget.rules.size(); ++i) {
            const PipelineBudget::Rule& rule = budget.rules[i];
            if (!isFor(rule, report) || !fitsPattern(pipeline.name, rule.pipelines)) {
                continue;
            }
            used[i] = true;
            for (const FactInfo& fact : kFacts) {
                if (!(limits.*fact.member)) {
                    limits.*fact.member = rule.limits.*fact.member;
                }
            }
        }
        for (const FactInfo& fact : kFacts) {
            const std::optional<double>& limit = limits.*fact.member;
            const std::optional<double>& value = pipeline.facts.*fact.member;
            if (limit && (!value || (fact.isLeast ? *value < *limit : *value > *limit))) {
                found.push_back(exceeded(report, budget, pipeline, fact, *limit));
            }
        }
    }
    for (std::size_t i = 0; i < budget.rules.size(); ++i) {
        if (!used[i]) {
            found.push_back(
                makeWarning("pipeline-budget-unused", fmt::format("{}#/budgets/{}", budget.file, i),
                            fmt::format("fits no pipeline of {} on {}", report.package, report.device),
                            "name pipelines as glint inspect --pipelines lists them"));
        }
    }
    return found;
}

}  // namespace glint::inspect
