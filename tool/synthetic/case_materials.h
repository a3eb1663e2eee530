// The materials of the cases: as many sets of features as wanted, with nearly the same work on average.
#pragma once

#include "materials/material.h"
#include "synthetic/cases_scene.h"

#include <vector>

namespace glint::synthetic {

struct CaseMaterial {
    materials::Material material;
    // The attributes of its primitives, besides positions and texture coordinates.
    bool normals = false;
    bool tangents = false;
    bool colors = false;
};

// Returns `count` materials. Eight switches make 256 sets. Sets with half of the switches come first, and
// each set is followed by the set that has exactly the other switches. So any even number of cases has each
// switch in half of them, and the average work does not grow with the number of cases.
std::vector<CaseMaterial> makeCaseMaterials(Cost cost, int count);

// Returns a material with the same key whose lobes and textures change next to nothing: a mirror, or a white
// surface that scatters.
CaseMaterial makeFloorMaterial(const CaseMaterial& like, Coherence coherence);

}  // namespace glint::synthetic
