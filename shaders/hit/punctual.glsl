// Punctual lights: KHR_lights_punctual.
#include "interop/lights.h"
#include "hit/constants.glsl"

struct LightSample {
    vec3 direction;  // unit, towards the light
    float distance;  // metres; kFarDistance for a directional light
    vec3 irradiance; // on a surface that faces the light
};

// Squared distance to a light is at least 1 mm²: bounds the irradiance on a surface that touches a light.
const float kMinSquaredDistance = 1e-6;

LightSample sampleLight(LightRecord light, vec3 position) {
    if (light.type == kLightDirectional) {
        return LightSample(-light.direction, kFarDistance, light.intensity);
    }
    precise vec3 toLight = light.position - position;
    precise float squared = dot(toLight, toLight);
    precise float distance = sqrt(squared);
    // A light at the point itself lights no side of it.
    precise vec3 direction = squared > 0.0 ? toLight / distance : vec3(0.0);
    // Inverse square law, windowed to reach 0 at the range (the extension's recommended formula).
    float attenuation = 1.0 / max(squared, kMinSquaredDistance);
    if (light.range > 0.0) {
        float ratio = distance / light.range;
        float ratio2 = ratio * ratio;
        attenuation *= clamp(1.0 - ratio2 * ratio2, 0.0, 1.0);
    }
    if (light.type == kLightSpot) {
        float cone = clamp(dot(light.direction, -direction) * light.spotScale + light.spotOffset, 0.0, 1.0);
        attenuation *= cone * cone;
    }
    return LightSample(direction, distance, light.intensity * attenuation);
}
