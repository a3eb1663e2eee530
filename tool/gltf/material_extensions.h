// The factors of KHR_materials_*; their textures are read with the others (materials.cpp).
#pragma once

#include "gltf/document.h"
#include "plan/material.h"

#include <string>

namespace glint::gltf {

// Reads every extension that Glint shades, and names the others in Material::unsupportedExtensions. Values
// that are out of range are clamped with the warning "material-range". `json` is the material at `pointer`.
void readMaterialExtensions(Document& document, const Json& json, const std::string& pointer,
                            Material& material);

}  // namespace glint::gltf
