// Punctual lights with a size that rays of lobes find, too. Samples of the light and these rays share its light by the
// balance heuristic, as in light/shared.glsl. Whoever draws a direction of a lobe asks which lights it meets, and sends
// a shadow ray there. So both see the same, and nothing of it waits in memory for the ray's own end.
#include "host/lights.glsl"

#if GLINT_SIZED_LIGHTS

// Returns whether rays of lobes find the light: it has a size, and every surface takes it.
bool lobesFind(HostLight light) {
    return light.emitter == kNoEmitter && light.chance == 1.0 && GLINT_PUNCTUAL(light).size > 0.0;
}

// The lights among which lightToFind() has all that rays of lobes find.
uint lightsToFind() {
#if GLINT_LIGHT_SAMPLES > 0
    return GLINT_FRAME.lightsApart;
#else
    return GLINT_FRAME.lightCount;
#endif
}

HostLight lightToFind(uint number) {
#if GLINT_LIGHT_SAMPLES > 0
    return lightApart(number);
#else
    return lightOfScene(number);
#endif
}

// 1 - the cosine of half the angle that the light fills; 0 from within it.
float seenHeight(HostLight light, LightSample centre) {
    LightRecord punctual = GLINT_PUNCTUAL(light);
    precise float sine = punctual.type != kLightDirectional ? punctual.size / max(centre.distance, 1e-18)
                                                            : punctual.size;
    precise float height = sine * sine / (1.0 + sqrt(max(1.0 - sine * sine, 0.0)));
    return sine < 1.0 ? height : 0.0;
}

// The density, by solid angle, of a point that hostSampleLightPoint() gives; 0 from within the light.
float lightPointDensity(HostLight light, LightSample centre) {
    float height = seenHeight(light, centre);
    return height > 0.0 ? 1.0 / (2.0 * kPi * height) : 0.0;
}

// The point of a light that a direction meets, with its radiance in the place of the irradiance. It is black if the
// direction passes the light.
LightSample lightAlong(HostLight light, LightSample centre, vec3 direction) {
    LightSample point = LightSample(direction, centre.distance, vec3(0.0), centre.gate);
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
