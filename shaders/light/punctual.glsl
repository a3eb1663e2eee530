// Punctual lights: KHR_lights_punctual, and disks.
#include "interop/lights.h"
#include "bsdf/constants.glsl"
#include "hit/geometry.glsl"

struct LightSample {
    vec3 direction;  // unit vector, towards the light
    float distance;  // metres; kFarDistance for a directional light
    vec3 irradiance; // on a surface that faces the light
    uint gate;       // kRaySent, or why no light arrives: kRayRange, kRayCone
};

// The least squared distance to a light, in m². It is far below the distance of any surface from a light, and keeps the
// irradiance on one that touches a light, and the importances of the hierarchy (kMaxIntensity), finite.
const float kMinSquaredDistance = 1e-20;

// The inverse square law, windowed to reach 0 at the range (the extension's recommended formula).
float attenuationAt(LightRecord light, float squared, float distance) {
    float attenuation = 1.0 / max(squared, kMinSquaredDistance);
    if (light.range > 0.0) {
        float ratio = min(distance / light.range, 1.0);
        float ratio2 = ratio * ratio;
        attenuation *= 1.0 - ratio2 * ratio2;
    }
    return attenuation;
}

LightSample sampleLight(LightRecord light, vec3 position) {
    if (light.type == kLightDirectional) {
        return LightSample(-light.direction, kFarDistance, light.intensity, kRaySent);
    }
    precise vec3 toLight = light.position - position;
    precise float squared = dot(toLight, toLight);
    precise float distance = sqrt(squared);
    // A light at the point itself lights neither side.
    precise vec3 direction = distance > 0.0 ? toLight / distance : vec3(0.0);
    float attenuation = attenuationAt(light, squared, distance);
    uint gate = attenuation > 0.0 ? kRaySent : kRayRange;
    if (light.type == kLightSpot) {
        float cone = clamp(dot(light.direction, -direction) * light.spotScale + light.spotOffset, 0.0, 1.0);
        attenuation *= cone * cone;
        gate = gate == kRaySent && cone <= 0.0 ? kRayCone : gate;
    }
#if GLINT_DISK_LIGHTS
    if (light.type == kLightDisk) {
        float facing = max(dot(light.direction, -direction), 0.0);
        attenuation *= facing;
        gate = gate == kRaySent && facing <= 0.0 ? kRayCone : gate;
    }
#endif
    return LightSample(direction, distance, light.intensity * attenuation, gate);
}

#if GLINT_DISK_LIGHTS

// The factor of the irradiance at a disk's centre that gives the disk's intensity. `centre` comes from sampleLight(),
// which some light has passed, and its irradiance may have been divided.
float perCentre(LightRecord disk, LightSample centre) {
    float squared = centre.distance * centre.distance;
    return 1.0 / (attenuationAt(disk, squared, centre.distance) * dot(disk.direction, -centre.direction));
}

// Samples a point of a disk uniformly by area. A surface that its centre shines on is on its front, as for all of its
// points.
LightSample sampleDisk(LightRecord light, LightSample centre, vec2 u) {
    if (centre.gate != kRaySent) {
        return centre;
    }
    vec3 tangent;
    vec3 bitangent;
    buildBasis(light.direction, tangent, bitangent);
    precise float radius = light.size * sqrt(u.x);
    precise float phi = 2.0 * kPi * u.y;
    precise vec3 toPoint = centre.distance * centre.direction + radius * (cos(phi) * tangent + sin(phi) * bitangent);
    precise float squared = dot(toPoint, toPoint);
    precise float distance = sqrt(squared);
    precise vec3 direction = toPoint / distance;
    float facing = max(dot(light.direction, -direction), 0.0);
    float part = attenuationAt(light, squared, distance) * facing * perCentre(light, centre);
    return LightSample(direction, distance, centre.irradiance * part, centre.gate);
}

#endif

// Samples a point of an area light: of a disk by area; else uniformly by the solid angle that it fills, of a sphere or
// of a disk infinitely far away. `centre` comes from sampleLight(), and u is uniform in [0, 1)². Shirley, Wang and
// Zimmerman, "Monte Carlo Techniques for Direct Lighting Calculations" (1996). A sphere shines equally in all directions, so on a surface that
// faces its centre its irradiance is that of a light without a size, π sine² times its radiance. The sample's is the
// whole solid angle 2 π height times that radiance. From inside of the sphere nothing can block the light, so the
// distance is 0.
LightSample sampleLightArea(LightRecord light, LightSample centre, vec2 u) {
#if GLINT_DISK_LIGHTS
    if (light.type == kLightDisk) {
        return sampleDisk(light, centre, u);
    }
#endif
    LightSample result = centre;
    bool sphere = light.type != kLightDirectional;
    float sine = sphere ? light.size / max(centre.distance, 1e-18) : light.size;
    if (sine >= 1.0) {
        result.distance = 0.0;
        return result;
    }
    // 1 - cos of the half angle. The plain difference would cancel for the sun.
    precise float height = sine * sine / (1.0 + sqrt(max(1.0 - sine * sine, 0.0)));
    precise float below = u.x * height;
    precise float radius = sqrt(max(below * (2.0 - below), 0.0));
    precise float phi = 2.0 * kPi * u.y;
    vec3 tangent;
    vec3 bitangent;
    buildBasis(centre.direction, tangent, bitangent);
    precise vec3 direction =
        normalize((1.0 - below) * centre.direction + radius * (cos(phi) * tangent + sin(phi) * bitangent));
    result.direction = direction;
    result.irradiance *= 2.0 / (2.0 - height);
    if (sphere) {
        // The distance to the near side of the sphere.
        precise float along = centre.distance * (1.0 - below);
        precise float across = centre.distance * radius;
        precise float distance = along - sqrt(max(light.size * light.size - across * across, 0.0));
        result.distance = distance;
    }
    return result;
}
