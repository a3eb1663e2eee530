// Values of materials that the host gives in the place of the package's.
#pragma once

#include "interop/scene.h"

#include <glint/result.h>
#include <glint/scene_view.h>

#include <cstdint>
#include <span>
#include <vector>

namespace glint {

// A material of SceneView::materials, as the device has it.
struct ChangingMaterial {
    std::uint32_t material = 0;
    gpu::MaterialRecord record{};
};

// Puts the values of `views` into the records that they name. Each record keeps its textures and samplers,
// which the host can't name. Error "scene-material": a material that is not there, out of order, or of
// another size.
Result<std::vector<ChangingMaterial>> replaceMaterials(std::span<const MaterialView> views,
                                                       std::span<gpu::MaterialRecord> records);

// The values of an update, which must name the same materials. Error "scene-material"; `changing` then stays.
Status takeMaterials(std::span<const MaterialView> views, std::span<ChangingMaterial> changing);

}  // namespace glint
