#include "host/resources.glsl"

float hostRandom(uint target, uint dimension) {
    return glintHostRandom(target, dimension);
}
