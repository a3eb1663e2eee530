#include "inspect/pipelines.h"

#include "base/fields.h"
#include "base/lists.h"
#include "base/text.h"
#include "emit/compile.h"
#include "resolve/resolve.h"

#include <glint/internal/package_modules.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <initializer_list>
#include <map>
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
    explicit Statistics(const Renderer::PipelineStatistics::Executable& executable)
        : executable_(executable) {}

    std::optional<double> operator()(std::string_view name) const {
        const auto found =
            std::ranges::find(executable_.statistics, name, &Renderer::PipelineStatistics::Statistic::name);
        return found == executable_.statistics.end() ? std::nullopt : std::optional(number(*found));
    }
    // Returns the sum of the statistics whose names have one of these words, whatever their case.
    std::optional<double> withWord(std::initializer_list<std::string_view> words) const {
        std::optional<double> sum;
        for (const Renderer::PipelineStatistics::Statistic& statistic : executable_.statistics) {
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
    static double number(const Renderer::PipelineStatistics::Statistic& statistic) {
        return std::visit([](auto value) { return static_cast<double>(value); }, statistic.value);
    }

    const Renderer::PipelineStatistics::Executable& executable_;
};

std::optional<double> scaled(std::optional<double> value, double factor) {
    return value ? std::optional(*value * factor) : std::nullopt;
}

constexpr double kLanes = 64.0;  // the lanes of PipelineFacts::cost

double widthOf(const Renderer::PipelineStatistics::Executable& executable) {
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

PipelineFacts factsOf(const Renderer::PipelineStatistics::Executable& executable) {
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

PipelineFacts factsOf(std::span<const Renderer::PipelineStatistics::Executable> executables) {
    PipelineFacts all;
    for (const Renderer::PipelineStatistics::Executable& executable : executables) {
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
    for (const Renderer::PipelineStatistics::Executable& executable : reported.executables) {
        reported.subgroupSize = std::max(reported.subgroupSize, executable.subgroupSize);
    }
    return reported;
}

}  // namespace

void requirePackage(const Package& package, HeadlessOptions& options) {
    options.positionFetch = package.positionFetch();
    options.shaderClock = (package::demandsOf(package.layers()) & package::LayerInfo::kClock) != 0;
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
    return base::sumOf<double>(weights, [](const auto& file) { return file.second; });
}

double shareOf(const ReportedPipeline& pipeline) {
    return base::sumOf<double>(pipeline.modules, &ReportedModule::share);
}

compiler::ModuleCost summarize(const std::vector<const ReportedPipeline*>& pipelines) {
    compiler::ModuleCost all;
    all.role = pipelines.front()->modules.front().role;
    all.tracer = pipelines.front()->tracer;
    all.modules = static_cast<std::uint32_t>(pipelines.size());
    const auto shares =
        base::sumOf<double>(pipelines, [](const ReportedPipeline* one) { return shareOf(*one); });
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

// The names match the alternatives of Renderer::PipelineStatistics::Statistic::value.
constexpr std::array<std::string_view, 4> kFormats{"bool", "int64", "uint64", "float64"};
static_assert(kFormats.size() ==
              std::variant_size_v<decltype(Renderer::PipelineStatistics::Statistic::value)>);

std::vector<std::string_view> stagesOf(const Renderer::PipelineStatistics::Executable& executable) {
    constexpr std::pair<VkShaderStageFlagBits, const char*> kNames[] = {
        {VK_SHADER_STAGE_VERTEX_BIT, "vertex"},       {VK_SHADER_STAGE_FRAGMENT_BIT, "fragment"},
        {VK_SHADER_STAGE_COMPUTE_BIT, "compute"},     {VK_SHADER_STAGE_RAYGEN_BIT_KHR, "ray-generation"},
        {VK_SHADER_STAGE_ANY_HIT_BIT_KHR, "any-hit"}, {VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR, "closest-hit"},
        {VK_SHADER_STAGE_MISS_BIT_KHR, "miss"}};
    std::vector<std::string_view> stages;
    for (const auto& [bit, name] : kNames) {
        if ((executable.stages & bit) != 0) {
            stages.emplace_back(name);
        }
    }
    return stages;
}

}  // namespace

std::string textOf(const Renderer::PipelineStatistics::Statistic& statistic) {
    return std::visit([](auto value) { return fmt::format("{}", value); }, statistic.value);
}

}  // namespace glint::inspect

// The fields of the runtime's types stand in its namespace, where they are found.
namespace glint {

using base::field;
using base::output;

static base::Fields fieldsOf(const Renderer::PipelineStatistics::Statistic*) {
    using T = Renderer::PipelineStatistics::Statistic;
    return {output<&T::name>("name", "Name that the driver gives."),
            output<&T::description>("description", "Description that the driver gives."),
            output("format", "Format of the value.",
                   [](const T& statistic) { return inspect::kFormats[statistic.value.index()]; },
                   {.names = {inspect::kFormats.begin(), inspect::kFormats.end()}}),
            output<&T::value>("value", "The value, in this format.")};
}

static base::Fields fieldsOf(const Renderer::PipelineStatistics::Executable*) {
    using T = Renderer::PipelineStatistics::Executable;
    return {output<&T::name>("name", "Name that the driver gives."),
            output<&T::description>("description", "Description that the driver gives."),
            output<inspect::stagesOf>("stages", "Stages of the pipeline."),
            output<&T::subgroupSize>("subgroupSize", "Size of a subgroup; 0 if it varies or there is none."),
            output<&T::statistics>("statistics", "The driver's statistics, under its names.")};
}

base::Fields fieldsOf(const Renderer::PipelineStatistics*) {
    using T = Renderer::PipelineStatistics;
    return {output<&T::name>("name", "The role of its module, and its case, effect or ordering."),
            output<&T::creationMs>("creationMs", "Time by the driver's clock; null if it does not say."),
            output<&T::cacheHit>("cacheHit", "Whether it was cached; null if the driver does not say."),
            output<&T::executables>("executables", "The parts of its code on the device.")};
}

}  // namespace glint

namespace glint::inspect {

namespace {

constexpr double kMostOfFact = 1e15;
constexpr double kMaxSubgroup = 1024;
constexpr double kMaxShaderId = 1U << 24U;

// The estimates are not accurate beyond four digits after the point.
double rounded(double value) {
    constexpr double kDigits = 1e4;
    return std::round(value * kDigits) / kDigits;
}

std::vector<compiler::ModuleCost> summaryOf(const PipelineReport& report) {
    std::vector<compiler::ModuleCost> modules = summarize(report).modules;
    using Module = compiler::ModuleCost;
    for (Module& module : modules) {
        for (double Module::*member :
             {&Module::cost, &Module::weight, &Module::occupancy, &Module::leastOccupancy, &Module::registers,
              &Module::spills, &Module::scratchBytes, &Module::codeBytes}) {
            module.*member = rounded(module.*member);
        }
    }
    return modules;
}

}  // namespace

static base::Fields fieldsOf(const ReportedModule*) {
    using T = ReportedModule;
    return {field<&T::role>("role", "Its role."),
            field<&T::shaderId>("shaderId", "The shader, for the module of a case.", {.most = kMaxShaderId}),
            field<&T::file>("file", "File relative to the package's folder."),
            field<&T::share>("share", "Share of all hits.", {.least = 0, .most = 1}),
            field<&T::instructions>("instructions", "SPIR-V instructions within functions.",
                                    {.least = 0, .most = kMostOfFact}),
            field<&T::textureFetches>("textureFetches", "SPIR-V instructions that read textures.",
                                      {.least = 0, .most = kMostOfFact})};
}

static base::Fields fieldsOf(const PipelineFacts*) {
    using T = PipelineFacts;
    const base::FieldTraits any{.least = 0, .most = kMostOfFact};
    return {field<&T::registers>("registers", "32-bit registers of a lane, without uniform ones.", any),
            field<&T::spills>("spills", "Registers that do not fit.", any),
            field<&T::scratchBytes>("scratchBytes", "Memory of a lane for spills, arrays and stacks.", any),
            field<&T::codeBytes>("codeBytes", "Machine code.", any),
            field<&T::occupancy>("occupancy", "Share of the subgroups that fit; on Intel, of the lanes.",
                                 {.least = 0, .most = 1}),
            field<&T::cost>("cost", "Estimated cycles of a processor for 64 lanes.", any)};
}

static base::Fields fieldsOf(const ReportedPipeline*) {
    using T = ReportedPipeline;
    return {
        field<&T::name>("name", "The role of its module, and its case, effect or ordering."),
        field<&T::tracer>("tracer", "Its tracer; null if it traces nothing.", {.orNull = true}),
        field<&T::strategies>("strategies", "Strategies that it is made for."),
        field<&T::modules>("modules", "The modules that it was made for, which have the same code."),
        field<&T::subgroupSize>("subgroupSize", "The largest of its code; 0 if the driver does not say.",
                                {.most = kMaxSubgroup}),
        output<&T::creationMs>("creationMs", "Time by the driver's clock; null if it does not say."),
        field<&T::failure>("failure", "Why the driver did not make it; null if it did.", {.orNull = true}),
        field<&T::facts>("facts",
                         "What means the same on every device; null what the driver does not report."),
        output<&T::executables>("executables", "The parts of its code on the device.", {.optional = true})};
}

}  // namespace glint::inspect

namespace glint::compiler {

static base::Fields fieldsOf(const ModuleCost*) {
    using T = ModuleCost;
    const base::FieldTraits any{.least = 0, .most = inspect::kMostOfFact};
    // A table of a GPU lacks those that no choice reads.
    const base::FieldTraits read{.least = 0, .most = inspect::kMostOfFact, .optional = true};
    return {field<&T::role>("role", "Role of the module that names them."),
            field<&T::tracer>("tracer", "Their tracer; null if they trace nothing.", {.orNull = true}),
            field<&T::modules>("modules", "Number of pipelines.", {.most = inspect::kMaxShaderId}),
            field<&T::cost>("cost", "Average of the estimated cycles; 0 if the driver does not report them.",
                            any),
            field<&T::weight>("weight", "Average of the SPIR-V instructions, 20 for a fetch.", any),
            field<&T::occupancy>("occupancy", "Average occupancy; 0 if the driver does not report it.",
                                 {.least = 0, .most = 1}),
            field<&T::leastOccupancy>("leastOccupancy", "The least occupancy.",
                                      {.least = 0, .most = 1, .optional = true}),
            field<&T::registers>("registers", "The most registers of a lane.", read),
            field<&T::spills>("spills", "All spills.", any),
            field<&T::scratchBytes>("scratchBytes", "The most memory of a lane.", any),
            field<&T::codeBytes>("codeBytes", "All machine code.", read)};
}

static base::Fields fieldsOf(const PackageCosts*) {
    using T = PackageCosts;
    return {field<&T::package>("package", "Name of its folder."),
            field<&T::merge>("merge", "Policy by which keys share cases."),
            field<&T::shadows>("shadows", "Where the shadow rays of hits are traced.",
                               {.names = {"inline", "deferred"}}),
            field(
                "precision", "Bits of shading.", [](const T& costs) { return costs.precision; },
                [](T& costs, std::uint32_t bits, base::JsonReader& reader, const std::string& place) {
                    costs.precision = bits;
                    if (bits != 16 && bits != 32) {
                        reader.fail(place, "is neither 16 nor 32");
                    }
                }),
            field<&T::modules>("summary",
                               "The modules by role and tracer. Averages are over the hits that the compiler "
                               "expects.")};
}

base::Fields fieldsOf(const GpuCosts*) {
    using T = GpuCosts;
    return {base::constant("format", "Tells the file from others.", "glint-gpu"),
            base::constant("version", "Version of the format.", 1),
            field<&T::name>("name", "The name that --gpu takes."),
            field<&T::device>("device", "Name of the device."),
            field<&T::driver>("driver", "Name and version of the driver."),
            field<&T::subgroupSize>("subgroupSize", "The device's usual subgroup.",
                                    {.least = 1, .most = inspect::kMaxSubgroup}),
            field<&T::packages>("packages", "First the package that others are compared with.",
                                {.leastElements = 1})};
}

}  // namespace glint::compiler

namespace glint::inspect {

base::Fields fieldsOf(const PipelineReport*) {
    using T = PipelineReport;
    return {
        base::constant("format", "Tells the file from others.", "glint-pipelines"),
        base::constant("version", "Version of the format.", 1),
        field<&T::package>("package", "Folder of the package, as given on the command line."),
        field<&T::merge>("merge", "Policy by which keys share cases."),
        field<&T::shadows>("shadows", "Where the shadow rays of hits are traced."),
        field<&T::precision>("precision", "Bits of shading.", {.most = 32}),
        base::group(
            "device", "The device that the pipelines were made for.",
            {field<&T::device>("name", "Name of the device."),
             field<&T::driver>("driver", "Name and version of the driver."),
             field<&T::deviceType>("type", "Type of the device."),
             field<&T::subgroupSize>("subgroupSize", "The device's usual subgroup.", {.most = kMaxSubgroup}),
             field<&T::hasStatistics>("statistics", "Whether it reports statistics of pipelines.")}),
        output<summaryOf>("summary", "The pipelines by role and tracer."),
        field<&T::pipelines>("pipelines", "Every pipeline, in the order of the table.")};
}

Result<PipelineReport> readPipelineReport(const std::filesystem::path& file) {
    constexpr std::uint64_t kMaxBytes = 1ULL << 28;
    constexpr const char* kHint = "give a file that glint inspect --pipelines --json wrote";
    return base::readFileAs<PipelineReport>({file, "pipeline-report", kHint}, kMaxBytes);
}

compiler::GpuCosts gpuOf(std::string name, std::span<const PipelineReport> reports) {
    compiler::GpuCosts gpu;
    gpu.name = std::move(name);
    gpu.device = reports.front().device;
    gpu.driver = reports.front().driver;
    gpu.subgroupSize = reports.front().subgroupSize;
    gpu.packages = base::mapped<compiler::PackageCosts>(
        reports, [](const PipelineReport& report) { return summarize(report); });
    return gpu;
}

std::vector<std::string> builtInGpus() {
    return base::mapped<std::string>(
        gpuTables(), [](const base::BuiltinFile& file) { return file.name.substr(0, file.name.rfind('.')); });
}

Result<compiler::GpuCosts> readGpuCosts(const std::string& nameOrFile) {
    base::JsonReader reader(
        nameOrFile, "gpu-table",
        "give a table that scripts/gpu_table.py wrote, or one of: " + base::join(builtInGpus()));
    for (const base::BuiltinFile& file : gpuTables()) {
        if (file.name == nameOrFile + ".json") {
            return base::readAs<compiler::GpuCosts>(reader, base::Json::parse(file.text));
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
    return base::readFileAs<compiler::GpuCosts>(reader, kMaxTableBytes);
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

// Other names are errors, because a budget with a misspelt name would hold nothing.
PipelineBudget::Rule readRule(base::JsonReader& reader, const base::Json& json, const std::string& place) {
    PipelineBudget::Rule rule;
    reader.member(json, place, "pipelines");
    reader.eachMember(json, place,
                      [&](const std::string& name, const base::Json& value, const std::string& there) {
                          const auto* const fact = std::ranges::find(kFacts, name, &FactInfo::name);
                          if (fact != std::end(kFacts)) {
                              rule.limits.*fact->member = reader.number(value, there, 0.0, kMostOfFact);
                          } else if (name == "pipelines" || name == "device") {
                              (name == "device" ? rule.device : rule.pipelines) = reader.text(value, there);
                          } else if (name != "reason") {
                              reader.fail(there, "is no member of a budget");
                          }
                      });
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
    const base::Json* const format = reader.member(json, "", "format");
    if (format != nullptr && *format != "glint-pipeline-budget") {
        reader.fail("/format", "is not \"glint-pipeline-budget\"");
    }
    const base::Json* const rules = reader.member(json, "", "budgets");
    if (rules != nullptr) {
        reader.each(*rules, "/budgets", [&](const base::Json& rule, const std::string& place) {
            budget.rules.push_back(readRule(reader, rule, place));
        });
    }
    if (reader.ok() && budget.rules.empty()) {
        reader.fail("/budgets", "is empty");
    }
    return reader.ok() ? Result<PipelineBudget>(std::move(budget)) : Result<PipelineBudget>(reader.error());
}

std::vector<Diagnostic> overBudget(const PipelineReport& report, const PipelineBudget& budget) {
    std::vector<Diagnostic> found;
    // Rules for other devices count as used, unless all are for others.
    std::vector<bool> used = base::mapped<bool>(
        budget.rules, [&](const PipelineBudget::Rule& rule) { return !isFor(rule, report); });
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
