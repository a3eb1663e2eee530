#include "scene_materials.h"

#include <cstring>
#include <iterator>
#include <string>

namespace glint {
namespace {

Diagnostic fault(const MaterialView& view, const char* what) {
    return makeError("scene-material", "material " + std::to_string(view.material), what,
                     "give records of the package's materials, by ascending number, the same at each update");
}

bool hasSize(const MaterialView& view) {
    return view.record.size() == sizeof(gpu::MaterialRecord);
}

// Takes all values except the choice of textures and samplers, their sizes and UV sets.
void takeValues(const MaterialView& view, gpu::MaterialRecord& record) {
    gpu::MaterialRecord given;
    std::memcpy(&given, view.record.data(), sizeof(given));
    for (std::size_t slot = 0; slot < std::size(record.textures); ++slot) {
        const gpu::TextureRecord values = given.textures[slot];
        given.textures[slot] = record.textures[slot];
        given.textures[slot].rowU = values.rowU;
        given.textures[slot].rowV = values.rowV;
    }
    record = given;
}

}  // namespace

Result<std::vector<ChangingMaterial>> replaceMaterials(std::span<const MaterialView> views,
                                                       std::span<gpu::MaterialRecord> records) {
    std::vector<ChangingMaterial> changing;
    for (const MaterialView& view : views) {
        if (view.material >= records.size()) {
            return fault(view, "the package has no such material");
        }
        if (!changing.empty() && changing.back().material >= view.material) {
            return fault(view, "the materials are not sorted, or one is there twice");
        }
        if (!hasSize(view)) {
            return fault(view, "the record has another size than the package's");
        }
        takeValues(view, records[view.material]);
        changing.push_back({view.material, records[view.material]});
    }
    return changing;
}

Status takeMaterials(std::span<const MaterialView> views, std::span<ChangingMaterial> changing) {
    if (views.size() != changing.size()) {
        return makeError("scene-material", "",
                         "the update has " + std::to_string(views.size()) +
                             " materials, the scene was uploaded with " + std::to_string(changing.size()),
                         "give records of the same materials at each update");
    }
    for (std::size_t i = 0; i < views.size(); ++i) {
        if (views[i].material != changing[i].material || !hasSize(views[i])) {
            return fault(views[i],
                         "the update names another material than the upload, or its record has another size");
        }
    }
    for (std::size_t i = 0; i < views.size(); ++i) {
        takeValues(views[i], changing[i].record);
    }
    return okStatus();
}

}  // namespace glint
