// What manifest.json says beyond tables.bin.
#pragma once

#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace glint {

struct Manifest {
    std::string toolVersion;
    std::string merge;
    std::string variant;  // empty: none
    std::vector<std::string> hitLobes;
    bool energyCompensation = true;
    std::string textureLod;
    std::map<std::uint32_t, std::string>
        materialNames;  // of the materials that have one and that shaders list
};

// Errors of readFile(), and "manifest-format" where the file is not JSON or lacks a member.
Result<Manifest> readManifest(const std::filesystem::path& folder);

}  // namespace glint
