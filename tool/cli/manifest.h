// The contents of manifest.json that tables.bin lacks.
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
    // Names by scene and index, for the materials that have one and that shaders list.
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::string> materialNames;
};

// Has the errors of readFile(), and "manifest-format" if the file is not JSON or lacks a member.
Result<Manifest> readManifest(const std::filesystem::path& folder);

}  // namespace glint
