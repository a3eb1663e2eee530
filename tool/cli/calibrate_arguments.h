// The command line of glint bench --calibrate.
#pragma once

#include "synthetic/cases_scene.h"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace glint {

struct CalibrateArguments {
    bool enabled = false;
    // As given; "auto": by the device and --quick.
    std::string caseWords = "auto";
    std::string rayWords = "auto";
    std::vector<std::string> costs{"cheap", "expensive"};
    std::vector<std::string> coherences{"coherent", "incoherent"};
    std::string shares = "uniform";
    std::int64_t lights = 0;
    bool shadows = false;
    std::string pictures;  // folder; empty: none are written
};

void addCalibrateOptions(CLI::App& command, CalibrateArguments& arguments);
// Throws a CLI::ParseError where options disagree.
void checkCalibrateOptions(const CLI::App& command, const CalibrateArguments& arguments);

// "1,4,16", or `usual` for "auto". The text is one that addCalibrateOptions() has let pass.
std::vector<std::uint32_t> casesOf(const CalibrateArguments& arguments,
                                   const std::vector<std::uint32_t>& usual);
// "16k,1M" likewise: k is a thousand, M a million.
std::vector<std::uint64_t> raysOf(const CalibrateArguments& arguments,
                                  const std::vector<std::uint64_t>& usual);

}  // namespace glint
