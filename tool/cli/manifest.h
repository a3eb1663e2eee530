// What manifest.json says beyond tables.bin.
#pragma once

#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace glint {

struct Manifest {
    std::string toolVersion;
    std::string merge;
    std::vector<std::string> variants;  // by scene; empty: none
    std::vector<std::string> hitLobes;
    bool energyCompensation = true;
    std::string textureLod;
    // By scene and index: of the materials that have one and that shaders list.
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::string> materialNames;
};

// Errors of readFile(), and "manifest-format" where the file is not JSON or lacks a member.
Result<Manifest> readManifest(const std::filesystem::path& folder);

}  // namespace glint
