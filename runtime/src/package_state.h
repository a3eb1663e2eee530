// A package in memory, and the checks that make it trustworthy.
#pragma once

#include "interop/scene.h"

#include <glint/package.h>
#include <glint/package_modules.h>
#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

struct Package::State {
    std::vector<std::uint8_t> tables;  // the file; the spans below point into it
    package::PackageHeader header{};
    std::span<const package::ModuleEntry> modules;
    std::span<const gpu::MaterialRecord> materials;
    std::span<const package::PrimitiveEntry> primitives;
    std::span<const package::TextureEntry> textures;
    std::span<const package::SamplerEntry> samplers;
    std::span<const char> strings;
    std::span<const package::CaseEntry> cases;
    std::span<const package::SceneEntry> scenes;
    // By file name: entries that name one file share its words.
    std::map<std::string, std::vector<std::uint32_t>, std::less<>> spirv;
};

// Of the header and the cases.
package::PackageShape shapeOf(const Package::State& state);

// Reads the header, the section table and the spans out of state.tables. `where` is the file's name.
// Errors: "package-foreign" (no package), "package-version", "package-truncated", "package-altered".
Status readTables(Package::State& state, const std::string& where);

// Every index, reference and promise of the tables. Error "package-altered", with what is wrong.
Status checkTables(const Package::State& state, const std::string& where);

// Reads the modules that the tables name into state.spirv.
// Errors: "package-module-missing", "package-module-altered", "package-file-name".
Status readModules(Package::State& state, const std::filesystem::path& folder);

// A whole file. Errors: `missingId` where there is no such file, "package-read".
Result<std::vector<std::uint8_t>> readPackageFile(const std::filesystem::path& path, const char* missingId,
                                                  std::uint64_t maxBytes);

}  // namespace glint
