// What shading the hits of a list of rays takes by each strategy: the model behind --strategy auto.
//
// A round is one list of rays. N rays, of which the share h hits something; case i gets the share s(i) of the
// hits, and its shader weighs c(i) = instructions + kFetchCost * fetches. A subgroup has W lanes, of which
//
//     g = 1 + (W - 1) * (1 - coherence)
//
// are as good as drawn at random, and the others like one of them. Some lane of it hits case i with the
// chance 1 - (1 - h s(i))^g, and then the whole subgroup runs c(i): a lane's part of what its subgroup runs
// is
//
//     E(g) = sum over i of ( 1 - (1 - h s(i))^g ) c(i)          E(1) = h * sum over i of s(i) c(i)
//
// E(1) is what runs where all lanes of a subgroup have one case: what ordering hits is for. Unsorted shading
// runs E(g); for W = 32, random rays and 64 cases alike that is 25 cases where one would do.
//
// The time of a strategy is linear in constants of the device, none below zero, so that they can be fitted to
// measurements (bench/strategy_fit.h) and each product can be told:
//
// clang-format off
//     term          unit  times                         of
//     launches      ms    1                             all: dispatches, barriers, what is fixed
//     cases         ms    number of cases               ordered: a dispatch a case, a half full workgroup
//     rays          ns    N                             all: tracing; ordered: records, and their order
//     incoherence   ns    N scatter                     all: rays that part, memory that is apart
//     buckets       ns    N log2(1 + cases)             ordered: fewer hits that are added up at once
//     instructions  ps    N E(1)                        all: shading without divergence
//     divergence    ps    N (E(g) - E(1))               unsorted
//     code          ps    N E(1) (sqrt(cases) - 1)      one shader for all cases
//     misses        ps    N D sqrt(D / 1000), D = E(g) - E(1)      unsorted
// clang-format on
//
// The last two stand for caches of instructions, and are no more than what fits: on an H200 unsorted shading
// of coherent hits grows as the root of the number of cases, and that of incoherent ones faster than the code
// that subgroups run (docs/performance.md).
//
// The constants of two strategies differ for what nothing here names, such as registers: a switch has those
// of its largest case.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

enum class CostTerm : std::uint8_t {
    Launches,
    Cases,
    Rays,
    Incoherence,
    Buckets,
    Instructions,
    Divergence,
    Code,
    Misses,
    Count
};
inline constexpr std::size_t kCostTerms = static_cast<std::size_t>(CostTerm::Count);
using TermValues = std::array<double, kCostTerms>;  // by CostTerm

struct CostTermInfo {
    CostTerm term;
    std::string_view name;    // in files
    std::string_view unit;    // "ms", "ns", "ps"
    double milliseconds;      // in a unit
    std::string_view counts;  // what it is multiplied by, for people
};
// By term.
std::span<const CostTermInfo> costTerms();

// In the order in which one of equals is taken: the simplest first.
inline constexpr std::string_view kStrategyNames[] = {"uber", "sorted-uber", "visibility", "hit-shaders"};

// Whether the time of a strategy has the term. `strategy`: one of kStrategyNames.
bool hasTerm(std::string_view strategy, CostTerm term);

// A case of a round.
struct RoundCase {
    double share = 0.0;  // of the hits; 1 over all cases
    double instructions = 0.0;
    double fetches = 0.0;
};

// One list of rays.
struct Round {
    double rays = 0.0;
    double hitShare = 1.0;   // of rays that hit something
    double coherence = 0.0;  // of neighbours' hits: 0 as drawn at random, 1 all of one case
    double scatter = 1.0;    // of neighbours' rays: 0 as of a mirror, 1 as of a diffuse surface
    std::vector<RoundCase> cases;
};

// Constants of one strategy on a device, in the units of costTerms(); 0 for terms that it lacks.
struct StrategyCosts {
    std::string strategy;
    TermValues constants{};
};

// What is known of a device. Strategies that it can't run, or that were not measured, have no row.
struct DeviceCosts {
    std::string device;
    std::string driver;
    bool onCpu = false;
    double subgroupSize = 32.0;
    std::string tracer;   // that strategies but hit-shaders were measured with
    std::string shadows;  // likewise: inline or deferred
    std::string source;   // the command that measured it
    std::vector<StrategyCosts> strategies;
};

// Null where the device has no row of that name.
const StrategyCosts* findCosts(const DeviceCosts& device, std::string_view strategy);

// What a case's shader weighs, in instructions.
double weightOf(const RoundCase& roundCase);

// Lanes of a subgroup that are as good as drawn at random.
double independentLanes(double subgroupSize, double coherence);

// E(lanes) of the formula above: what a lane's part of its subgroup's work is, in instructions a ray.
double instructionsRun(const Round& round, double lanes);

// Cases that a subgroup of unsorted hits runs one after another; at least 1 where there is a hit.
double casesRun(const Round& round, double subgroupSize);

// What the constants are multiplied by, before units.
TermValues termsOf(const Round& round, double subgroupSize);

// Milliseconds of each term. A round without rays takes nothing.
TermValues estimate(const Round& round, const StrategyCosts& costs, double subgroupSize);
// Milliseconds of all.
double estimatedMs(const Round& round, const StrategyCosts& costs, double subgroupSize);

}  // namespace glint
