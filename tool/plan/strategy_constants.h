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
//     uber           46 points, estimates off by 10.8 % (median), 37.4 % at most
//     sorted-uber    46 points, estimates off by 4.8 % (median), 16.8 % at most
//     visibility     46 points, estimates off by 5.8 % (median), 33.3 % at most
//     hit-shaders    46 points, estimates off by 22.6 % (median), 126.2 % at most
//     what auto takes over the fastest, less 1, of constants fitted to other scenes: 0.0 % (median),
//     9.4 % at most; within 5 % at 97.8 % of 46 points
inline constexpr StrategyConstants kGpu[] = {
    {"uber", {0.06173, 0.0, 0.08592, 0.07879, 0.0, 0.07791, 0.0, 0.0375, 0.08233}},
    {"sorted-uber", {0.08911, 0.0001723, 0.1415, 0.1184, 0.0, 0.04257, 0.0, 0.00266, 0.0}},
    {"visibility", {0.09047, 0.000675, 0.1403, 0.1189, 0.001912, 0.04537, 0.0, 0.0, 0.0}},
    {"hit-shaders", {0.05956, 0.0, 0.1006, 0.05974, 0.0, 0.06646, 0.0, 0.05789, 0.07672}},
};

// llvmpipe (LLVM 15.0.6, 256 bits), llvmpipe Mesa 25.0.7-2~bpo12+1 (LLVM 15.0.6)
//     uber           32 points, estimates off by 57.8 % (median), 359.2 % at most
//     sorted-uber    32 points, estimates off by 60.5 % (median), 220.1 % at most
//     visibility     32 points, estimates off by 44.0 % (median), 155.1 % at most
//     hit-shaders    32 points, estimates off by 45.3 % (median), 357.9 % at most
//     what auto takes over the fastest, less 1, of constants fitted to other scenes: 0.0 % (median),
//     154.5 % at most; within 5 % at 68.8 % of 32 points
inline constexpr StrategyConstants kCpu[] = {
    {"uber", {0.0, 0.0, 127.3, 246.1, 0.0, 22.94, 62.08, 0.0, 0.0}},
    {"sorted-uber", {0.0, 0.0, 20.84, 320.3, 18.35, 100.0, 0.0, 0.0, 0.0}},
    {"visibility", {0.0, 0.006262, 21.92, 290.8, 36.84, 105.0, 0.0, 0.0, 0.0}},
    {"hit-shaders", {0.0, 0.0, 206.3, 185.7, 0.0, 0.0, 64.81, 0.0, 0.0}},
};

inline constexpr DeviceRow kDevices[] = {
    {"NVIDIA H200", "NVIDIA 580.159.04",
     false, 32.0, "ray-pipeline", "inline",
     "glint bench --output=DIR --rounds=3 --calibrate --calibrate-cases=1,16,64 --calibrate-rays=1M,8M; glint bench --output=DIR --rounds=3 --calibrate --calibrate-cases=4 --calibrate-rays=1M,8M,32M; glint bench --output=DIR --rounds=3 --calibrate --calibrate-cases=1,16,64 --calibrate-rays=32M",
     kGpu},
    {"llvmpipe (LLVM 15.0.6, 256 bits)", "llvmpipe Mesa 25.0.7-2~bpo12+1 (LLVM 15.0.6)",
     true, 8.0, "ray-query", "inline",
     "glint bench --output=out/calibration --rounds=6 --calibrate --calibrate-cases=1,4,16,64 --calibrate-rays=16k,64k",
     kCpu},
};

}  // namespace glint::fitted
