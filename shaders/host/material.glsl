// The place of materials' records, and the time that these may follow.
#include "host/resources.glsl"

// Returns the address of the records. That of a geometry's material is at its materialIndex.
MaterialArray hostMaterials() {
    return GLINT_FRAME.materials;
}

// The seconds that materials may follow.
float hostTime() {
    return GLINT_FRAME.time;
}
