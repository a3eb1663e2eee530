#include "plan/gpu_costs.h"

#include "plan/cost.h"
#include "plan/strategy_constants.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace glint::compiler {

namespace {

const PackageCosts* findPackage(const GpuCosts& gpu, std::string_view merge, std::string_view shadows,
                                std::uint32_t precision) {
    const auto found = std::ranges::find_if(gpu.packages, [&](const PackageCosts& package) {
        return package.merge == merge && package.shadows == shadows && package.precision == precision;
    });
    return found == gpu.packages.end() ? nullptr : &*found;
}

// Returns the strategy that has a module for each case. The table of strategies has one.
std::string_view caseStrategy() {
    return std::ranges::find_if(package::strategyTable(), &package::StrategyInfo::dispatchesCases)->name;
}

// Returns the cost of the cases of a package, for each hit; 0 if it has none.
double costOfCases(const PackageCosts* package) {
    const ModuleCost* const cases =
        package == nullptr ? nullptr : findModule(*package, shadingRole(caseStrategy()));
    return cases == nullptr ? 0.0 : cases->cost;
}

constexpr CostTerm kOfInstructions[] = {CostTerm::Instructions, CostTerm::Divergence, CostTerm::Code,
                                        CostTerm::Misses};

double constantOf(const StrategyCosts& costs, CostTerm term) {
    return costs.constants[static_cast<std::size_t>(term)];
}

double wordsOf(double bytes) {
    constexpr double kWordBytes = 4.0;
    return bytes / kWordBytes;
}

// Returns k of the formula in the header, or 0 where the compiler does not say enough. `hit` is the weight of
// the code of a hit; if it is 0, the module has no stack.
double costOfInstruction(const ModuleCost& module, double hit = 0.0) {
    if (module.weight <= 0.0 || module.occupancy <= 0.0 || module.modules == 0) {
        return 0.0;
    }
    const double spills = module.spills / module.modules / module.weight;
    const double stack = hit > 0.0 ? wordsOf(module.scratchBytes) / hit : 0.0;
    return (1.0 + kFetchCost * std::max(spills, stack)) / module.occupancy;
}

bool hasStack(std::string_view strategy) {
    return package::findStrategy(strategy)->ownPipeline;
}

// Returns "saves 12 %" or "adds 3 %".
std::string savingText(double before, double after) {
    return fmt::format("{} {:.0f} %", after < before ? "saves" : "adds",
                       100.0 * std::abs(1.0 - after / before));
}

GpuChoice lacking(const GpuCosts& gpu, std::string_view setting, std::string_view value,
                  std::string_view what) {
    return {std::string(setting), std::string(value),
            fmt::format("The table of {} does not say what {} costs, so --{} stays {}.", gpu.name, what,
                        setting, value)};
}

GpuChoice chooseShadows(const GpuCosts& gpu) {
    const PackageCosts& base = gpu.packages.front();
    const PackageCosts* const package = findPackage(gpu, base.merge, "deferred", base.precision);
    const ModuleCost* const trace =
        package == nullptr ? nullptr
                           : findModule(*package, package::roleName(package::ModuleRole::ShadowTrace));
    const double before = costOfCases(&base);
    const double cases = costOfCases(package);
    if (base.shadows != "inline" || before <= 0.0 || cases <= 0.0 || trace == nullptr || trace->cost <= 0.0) {
        return lacking(gpu, "shadows", "inline", "--shadows deferred");
    }
    const double after = cases + trace->cost;
    const bool chosen = after < (1.0 - kLeastGain) * before;
    return {"shadows", chosen ? "deferred" : "inline",
            fmt::format("On {} a hit of a case costs {:.0f} cycles with its shadow ray, {:.0f} without, and "
                        "the pass of shadow rays {:.0f}: deferring {}, and needs records and a pass.",
                        gpu.name, before, cases, trace->cost, savingText(before, after)),
            true};
}

GpuChoice choosePrecision(const GpuCosts& gpu, double acceptedError) {
    const PackageCosts& base = gpu.packages.front();
    const double before = costOfCases(&base);
    const double after = costOfCases(findPackage(gpu, base.merge, base.shadows, 16));
    if (base.precision != 32 || before <= 0.0 || after <= 0.0) {
        return lacking(gpu, "precision", "32", "--precision 16");
    }
    const bool saves = after < (1.0 - kLeastGain) * before;
    const bool chosen = saves && acceptedError >= kHalfError;
    std::string why =
        fmt::format("On {} a hit of a case costs {:.0f} cycles in 32 bits and {:.0f} in 16, which {}.",
                    gpu.name, before, after, savingText(before, after));
    if (saves) {
        why += fmt::format(" 16 bits have a relMSE of up to {:g}, and --precision-error accepts {:g}.",
                           kHalfError, acceptedError);
    }
    return {"precision", chosen ? "16" : "32", std::move(why), true};
}

}  // namespace

const ModuleCost* findModule(const PackageCosts& package, std::string_view role) {
    const ModuleCost* found = nullptr;
    for (const ModuleCost& module : package.modules) {
        if (module.role == role && (found == nullptr || module.tracer == "ray-query")) {
            found = &module;
        }
    }
    return found;
}

std::string_view shadingRole(std::string_view strategy) {
    for (const package::RoleInfo& info : package::rolesOf(package::findStrategy(strategy)->strategy)) {
        const bool shades =
            info.declared->cases != package::CaseCode::None && info.purpose != package::Purpose::Fallback;
        if (shades && info.kind != package::ShaderKind::ClosestHit) {
            return info.name;
        }
        if (info.kind == package::ShaderKind::RayGeneration) {
            return info.name;  // its pipeline has the code of all cases
        }
    }
    return {};
}

std::vector<StrategyFactor> strategyFactors(const GpuCosts& gpu) {
    std::vector<StrategyFactor> factors;
    if (gpu.packages.empty()) {
        return factors;
    }
    const PackageCosts& base = gpu.packages.front();
    const ModuleCost* const cases = findModule(base, shadingRole(caseStrategy()));
    const double ofCases = cases == nullptr ? 0.0 : costOfInstruction(*cases);
    if (ofCases <= 0.0) {
        return factors;
    }
    for (const std::string_view strategy : simplestFirst()) {
        const ModuleCost* const module = findModule(base, shadingRole(strategy));
        const double own =
            module == nullptr ? 0.0 : costOfInstruction(*module, hasStack(strategy) ? cases->weight : 0.0);
        if (own > 0.0) {
            factors.push_back({std::string(strategy), own / ofCases, module});
        }
    }
    return factors;
}

DeviceCosts withGpu(DeviceCosts measured, const GpuCosts& gpu) {
    measured.subgroupSize = gpu.subgroupSize;
    const StrategyCosts* const cases = findCosts(measured, caseStrategy());
    const double ofCases = cases == nullptr ? 0.0 : constantOf(*cases, CostTerm::Instructions);
    if (ofCases <= 0.0) {
        return measured;
    }
    const std::vector<StrategyFactor> factors = strategyFactors(gpu);
    if (factors.empty()) {
        return measured;
    }
    std::erase_if(measured.strategies, [&factors](const StrategyCosts& row) {
        return std::ranges::find(factors, row.strategy, &StrategyFactor::strategy) == factors.end();
    });
    for (const StrategyFactor& factor : factors) {
        const auto row = std::ranges::find(measured.strategies, factor.strategy, &StrategyCosts::strategy);
        if (row == measured.strategies.end()) {
            continue;
        }
        const double own = constantOf(*row, CostTerm::Instructions);
        // The measured device's constants include the extra time of this strategy's module over those of
        // cases. The compiler's factor replaces that ratio.
        const double scale = own > 0.0 ? factor.factor * ofCases / own : factor.factor;
        for (const CostTerm term : kOfInstructions) {
            row->constants[static_cast<std::size_t>(term)] *= scale;
        }
    }
    return measured;
}

std::optional<double> branchFactor(const GpuCosts& gpu) {
    if (gpu.packages.empty()) {
        return std::nullopt;
    }
    const PackageCosts& base = gpu.packages.front();
    const ModuleCost* const apart = findModule(base, shadingRole(caseStrategy()));
    const double ofOneKey = apart == nullptr ? 0.0 : costOfInstruction(*apart);
    for (const char* const merge : {"family", "all"}) {
        const PackageCosts* const merged = findPackage(gpu, merge, base.shadows, base.precision);
        const ModuleCost* const together =
            merged == nullptr ? nullptr : findModule(*merged, shadingRole(caseStrategy()));
        const double ofSeveral = together == nullptr ? 0.0 : costOfInstruction(*together);
        if (ofOneKey > 0.0 && ofSeveral > 0.0) {
            return std::max(1.0, ofSeveral / ofOneKey);
        }
    }
    return std::nullopt;
}

std::vector<GpuChoice> chooseSettings(const GpuCosts* gpu, double acceptedError) {
    if (gpu == nullptr) {
        const std::string why = "No table of a GPU is given (--gpu NAME or FILE).";
        return {{"shadows", "inline", why}, {"precision", "32", why}};
    }
    if (gpu->packages.empty()) {
        return {lacking(*gpu, "shadows", "inline", "--shadows deferred"),
                lacking(*gpu, "precision", "32", "--precision 16")};
    }
    return {chooseShadows(*gpu), choosePrecision(*gpu, acceptedError)};
}

std::string describe(const GpuCosts& gpu) {
    const std::vector<StrategyFactor> factors = strategyFactors(gpu);
    std::string text =
        factors.empty() ? "The table has no numbers of strategies, so the measured ones stay. " : "";
    for (const std::string_view strategy : simplestFirst()) {
        const auto found = std::ranges::find(factors, strategy, &StrategyFactor::strategy);
        if (found == factors.end()) {
            text += factors.empty()
                        ? ""
                        : fmt::format("{}: the table has no numbers of {}, so auto leaves it out. ", strategy,
                                      shadingRole(strategy));
            continue;
        }
        const ModuleCost& module = *found->module;
        text += fmt::format(
            "{}: an instruction of {} costs {:.2f} times what it costs in a case; occupancy {:.0f} %, {:.0f} "
            "spills{}. ",
            strategy, module.role, found->factor, 100.0 * module.occupancy, module.spills,
            hasStack(strategy) ? fmt::format(", a stack of {:.0f} bytes a lane", module.scratchBytes) : "");
    }
    const std::optional<double> branches = branchFactor(gpu);
    return text + (branches ? fmt::format("In a case that branches it costs {:.2f} times as much.", *branches)
                            : std::string("The table has no package of --merge family or all, so branches "
                                          "cost what they cost without it."));
}

DeviceCosts builtInCosts(bool onCpu) {
    const auto* row = std::ranges::find(fitted::kDevices, onCpu, &fitted::DeviceRow::onCpu);
    if (row == std::end(fitted::kDevices)) {
        row = std::begin(fitted::kDevices);
    }
    DeviceCosts costs{std::string(row->device),
                      std::string(row->driver),
                      row->onCpu,
                      row->subgroupSize,
                      std::string(row->tracer),
                      std::string(row->shadows),
                      std::string(row->command),
                      {}};
    for (const fitted::StrategyConstants& strategy : row->strategies) {
        costs.strategies.push_back({std::string(strategy.strategy), strategy.constants});
    }
    return costs;
}

}  // namespace glint::compiler
