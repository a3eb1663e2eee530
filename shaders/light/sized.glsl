// Area lights among the punctual lights, which rays of lobes find, too. Samples of the light and these rays share its
// light by the balance heuristic, as in light/shared.glsl. The code that draws a direction of a lobe also finds the
// lights that it meets, and sends a shadow ray there. So both see the same surfaces, and no data waits in memory for
// the end of the lobe's ray.
#include "host/lights.glsl"

#if GLINT_SIZED_LIGHTS

#if GLINT_LIGHT_SAMPLES > 0
#include "light/search.glsl"

// Returns whether rays of lobes find the light: it has a size.
bool lobesFind(HostLight light) {
    return light.emitter == kNoEmitter && GLINT_PUNCTUAL(light).size > 0.0;
}

// The lights of a search by their numbers. Only a surface that takes samples needs their SceneLight::chance.
#define GLINT_EACH_LIGHT(number, search) for (uint number; findsLeaf(search, number);)

HostLight lightToFind(uint number) {
    return lightOfScene(GLINT_FRAME.lightNodes.data[number].next & ~kLightLeaf);
}

#else

// Returns whether rays of lobes find the light: it has a size, and every surface takes it.
bool lobesFind(HostLight light) {
    return light.emitter == kNoEmitter && light.chance == 1.0 && GLINT_PUNCTUAL(light).size > 0.0;
}

// The search visits all lights: it is their number.
#define LightSearch uint
#define GLINT_EACH_LIGHT(number, search) for (uint number = 0u; number < search; ++number)

HostLight lightToFind(uint number) {
    return lightOfScene(number);
}

#endif

// The lights that a ray may meet before the distance `end`; none unless it `looks` for them.
LightSearch lightsOnRay(vec3 origin, vec3 direction, float end, bool looks) {
#if GLINT_LIGHT_SAMPLES > 0
    return searchLeaves(origin, direction, end, looks);
#else
    return looks ? GLINT_FRAME.lightCount : 0u;
#endif
}

// 1 - the cosine of half the angle that a sphere or the sun fills; 0 from within it.
float seenHeight(HostLight light, LightSample centre) {
    LightRecord punctual = GLINT_PUNCTUAL(light);
    precise float sine = punctual.type != kLightDirectional ? punctual.size / max(centre.distance, 1e-18)
                                                            : punctual.size;
    precise float height = sine * sine / (1.0 + sqrt(max(1.0 - sine * sine, 0.0)));
    return sine < 1.0 ? height : 0.0;
}

#if GLINT_DISK_LIGHTS

// A point of the plane of a disk, along a direction.
struct DiskPoint {
    float distance;  // metres; 0 if the direction does not meet the plane from its front
    float facing;    // cosine between the disk's normal and the way to the surface
    bool isInside;   // of the disk
};

DiskPoint diskPointAlong(LightRecord disk, LightSample centre, vec3 direction) {
    precise vec3 toCentre = centre.distance * centre.direction;
    precise float facing = -dot(disk.direction, direction);
    precise float above = -dot(disk.direction, toCentre);
    DiskPoint point = DiskPoint(0.0, facing, false);
    if (facing > 0.0 && above > 0.0) {
        precise float distance = above / facing;
        precise vec3 offset = distance * direction - toCentre;
        point.distance = distance;
        point.isInside = dot(offset, offset) <= disk.size * disk.size;
    }
    return point;
}

#endif

// The density, by solid angle, of the point in that direction that hostSampleLightPoint() gives, for all samples of the
// light that a surface expects to take; 0 from within the light.
float lightPointDensity(HostLight light, LightSample centre, vec3 direction) {
    LightRecord punctual = GLINT_PUNCTUAL(light);
    float density;
#if GLINT_DISK_LIGHTS
    if (punctual.type == kLightDisk) {
        DiskPoint point = diskPointAlong(punctual, centre, direction);
        density = point.distance > 0.0 ? point.distance * point.distance /
                                             (kPi * punctual.size * punctual.size * point.facing)
                                       : 0.0;
    } else
#endif
    {
        float height = seenHeight(light, centre);
        density = height > 0.0 ? 1.0 / (2.0 * kPi * height) : 0.0;
    }
#if GLINT_LIGHT_SAMPLES > 0
    return light.chance * density;
#else
    return density;
#endif
}

// The point of a light that a direction meets, with its radiance in the place of the irradiance. It is black if the
// direction passes the light.
LightSample lightAlong(HostLight light, LightSample centre, vec3 direction) {
    LightSample point = LightSample(direction, centre.distance, vec3(0.0), centre.gate);
#if GLINT_DISK_LIGHTS
    if (GLINT_PUNCTUAL(light).type == kLightDisk) {
        LightRecord disk = GLINT_PUNCTUAL(light);
        DiskPoint met = diskPointAlong(disk, centre, direction);
        if (met.isInside && centre.gate == kRaySent) {
            precise float squared = met.distance * met.distance;
            point.distance = met.distance;
            // Without the inverse square, of which the radiance knows nothing.
            float part = attenuationAt(disk, squared, met.distance) * squared * perCentre(disk, centre);
            point.irradiance = centre.irradiance * (part / (kPi * disk.size * disk.size));
        }
        return point;
    }
#endif
    float height = seenHeight(light, centre);
    // Half of the squared chord is 1 - cosine, and keeps the digits of a small sun.
    precise vec3 chord = direction - centre.direction;
    precise float below = 0.5 * dot(chord, chord);
    if (below >= height || centre.gate != kRaySent) {
        return point;
    }
    point.irradiance = centre.irradiance / (kPi * height * (2.0 - height));
    LightRecord punctual = GLINT_PUNCTUAL(light);
    if (punctual.type != kLightDirectional) {
        precise float along = centre.distance * (1.0 - below);
        precise float across2 = centre.distance * centre.distance * below * (2.0 - below);
        precise float distance = along - sqrt(max(punctual.size * punctual.size - across2, 0.0));
        point.distance = distance;
    }
    return point;
}

#endif
