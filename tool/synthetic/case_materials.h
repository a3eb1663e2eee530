// The materials of the cases: as many sets of features as wanted, of nearly the same work on average.
#pragma once

#include "plan/material.h"
#include "synthetic/cases_scene.h"

#include <vector>

namespace glint::synthetic {

struct CaseMaterial {
    Material material;
    // Attributes of its primitives, besides positions and texture coordinates.
    bool normals = false;
    bool tangents = false;
    bool colors = false;
};

// Eight switches make 256 sets; those with half of them come first, and each set is followed by the one that
// has what it lacks. So any even number of cases has each switch in half of them, and work does not grow
// with cases.
std::vector<CaseMaterial> makeCaseMaterials(Cost cost, int count);

// One of the same key whose lobes and textures are there and change next to nothing: a mirror, or a white
// surface that scatters.
CaseMaterial makeFloorMaterial(const CaseMaterial& like, Coherence coherence);

}  // namespace glint::synthetic
