#include "host/resources.glsl"

MaterialArray hostMaterials() {
    return MaterialArray(glintHostMaterials());
}

float frameTime() {
    return glintHostTime();
}
