// Imports bytes as the glTF file that they may be, and plans what comes of it.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace glint::fuzz {

// `name`: of the file, "scene.gltf" or "scene.glb". Ends the process where a promise of the importer or of
// the planner is broken.
void importBytes(std::span<const std::uint8_t> bytes, std::string_view name);

}  // namespace glint::fuzz
