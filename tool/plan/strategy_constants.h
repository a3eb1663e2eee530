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
//     uber           24 points, estimates off by 9.2 % (median), 30.1 % at most
//     sorted-uber    24 points, estimates off by 6.7 % (median), 17.7 % at most
//     visibility     24 points, estimates off by 8.5 % (median), 34.2 % at most
//     hit-shaders    24 points, estimates off by 17.4 % (median), 56.0 % at most
//     what auto takes over the fastest, less 1, of constants fitted to other scenes: 0.4 % (median),
//     9.4 % at most; within 5 % at 91.7 % of 24 points
inline constexpr StrategyConstants kGpu[] = {
    {"uber", {0.05567, 0.0, 0.08413, 0.09457, 0.0, 0.07947, 0.0, 0.04324, 0.08733}},
    {"sorted-uber", {0.09264, 0.0, 0.133, 0.1136, 0.0, 0.05273, 0.0, 0.002823, 0.0}},
    {"visibility", {0.09324, 0.0004416, 0.1365, 0.1079, 0.00238, 0.05624, 0.0, 0.0, 0.0}},
    {"hit-shaders", {0.08049, 0.0, 0.1116, 0.07341, 0.0, 0.0651, 0.07144, 0.06468, 0.1019}},
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
     "glint bench --output=/root/out/cal --rounds=3 --calibrate --calibrate-cases=1,16,64 --calibrate-rays=1M,8M",
     kGpu},
    {"llvmpipe (LLVM 15.0.6, 256 bits)", "llvmpipe Mesa 25.0.7-2~bpo12+1 (LLVM 15.0.6)",
     true, 8.0, "ray-query", "inline",
     "glint bench --output=out/calibration --rounds=6 --calibrate --calibrate-cases=1,4,16,64 --calibrate-rays=16k,64k",
     kCpu},
};

}  // namespace glint::fitted
