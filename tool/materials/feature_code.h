// Reads the member "glsl" of declarations: the GLSL of a feature, and when it runs.
#pragma once

#include "materials/declaration_json.h"
#include "materials/material_model.h"

#include <string>
#include <string_view>
#include <vector>

namespace glint::materials {

struct DeclaredCode {
    FeatureCode code;
    std::vector<std::string> after;  // names of declarations whose code runs before
    std::string where;               // of the member "glsl"
};

// Reads "glsl" of the declaration in `file`, whose own feature is `feature` or -1. Throws DeclarationFault.
DeclaredCode readFeatureCode(const Members& declaration, std::string_view file, int feature);

// Orders the code so that each item comes after those that it names, and by name otherwise. Throws
// DeclarationFault if a name is unknown, or if two wait for each other.
std::vector<FeatureCode> orderCode(std::vector<DeclaredCode> code);

}  // namespace glint::materials
