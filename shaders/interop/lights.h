// Punctual lights. They are separate from the rest of a scene because they need no device addresses.
#ifndef GLINT_INTEROP_LIGHTS_H
#define GLINT_INTEROP_LIGHTS_H

#include "interop/types.h"

GLINT_INTEROP_BEGIN

// LightRecord::type, in the order of the text of KHR_lights_punctual
GLINT_CONSTANT(kLightDirectional, 0u);
GLINT_CONSTANT(kLightPoint, 1u);
GLINT_CONSTANT(kLightSpot, 2u);

// A punctual light in world space (KHR_lights_punctual).
struct LightRecord {
    vec3 position;   // point and spot
    uint type;       // kLight*
    vec3 direction;  // unit vector along which the light travels; directional and spot
    float range;     // metres; 0 means unlimited
    vec3 intensity;  // colour times intensity: lux (directional) or candela
    float spotScale;   // 1 / max(0.001, cos(inner) - cos(outer))
    float spotOffset;  // -cos(outer) * spotScale
    float size;  // radius, metres; directional: sine of half its angular diameter; 0 for hard shadows
};

GLINT_INTEROP_END
#endif
