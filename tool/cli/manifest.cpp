#include "cli/manifest.h"

#include "base/files.h"
#include "base/json_depth.h"

#include <glint/package_format.h>

#include <nlohmann/json.hpp>

#include <exception>

namespace glint {

Result<Manifest> readManifest(const std::filesystem::path& folder) {
    const std::filesystem::path path = folder / package::kManifestFile;
    const Result<Bytes> bytes = readFile(path);
    if (!bytes) {
        return bytes.error();
    }
    const auto unreadable = [&](const std::string& why) {
        return makeError("manifest-format", path.string(), "is no manifest that can be read: " + why,
                         "compile the package again");
    };
    if (nestsTooDeep(*bytes)) {
        return unreadable("nests too deep");
    }
    try {
        const auto json = nlohmann::json::parse(bytes->begin(), bytes->end());
        Manifest manifest;
        manifest.toolVersion = json.at("toolVersion").get<std::string>();
        manifest.merge = json.at("merge").get<std::string>();
        for (const auto& scene : json.at("scenes")) {
            const auto& variant = scene.at("variant");
            manifest.variants.push_back(variant.is_null() ? "" : variant.get<std::string>());
        }
        const auto& settings = json.at("settings");
        manifest.hitLobes = settings.at("hitLobes").get<std::vector<std::string>>();
        manifest.energyCompensation = settings.at("energyCompensation").get<bool>();
        manifest.textureLod = settings.at("textureLod").get<std::string>();
        for (const auto& shader : json.at("shaders")) {
            for (const auto& material : shader.at("materials")) {
                const auto name = material.at("name").get<std::string>();
                if (!name.empty()) {
                    manifest.materialNames[{material.at("scene").get<std::uint32_t>(),
                                            material.at("index").get<std::uint32_t>()}] = name;
                }
            }
        }
        return manifest;
    } catch (const std::exception& error) {
        return unreadable(error.what());
    }
}

}  // namespace glint
