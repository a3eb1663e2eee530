// The code that the compiler of a GPU makes of Glint's modules, and the choices that follow. The numbers are
// static: nothing runs, so they also come from GPUs that are not there. They describe code, not memory.
//
// The weight of a module is that of its SPIR-V, instructions + kFetchCost * fetches. Shading waits for memory
// and for its own results, and the other subgroups of a processor hide these waits. So an instruction costs
//
//     k = (1 + kFetchCost * spills / weight) / occupancy
//
// in a module; a spill counts as a fetch. Only ratios of k between modules of one GPU are used. The
// compiler's own cycles would be misleading. Most of them are those of the loop that traverses the scene,
// which compilers weigh arbitrarily, and a switch has one such loop for all of its cases.
#pragma once

#include "plan/strategy_cost.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::compiler {

// The modules of one role and tracer. Averages are over the hits that the compiler expects; where it expects
// none, over modules.
struct ModuleCost {
    std::string role;    // as package::roleName()
    std::string tracer;  // empty: they trace nothing
    std::uint32_t modules = 0;
    double cost = 0.0;       // average
    double weight = 0.0;     // average
    double occupancy = 1.0;  // average
    double leastOccupancy = 1.0;
    double registers = 0.0;     // the most
    double spills = 0.0;        // sum
    double scratchBytes = 0.0;  // the most
    double codeBytes = 0.0;     // sum

    // Returns k of the formula above, or 0 where the compiler does not say enough.
    double costOfInstruction() const;
};

struct PackageCosts {
    std::string package;
    std::string merge;
    std::string shadows;
    std::uint32_t precision = 32;
    std::vector<ModuleCost> modules;
};

struct GpuCosts {
    std::string name;
    std::string device;
    std::string driver;
    double subgroupSize = 32.0;
    // Others are compared with the first package: --merge none, --shadows inline, --precision 32. The others
    // are of the same scene.
    std::vector<PackageCosts> packages;
};

// Returns null if the package has no module of the role. Ray queries come before ray tracing pipelines.
const ModuleCost* findModule(const PackageCosts& package, std::string_view role);

// Returns the role of the module that shades the hits of a strategy.
std::string_view shadingRole(std::string_view strategy);

// Returns the factor by which an instruction takes longer in a strategy's shading module than in one of a
// case, for each strategy that the table has; the factor of strategies with a module a case is 1.
struct StrategyFactor {
    std::string strategy;
    double factor = 1.0;
    const ModuleCost* module = nullptr;
};
std::vector<StrategyFactor> strategyFactors(const GpuCosts& gpu);

// Returns the constants of a measured device as they should be on the GPU. Terms of instructions are those of
// a strategy with a module a case, times the strategy's factor. Other terms stay, because static numbers do
// not show the speed of memory and traversal.
DeviceCosts withGpu(DeviceCosts measured, const GpuCosts& gpu);

// Returns the factor by which an instruction takes longer in a case that branches on features than in one of
// a single key; at least 1. It is the factor of --merge family if the table has it, else that of --merge all,
// else 1.
double branchFactor(const GpuCosts& gpu);

// A choice among the values of a setting.
struct GpuChoice {
    std::string setting;  // "shadows"
    std::string value;
    std::string why;  // a full sentence
};
// Returns the choices that the compiler's numbers suggest for the settings of which the table has several
// values. A value that costs memory or accuracy has to save at least kLeastGain.
std::vector<GpuChoice> chooseSettings(const GpuCosts& gpu);
inline constexpr double kLeastGain = 0.1;

// Describes the modules that limit the GPU, for people: full sentences.
std::string describe(const GpuCosts& gpu);

}  // namespace glint::compiler
