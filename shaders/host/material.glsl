// Where the records of materials are.
#include "host/resources.glsl"

// Returns the address of the records. That of a geometry's material is at its materialIndex.
MaterialArray hostMaterials() {
    return GLINT_FRAME.materials;
}

// The record of the material of a Hit or a SurfacePoint.
#define GLINT_MATERIAL(hit) hostMaterials().data[(hit).material]

// The seconds that materials may follow.
float frameTime() {
    return GLINT_FRAME.time;
}
