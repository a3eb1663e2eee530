// The code that the compiler of a GPU makes of Glint's modules, and the choices that follow. The numbers are
// static: nothing runs, so they also come from GPUs that are not there. They describe code, not memory.
//
// The weight of a module is that of its SPIR-V, instructions + kFetchCost * fetches. Shading waits for memory
// and for its own results, and the other subgroups of a processor hide these waits. So an instruction costs
//
//     k = (1 + kFetchCost * max(spills / weight, stack / hit)) / occupancy
//
// in a module; a spill counts as a fetch. `stack` is for pipelines of hit shaders alone: the 32-bit words of
// scratch memory of a lane, which hold what stays alive across calls of shaders, so that each hit stores and
// loads them, and what is spilled to memory. `hit` is the weight of the code of a hit, that of the cases.
// Scratch of other modules comes from spills, which count already. Only ratios of k between modules of one
// GPU are used. The compiler's own cycles would not do: most of them are those of the loop that traverses the
// scene, which compilers weigh as they like, and a switch has one such loop for all of its cases.
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
// none, over modules. `cost` and `occupancy` are 0 if the compiler does not say them.
struct ModuleCost {
    std::string role;    // as package::roleName()
    std::string tracer;  // empty: they trace nothing
    std::uint32_t modules = 0;
    double cost = 0.0;       // average
    double weight = 0.0;     // average
    double occupancy = 0.0;  // average
    double leastOccupancy = 1.0;
    double registers = 0.0;     // the most
    double spills = 0.0;        // sum
    double scratchBytes = 0.0;  // the most
    double codeBytes = 0.0;     // sum
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
// a strategy with a module a case, times the strategy's factor. Other terms stay, as nothing static says how
// fast memory and traversal are. Strategies that the table has no numbers of are left out, because their
// times would be those of another GPU, or the GPU can't run them; if it has no numbers at all, nothing
// changes.
DeviceCosts withGpu(DeviceCosts measured, const GpuCosts& gpu);

// Returns how much longer an instruction takes in a case that branches on features than in one of a single
// key; at least 1. It is that of --merge family where the table has it, else of --merge all. Returns nothing
// if the table has neither.
std::optional<double> branchFactor(const GpuCosts& gpu);

// The value of a setting that is `auto`.
struct GpuChoice {
    std::string setting;  // "shadows" or "precision"
    std::string value;
    std::string why;  // full sentences
    // The table has what the choice needs. If not, the value is the usual one.
    bool known = false;
};
// Returns the values of --shadows and of --precision, in this order. A value that costs memory or accuracy
// has to save at least kLeastGain of the compiler's cycles. 16 bits are taken only if the user accepts their
// error: `acceptedError` is a relMSE. `gpu` may be null, which leaves the usual values.
std::vector<GpuChoice> chooseSettings(const GpuCosts* gpu, double acceptedError);
inline constexpr double kLeastGain = 0.1;
// relMSE of pictures with --precision 16: above the largest of the scenes in docs/numerics.md.
inline constexpr double kHalfError = 4e-6;

// Says what the table has about strategies and merging, and what it lacks, for people: full sentences.
std::string describe(const GpuCosts& gpu);

// Returns the constants of the measured device of that type (plan/strategy_constants.h), for devices without
// a calibration. If no device of that type was measured, it returns those of the other type.
DeviceCosts builtInCosts(bool onCpu);

}  // namespace glint::compiler
