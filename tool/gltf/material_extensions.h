// Reads the factors of KHR_materials_*. materials.cpp reads their textures together with all others.
#pragma once

#include "gltf/document.h"
#include "plan/material.h"

#include <string>

namespace glint::gltf {

// Reads every extension that Glint shades, and lists the others in Material::unsupportedExtensions. Values
// out of range are clamped with the warning "material-range". `json` is the material at `pointer`.
void readMaterialExtensions(Document& document, const Json& json, const std::string& pointer,
                            Material& material);

}  // namespace glint::gltf
