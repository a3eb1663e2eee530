#include "host/resources.glsl"

MaterialArray hostMaterials() {
    return MaterialArray(glintHostMaterials());
}

float hostTime() {
    return glintHostTime();
}
