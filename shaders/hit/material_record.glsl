// What code of features asks of the host at every stage.
#include "host/material.glsl"

// The record of the material of a Hit or a SurfacePoint.
#define GLINT_MATERIAL(hit) hostMaterials().data[(hit).material]

// Returns the seconds that materials may follow.
float frameTime() {
    return hostTime();
}
