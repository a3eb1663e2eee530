// The materials that are compared, as a file would hold them.
#pragma once

#include "oracle/spec/material.h"

#include <string>
#include <vector>

namespace glint::spec {

struct Row {
    std::string group;  // "base", "partial metal", "lobe", "pair", "texture", "normal map"
    std::string name;
    Json material;
    // Nothing absorbs light: the base is white, and so is every layer. What single scattering loses is
    // another matter.
    bool white = false;
    bool quick = false;  // in the short list that every build compares
    // A closed sphere of the material is compared too, in a white furnace.
    bool sphere = false;
};

struct Rows {
    std::vector<Row> rows;
    std::vector<Texel> texels;  // texture i of the scene
};

// Every lobe alone, every pair of lobes that the extensions let combine, metallic from 0 to 1, roughness from
// 0 to 1, every kind of texture, normal maps.
Rows allRows();

}  // namespace glint::spec
