// Material values of the host that replace the package's.
#pragma once

#include <glint/package.h>
#include <glint/result.h>
#include <glint/scene_view.h>

#include <cstdint>
#include <span>
#include <vector>

namespace glint {

// A material of SceneView::materials with its values on the device.
struct ChangingMaterial {
    std::uint32_t material = 0;
    std::vector<std::uint8_t> record;
};

// Takes all values except the choice of textures and samplers, their sizes and UV sets. `values` and `record`
// are records of the layout of `table`, whose own records are not read.
void takeValues(std::span<const std::uint8_t> values, const MaterialTable& table,
                std::span<std::uint8_t> record);

// Writes the values of `views` into the records that they name; `records` has the bytes of `table`, which
// gives their layout. Each record keeps its textures and samplers, which the host can't name. Error
// "scene-material": a material does not exist, is out of order or has another size.
Result<std::vector<ChangingMaterial>> replaceMaterials(std::span<const MaterialView> views,
                                                       const MaterialTable& table,
                                                       std::span<std::uint8_t> records);

// Takes the values of an update, which must name the same materials. On error "scene-material", `changing`
// stays as it was.
Status takeMaterials(std::span<const MaterialView> views, const MaterialTable& table,
                     std::span<ChangingMaterial> changing);

}  // namespace glint
