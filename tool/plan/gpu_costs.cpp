#include "plan/gpu_costs.h"

#include "plan/cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

GpuChoice chooseShadows(const GpuCosts& gpu, double nowCost, double deferredCases,
                        const ModuleCost& shadowTrace) {
    const double deferred = deferredCases + shadowTrace.cost;
    const bool chosen = deferred < (1.0 - kLeastGain) * nowCost;
    return {
        "shadows", chosen ? "deferred" : "inline",
        fmt::format("On {} a hit of a case costs {:.0f} cycles with its shadow ray, {:.0f} without, and the "
                    "pass of shadow rays {:.0f}: deferring {} {:.0f} %, and needs records and a pass.",
                    gpu.name, nowCost, deferredCases, shadowTrace.cost, deferred < nowCost ? "saves" : "adds",
                    100.0 * std::abs(1.0 - deferred / nowCost))};
}

}  // namespace

double ModuleCost::costOfInstruction() const {
    if (weight <= 0.0 || occupancy <= 0.0 || modules == 0) {
        return 0.0;
    }
    return (1.0 + kFetchCost * spills / modules / weight) / occupancy;
}

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
    if (cases == nullptr || cases->costOfInstruction() <= 0.0) {
        return factors;
    }
    for (const std::string_view strategy : simplestFirst()) {
        const ModuleCost* const module = findModule(base, shadingRole(strategy));
        if (module != nullptr && module->costOfInstruction() > 0.0) {
            factors.push_back(
                {std::string(strategy), module->costOfInstruction() / cases->costOfInstruction(), module});
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
    for (const StrategyFactor& factor : strategyFactors(gpu)) {
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

double branchFactor(const GpuCosts& gpu) {
    if (gpu.packages.empty()) {
        return 1.0;
    }
    const PackageCosts& base = gpu.packages.front();
    const ModuleCost* const apart = findModule(base, shadingRole(caseStrategy()));
    for (const char* const merge : {"family", "all"}) {
        const PackageCosts* const merged = findPackage(gpu, merge, base.shadows, base.precision);
        const ModuleCost* const together =
            merged == nullptr ? nullptr : findModule(*merged, shadingRole(caseStrategy()));
        if (apart != nullptr && together != nullptr && apart->costOfInstruction() > 0.0) {
            return std::max(1.0, together->costOfInstruction() / apart->costOfInstruction());
        }
    }
    return 1.0;
}

std::vector<GpuChoice> chooseSettings(const GpuCosts& gpu) {
    std::vector<GpuChoice> choices;
    if (gpu.packages.empty()) {
        return choices;
    }
    const PackageCosts& base = gpu.packages.front();
    const double now = costOfCases(&base);
    const PackageCosts* const deferred = findPackage(gpu, base.merge, "deferred", base.precision);
    const ModuleCost* const shadowTrace =
        deferred == nullptr ? nullptr
                            : findModule(*deferred, package::roleName(package::ModuleRole::ShadowTrace));
    if (now > 0.0 && shadowTrace != nullptr && base.shadows == "inline") {
        choices.push_back(chooseShadows(gpu, now, costOfCases(deferred), *shadowTrace));
    }
    const double half = costOfCases(findPackage(gpu, base.merge, base.shadows, 16));
    if (now > 0.0 && half > 0.0 && base.precision == 32) {
        const bool chosen = half < (1.0 - kLeastGain) * now;
        choices.push_back(
            {"precision", chosen ? "16" : "32",
             fmt::format("On {} a hit of a case costs {:.0f} cycles in 32 bits and {:.0f} in 16, "
                         "which has an error.",
                         gpu.name, now, half)});
    }
    return choices;
}

std::string describe(const GpuCosts& gpu) {
    std::string text;
    for (const StrategyFactor& factor : strategyFactors(gpu)) {
        const ModuleCost& module = *factor.module;
        text += fmt::format(
            "{}{}: an instruction of {} costs {:.2f} times what it costs in a case; occupancy "
            "{:.0f} %, {:.0f} spills.",
            text.empty() ? "" : " ", factor.strategy, module.role, factor.factor,
            100.0 * module.leastOccupancy, module.spills);
    }
    return text;
}

}  // namespace glint::compiler
