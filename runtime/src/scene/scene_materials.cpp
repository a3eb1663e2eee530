#include "scene/scene_materials.h"

#include "scene/material_table.h"

#include <algorithm>
#include <cstring>
#include <string>

namespace glint {
namespace {

Diagnostic fault(const MaterialView& view, const char* what) {
    return makeError("scene-material", "material " + std::to_string(view.material), what,
                     "give records of the package's materials, by ascending number, the same at each update");
}

}  // namespace

void takeValues(std::span<const std::uint8_t> values, const MaterialTable& table,
                std::span<std::uint8_t> record) {
    std::vector<std::uint8_t> taken(values.begin(), values.end());
    const MaterialTable given{values, table.recordBytes, table.textureOffset, table.textureCount};
    const MaterialTable kept{record, table.recordBytes, table.textureOffset, table.textureCount};
    for (std::uint32_t slot = 0; slot < table.textureCount; ++slot) {
        const gpu::TextureRecord wanted = textureAt(given, 0, slot);
        gpu::TextureRecord texture = textureAt(kept, 0, slot);
        texture.rowU = wanted.rowU;
        texture.rowV = wanted.rowV;
        std::memcpy(&taken[placeOfTexture(given, 0, slot)], &texture, sizeof texture);
    }
    std::ranges::copy(taken, record.begin());
}

Result<std::vector<ChangingMaterial>> replaceMaterials(std::span<const MaterialView> views,
                                                       const MaterialTable& table,
                                                       std::span<std::uint8_t> records) {
    std::vector<ChangingMaterial> changing;
    for (const MaterialView& view : views) {
        if (view.material >= table.size()) {
            return fault(view, "the package has no such material");
        }
        if (!changing.empty() && changing.back().material >= view.material) {
            return fault(view, "the materials are not sorted, or one is there twice");
        }
        if (view.record.size() != table.recordBytes) {
            return fault(view, "the record has another size than the package's");
        }
        const std::span<std::uint8_t> record =
            records.subspan(std::size_t{view.material} * table.recordBytes, table.recordBytes);
        takeValues(view.record, table, record);
        changing.push_back({view.material, {record.begin(), record.end()}});
    }
    return changing;
}

Status takeMaterials(std::span<const MaterialView> views, const MaterialTable& table,
                     std::span<ChangingMaterial> changing) {
    if (views.size() != changing.size()) {
        return makeError("scene-material", "",
                         "the update has " + std::to_string(views.size()) +
                             " materials, the scene was uploaded with " + std::to_string(changing.size()),
                         "give records of the same materials at each update");
    }
    for (std::size_t i = 0; i < views.size(); ++i) {
        if (views[i].material != changing[i].material || views[i].record.size() != table.recordBytes) {
            return fault(views[i],
                         "the update names another material than the upload, or its record has another size");
        }
    }
    for (std::size_t i = 0; i < views.size(); ++i) {
        takeValues(views[i].record, table, changing[i].record);
    }
    return okStatus();
}

}  // namespace glint
