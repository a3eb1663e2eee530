// The time that each strategy takes to shade the hits of a list of rays: the model behind --strategy auto.
//
// A round is one list of N rays, of which the share h hits something. Case i gets the share s(i) of the hits.
// All of them run c(i) of its code, and the share p(i, j) of them runs part j, c(i, j), of a feature that
// only some keys of the case have; code weighs instructions + kFetchCost * fetches. Of the W lanes of a
// subgroup,
//
//     g = 1 + (W - 1) * (1 - coherence)
//
// are as good as drawn at random; each of the others is like one of them. The chance that some lane does what
// a lane does with the probability p is r(p) = 1 - (1 - p)^g, and then the whole subgroup waits for it. A
// lane's part of the work of its subgroup is therefore
//
//     unsorted:  E = sum over i of ( r( h s(i) ) c(i) + sum over j of r( h s(i) p(i, j) ) c(i, j) )
//     sorted:    T = h * sum over i of s(i) ( c(i) + sum over j of r( p(i, j) ) c(i, j) )
//
// T is the work if all lanes of a subgroup have one case, which is the purpose of ordering hits. For W = 32,
// random rays and 64 equal cases E is that of 25 cases instead of one. With one case E and T are nearly the
// same: keys that share a case share the code that they have in common.
//
// The time of a strategy is linear in constants of the device, none below zero. So they can be fitted to
// measurements (bench/strategy_fit.h), and each product can be reported:
//
// clang-format off
//     term          unit  times                         of
//     launches      ms    1                             all: dispatches, barriers, fixed costs
//     cases         ms    number of cases               ordered: a dispatch a case, a half full workgroup
//     rays          ns    N                             all: tracing; ordered: records, and their order
//     incoherence   ns    N scatter                     all: rays that part, memory that is apart
//     buckets       ns    N log2(1 + cases)             ordered: fewer hits that are added up at once
//     instructions  ps    N T                           all: shading without divergence of cases
//     divergence    ps    N (E - T)                     unsorted
//     code          ps    N T (sqrt(cases) - 1)         one shader for all cases
//     misses        ps    N D sqrt(D / 1000), D = E - T unsorted
// clang-format on
//
// The last two terms stand for instruction caches. Their form is a fit to measurements: on an H200 unsorted
// shading of coherent hits grows with the root of the number of cases, and that of incoherent hits grows
// faster than the code that subgroups run (docs/performance.md).
//
// The constants of two strategies also differ for reasons that the model does not name, such as registers: a
// switch needs those of its largest case.
#pragma once

#include "plan/cost.h"

#include <glint/internal/package_modules.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::compiler {

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
    std::string_view name;    // name in files
    std::string_view unit;    // "ms", "ns", "ps"
    double milliseconds;      // milliseconds in one unit
    std::string_view counts;  // the factor of the constant, for people
};
// The rows are indexed by term.
std::span<const CostTermInfo> costTerms();

// Returns the names of all strategies in the order in which equally fast ones are taken, the simplest first:
// those that order no hits before those that do, then those with a dispatch a case, then those with a
// pipeline of their own.
std::span<const std::string_view> simplestFirst();

// Returns whether the time of a strategy has the term. `strategy` is a strategy's name.
bool hasTerm(std::string_view strategy, CostTerm term);

// A case of a round, with its share of the hits and the size of its code.
struct RoundCase {
    double share = 0.0;         // share of the hits; adds up to 1 over all cases
    double instructions = 0.0;  // of code that all hits of the case run
    double fetches = 0.0;
    std::vector<PartialCode> parts{};
};

// One list of rays.
struct Round {
    double rays = 0.0;
    double hitShare = 1.0;   // share of rays that hit something
    double coherence = 0.0;  // of neighbours' hits: 0 if drawn at random, 1 if all are of one case
    double scatter = 1.0;    // of neighbours' rays: 0 as from a mirror, 1 as from a diffuse surface
    std::vector<RoundCase> cases;
    std::uint32_t bounce = 1;  // of paths; 1: the rays of primary surfaces
};

// The constants of one strategy on a device, in the units of costTerms(); 0 for terms that it lacks.
struct StrategyCosts {
    std::string strategy;
    TermValues constants{};
};

// The measured constants of a device. Strategies that it can't run, or that were not measured, have no row.
struct DeviceCosts {
    std::string device;
    std::string driver;
    bool onCpu = false;
    double subgroupSize = 32.0;
    std::string tracer;   // used for all strategies without a pipeline of their own
    std::string shadows;  // inline or deferred; used for all strategies without a pipeline of their own
    std::string source;   // the command that measured them
    std::vector<StrategyCosts> strategies;
};

// Returns null if the device has no row of that name.
const StrategyCosts* findCosts(const DeviceCosts& device, std::string_view strategy);

// Returns the weight in instructions of the code that all hits of a case run, c(i) of the formula above.
double weightOf(const RoundCase& roundCase);

// Returns the number of lanes that are as good as drawn at random, g of the formula above.
double independentLanes(double subgroupSize, double coherence);

// Return E and T of the formula above for g = lanes: a lane's part of its subgroup's work, in instructions a
// ray. For one lane they are the same.
double unsortedWork(const Round& round, double lanes);
double sortedWork(const Round& round, double lanes);

// Returns how many cases a subgroup of unsorted hits runs one after another; at least 1 if there is a hit.
double casesRun(const Round& round, double subgroupSize);

// Returns the factors of the constants, before units are applied.
TermValues termsOf(const Round& round, double subgroupSize);

// Returns the milliseconds of each term. A round without rays takes no time.
TermValues estimate(const Round& round, const StrategyCosts& costs, double subgroupSize);
// Returns the sum of all terms, in milliseconds.
double estimatedMs(const Round& round, const StrategyCosts& costs, double subgroupSize);

// First hits of the camera are shaded by a dispatch a case with every strategy, by modules that are like
// those of `visibility`. On a GPU each case adds the time of its indirect dispatch, most of which lies beside
// others, and an instruction takes kFirstHitWork times as long as there, as a first hit goes through the
// lights and traces their shadow rays one by one. Both are what frames measured on an H200 have
// (docs/merging.md).
inline constexpr double kFirstCaseMs = 0.0055;
inline constexpr double kFirstHitWork = 2.0;

// Returns the milliseconds that shading first hits takes.
double firstHitsMs(const Round& firstHits, const DeviceCosts& device);

// Chooses the strategy that is expected to be fastest, and gives the reasons. Used by --strategy auto and the
// advice of `glint explain`.

// The time that a strategy is expected to take for all rounds of a frame, in milliseconds.
struct StrategyEstimate {
    std::string strategy;
    double ms = 0.0;
    TermValues parts{};      // by CostTerm; ms is their sum
    bool available = false;  // can be chosen
};

// A summary of a frame's rounds, for people. Averages are over hits unless a member says otherwise.
struct FrameFacts {
    double rays = 0.0;
    double laterRays = 0.0;  // of these, rays that hits send: the bounces after the first
    std::uint32_t bounces = 1;
    double hits = 0.0;
    std::size_t cases = 0;
    double instructions = 0.0;  // to shade a hit, with kFetchCost for each fetch
    double coherence = 0.0;     // average over rays
    double casesRun = 0.0;      // cases that a subgroup of unsorted hits runs one after another
};
FrameFacts factsOf(std::span<const Round> rounds, double subgroupSize);

// A strategy and its expected time.
struct ChoiceTime {
    std::string_view strategy;
    double ms = 0.0;
};
// Returns whether `a` is the better choice: it is faster. With one case a strategy that orders hits is never
// better than one that doesn't, because there is nothing to order; an estimate that says otherwise is wrong.
bool isBetterChoice(const ChoiceTime& a, const ChoiceTime& b, std::size_t cases);

struct StrategyChoice {
    std::string strategy;
    std::string why;  // full sentences
    FrameFacts facts;
    std::vector<StrategyEstimate> estimates;  // in the order of simplestFirst(); only those that have
                                              // constants
};

// Chooses the fastest of `available` (a subset of simplestFirst()) for the sum of `rounds`. If several are
// equal, it takes the first in simplestFirst(); with one case it takes none that orders hits, unless there is
// no other. Without rays it takes the first that is available. Returns nothing if the device has no constants
// for any of them.
std::optional<StrategyChoice> chooseStrategy(std::span<const Round> rounds, const DeviceCosts& device,
                                             std::span<const std::string> available);

// A choice, and the facts on which it is based.
struct StrategyAdvice {
    StrategyChoice choice;
    std::string device;   // the device whose constants were used
    bool builtIn = true;  // The constants are built in rather than from a calibration.
    double pixels = 0.0;  // pixels of the assumed frame
};

}  // namespace glint::compiler
