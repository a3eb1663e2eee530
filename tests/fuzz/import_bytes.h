// Imports bytes as a glTF file, and plans the resulting scene.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace glint::fuzz {

// `name` is the file's name, "scene.gltf" or "scene.glb". Ends the process if a promise of the importer or of
// the planner is broken.
void importBytes(std::span<const std::uint8_t> bytes, std::string_view name);

}  // namespace glint::fuzz
