// Made by scripts/fit_strategy_costs.py from scripts/strategy_costs_*.json; run it again rather than edit this.
// Errors are of estimates by constants that were fitted to other scenes than the one that is estimated.
// clang-format off
#pragma once

#include "plan/strategy_cost.h"

#include <span>
#include <string_view>

namespace glint::fitted {

struct StrategyRow {
    std::string_view strategy;
    TermValues constants;  // in the units of costTerms()
};

// As DeviceCosts.
struct DeviceRow {
    std::string_view device;
    std::string_view driver;
    bool onCpu;
    double subgroupSize;
    std::string_view tracer;
    std::string_view shadows;
    std::string_view command;
    std::span<const StrategyRow> strategies;
};

// llvmpipe (LLVM 15.0.6, 256 bits), llvmpipe Mesa 25.0.7-2~bpo12+1
//     uber           32 points, estimates off by 38.7 % (median), 143.4 % at most
//     sorted-uber    32 points, estimates off by 28.5 % (median), 129.0 % at most
//     visibility     32 points, estimates off by 33.2 % (median), 120.3 % at most
//     hit-shaders    32 points, estimates off by 35.0 % (median), 148.4 % at most
//     what auto takes over the fastest, less 1, of constants fitted to other scenes: 9.3 % (median),
//     336.2 % at most; within 5 % at 34.4 % of 32 points
inline constexpr StrategyRow kCpu[] = {
    {"uber", {0.0, 0.0, 1127.0, 758.8, 0.0, 1569.0, 0.0, 2.207}},
    {"sorted-uber", {0.0, 0.0, 1852.0, 606.1, 326.7, 562.9, 0.0, 0.0}},
    {"visibility", {0.0, 0.0, 1940.0, 670.4, 351.1, 428.0, 0.0, 0.0}},
    {"hit-shaders", {0.0, 0.0, 1576.0, 985.3, 0.0, 1487.0, 21.03, 0.0}},
};

inline constexpr DeviceRow kDevices[] = {
    {"llvmpipe (LLVM 15.0.6, 256 bits)", "llvmpipe Mesa 25.0.7-2~bpo12+1",
     true, 8.0, "ray-query", "inline",
     "glint render --stats of generated scenes, on a machine that did other work at the same time",
     kCpu},
};

}  // namespace glint::fitted
