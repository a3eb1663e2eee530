// clang-format off
// Made by benchmarks/fit_strategy_costs.py from benchmarks/data/strategy_costs_*.json; run it again rather than edit this.
// Errors are of estimates by constants that were fitted to other scenes than the one that is estimated.
#pragma once

#include "plan/strategy_cost.h"

#include <span>
#include <string_view>

namespace glint::compiler::fitted {

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
//     uber           56 points, estimates off by 11.7 % (median), 85.5 % at most
//     sorted-uber    56 points, estimates off by 5.1 % (median), 17.2 % at most
//     visibility     56 points, estimates off by 6.2 % (median), 33.4 % at most
//     hit-shaders    56 points, estimates off by 29.5 % (median), 136.3 % at most
//     what auto takes over the fastest, less 1, of constants fitted to other scenes: 0.0 % (median),
//     9.2 % at most; within 5 % at 94.6 % of 56 points
inline constexpr StrategyConstants kGpu[] = {
    {"uber", {0.06096, 0.0, 0.1135, 0.05625, 0.0, 0.07318, 0.0, 0.02379, 0.08667}},
    {"sorted-uber", {0.09272, 0.0, 0.1368, 0.1207, 0.0, 0.0443, 0.0, 0.002533, 0.0}},
    {"visibility", {0.09655, 0.0002409, 0.1239, 0.1202, 0.004866, 0.05046, 0.0, 0.0, 0.0}},
    {"hit-shaders", {0.05699, 0.0, 0.1364, 0.02626, 0.0, 0.05988, 0.0, 0.03607, 0.08683}},
};

// llvmpipe (LLVM 15.0.6, 256 bits), llvmpipe Mesa 25.0.7-2~bpo12+1 (LLVM 15.0.6)
//     uber           32 points, estimates off by 17.1 % (median), 84.1 % at most
//     sorted-uber    32 points, estimates off by 45.5 % (median), 98.2 % at most
//     visibility     32 points, estimates off by 47.2 % (median), 97.9 % at most
//     hit-shaders    32 points, estimates off by 23.1 % (median), 90.3 % at most
//     what auto takes over the fastest, less 1, of constants fitted to other scenes: 0.8 % (median),
//     15.1 % at most; within 5 % at 65.6 % of 32 points
inline constexpr StrategyConstants kCpu[] = {
    {"uber", {0.28, 0.0, 193.2, 76.75, 0.0, 0.0, 0.0, 0.0, 39.83}},
    {"sorted-uber", {1.221, 0.0, 72.43, 158.6, 21.15, 49.43, 0.0, 0.0, 0.0}},
    {"visibility", {1.048, 0.05763, 86.81, 161.5, 18.01, 43.05, 0.0, 0.0, 0.0}},
    {"hit-shaders", {0.05036, 0.0, 205.1, 58.87, 0.0, 4.011, 0.0, 0.0, 48.81}},
};

inline constexpr DeviceRow kDevices[] = {
    {"NVIDIA H200", "NVIDIA 580.159.04",
     false, 32.0, "ray-pipeline", "inline",
     "glint bench --output=DIR --rounds=3 --calibrate --calibrate-cases=1,16,64 --calibrate-rays=1M,8M; glint bench --output=DIR --rounds=3 --calibrate --calibrate-cases=256 --calibrate-rays=1M,8M --calibrate-cost=cheap; glint bench --output=DIR --rounds=3 --calibrate --calibrate-cases=256 --calibrate-rays=1M,8M --calibrate-cost=expensive --calibrate-coherence=coherent; glint bench --output=DIR --rounds=3 --calibrate --calibrate-cases=256 --calibrate-rays=1M,8M --calibrate-cost=expensive --calibrate-coherence=incoherent; glint bench --output=DIR --rounds=3 --calibrate --calibrate-cases=1,16,64 --calibrate-rays=32M; glint bench --output=DIR --rounds=3 --calibrate --calibrate-cases=4 --calibrate-rays=1M,8M,32M; glint bench --output=DIR --rounds=3 --calibrate --calibrate-cases=64 --calibrate-rays=32M --calibrate-cost=expensive",
     kGpu},
    {"llvmpipe (LLVM 15.0.6, 256 bits)", "llvmpipe Mesa 25.0.7-2~bpo12+1 (LLVM 15.0.6)",
     true, 8.0, "ray-query", "inline",
     "glint bench --output=DIR --rounds=6 --calibrate --calibrate-cases=1,4,16,64 --calibrate-rays=16k,64k",
     kCpu},
};

}  // namespace glint::compiler::fitted
