#include "host/resources.glsl"

MaterialArray hostMaterials() {
    return MaterialArray(glintHostMaterials());
}

#define GLINT_MATERIAL(hit) hostMaterials().data[(hit).material]

float frameTime() {
    return glintHostTime();
}
