// A tiny textured scene whose materials a test chooses.
#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace glint::testing {

// The lobes of each material, such as "clearcoat" and "sheen"; "textured" gives it a base colour texture.
using Lobes = std::vector<std::vector<std::string>>;

inline const Lobes kFourLobes{{}, {"clearcoat"}, {"sheen"}, {"textured"}};

// Writes scene.gltf, scene.bin and base.png into `folder`, which is created: a material and a quad for each
// of `lobes`. `red` is the first material's base colour.
std::filesystem::path writeManyKeys(const std::filesystem::path& folder, const Lobes& lobes = kFourLobes,
                                    double red = 0.5);

// Writes base.png with two colours, one of which has this red.
void writeBaseTexture(const std::filesystem::path& folder, std::uint8_t red);

// Returns names and bytes of all files below `folder`.
std::vector<std::pair<std::string, std::string>> contentsOf(const std::filesystem::path& folder);

}  // namespace glint::testing
