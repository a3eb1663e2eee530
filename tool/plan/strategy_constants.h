// clang-format off
// Made by scripts/fit_strategy_costs.py from scripts/strategy_costs_*.json; run it again rather than edit this.
// Errors are of estimates by constants that were fitted to other scenes than the one that is estimated.
#pragma once

#include "plan/strategy_cost.h"

#include <span>
#include <string_view>

namespace glint::fitted {

struct StrategyConstants {
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
    std::span<const StrategyConstants> strategies;
};

// NVIDIA H200, NVIDIA 580.159.04
//     uber           52 points, estimates off by 9.3 % (median), 34.2 % at most
//     sorted-uber    52 points, estimates off by 4.6 % (median), 17.7 % at most
//     visibility     52 points, estimates off by 6.0 % (median), 31.2 % at most
//     hit-shaders    52 points, estimates off by 19.0 % (median), 136.2 % at most
//     what auto takes over the fastest, less 1, of constants fitted to other scenes: 0.0 % (median),
//     8.6 % at most; within 5 % at 96.2 % of 52 points
inline constexpr StrategyConstants kGpu[] = {
    {"uber", {0.06097, 0.0, 0.08762, 0.07144, 0.0, 0.08059, 0.0, 0.03316, 0.0853}},
    {"sorted-uber", {0.09131, 0.0, 0.1421, 0.1203, 0.0, 0.04314, 0.0, 0.00171, 0.0}},
    {"visibility", {0.09988, 0.0001272, 0.1371, 0.1197, 0.003504, 0.04388, 0.0, 0.0, 0.0}},
    {"hit-shaders", {0.05827, 0.0, 0.1029, 0.04979, 0.0, 0.06789, 0.0, 0.05379, 0.08257}},
};

// llvmpipe (LLVM 15.0.6, 256 bits), llvmpipe Mesa 25.0.7-2~bpo12+1 (LLVM 15.0.6)
//     uber           32 points, estimates off by 29.4 % (median), 69.2 % at most
//     sorted-uber    32 points, estimates off by 48.1 % (median), 111.1 % at most
//     visibility     32 points, estimates off by 43.1 % (median), 89.6 % at most
//     hit-shaders    32 points, estimates off by 29.3 % (median), 68.5 % at most
//     what auto takes over the fastest, less 1, of constants fitted to other scenes: 0.0 % (median),
//     1.5 % at most; within 5 % at 100.0 % of 32 points
inline constexpr StrategyConstants kCpu[] = {
    {"uber", {0.0, 0.0, 93.63, 52.74, 0.0, 29.23, 0.0, 0.0, 36.53}},
    {"sorted-uber", {0.2256, 0.0, 63.03, 142.0, 17.47, 49.3, 0.0, 3.117, 0.0}},
    {"visibility", {0.357, 0.0308, 31.44, 152.7, 30.58, 52.24, 0.0, 0.0, 0.0}},
    {"hit-shaders", {0.0, 0.0, 102.3, 72.86, 0.0, 36.66, 0.0, 0.0, 43.11}},
};

inline constexpr DeviceRow kDevices[] = {
    {"NVIDIA H200", "NVIDIA 580.159.04",
     false, 32.0, "ray-pipeline", "inline",
     "glint bench --output=DIR --rounds=3 --calibrate --calibrate-cases=1,16,64 --calibrate-rays=1M,8M; glint bench --output=DIR --rounds=3 --calibrate --calibrate-cases=4 --calibrate-rays=1M,8M,32M; glint bench --output=DIR --rounds=3 --calibrate --calibrate-cases=1,16,64 --calibrate-rays=32M; glint bench --output=DIR --rounds=3 --calibrate --calibrate-cases=64 --calibrate-rays=32M --calibrate-cost=expensive; glint bench --output=DIR --rounds=3 --calibrate --calibrate-cases=256 --calibrate-rays=1M,8M --calibrate-cost=cheap",
     kGpu},
    {"llvmpipe (LLVM 15.0.6, 256 bits)", "llvmpipe Mesa 25.0.7-2~bpo12+1 (LLVM 15.0.6)",
     true, 8.0, "ray-query", "inline",
     "glint bench --output=DIR --rounds=6 --calibrate --calibrate-cases=1,4,16,64 --calibrate-rays=16k,64k",
     kCpu},
};

}  // namespace glint::fitted
