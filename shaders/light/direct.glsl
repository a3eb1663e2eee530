// The light of every light on a surface that the camera sees.
#include "effects/sky_shares.glsl"
#include "hit/shade.glsl"
#include "light/sized.glsl"

#if GLINT_SHARED_LIGHTS

// A density of samples so high that rays count for nothing.
const float kWholeDensity = 1e30;

// Leaves the lobes for which no ray of an effect brings the light of a sample, in parts. `density` is that of samples.
void keepLobesOfLight(Features features, HostLight light, vec3 direction, float density, SkyShares sky,
                      inout Surface surface) {
    SkyShares shares = sky;
    shareWithEffects(surface, features, toSurface(surface, direction), density, shares);
#if GLINT_SKY_LIGHT
    if (light.emitter == kSkyEmitter) {
        shares = sampledShares(surface, features, shares, sky);
    }
#endif
    keepShares(features, shares, surface);
}

#endif

#if GLINT_SIZED_LIGHTS

// The density, by solid angle, of the samples of a light that rays of lobes find, too; 0 for other lights.
float densityOfPoints(HostLight light, LightSample centre, vec3 direction, uint points) {
    return lobesFind(light) ? float(points) * lightPointDensity(light, centre, direction) : 0.0;
}

// Returns the point of the light that the ray of an effect meets, with the light that it brings to the viewer.
// The surface takes `points` samples of the light.
LightSample foundPoint(HostLight light, LightSample centre, uint slot, uint points) {
#if GLINT_RAY_EFFECTS > 0
    FindingRay ray = findingRays[slot];
    LightSample point = lightAlong(light, centre, ray.direction);
    float density = densityOfPoints(light, centre, ray.direction, points);
    point.irradiance *= ray.weight * (ray.density > 0.0 ? ray.density / (ray.density + density) : 1.0);
    return point;
#else
    return centre;
#endif
}

#endif

#if GLINT_SHADES_ALL

// A model that shades all lights at once needs the sum of their light before any shadow ray leaves: directLight() goes
// over the lights twice.
bool sumsLight = false;      // in the first turn: all light arrives
float wholeLuminance = 0.0;  // of the sum; 0 if each light counts by itself
vec3 wholeLight;             // that the model makes of the sum

// Returns the part of the whole light that `light` stands for.
vec3 partOfWhole(vec3 light) {
    return wholeLuminance > 0.0 ? luminance(light) / wholeLuminance * wholeLight : light;
}

#else

vec3 partOfWhole(vec3 light) {
    return light;
}

#endif

#if GLINT_EFFECT_SHADOW

vec3 sendLight(Hit hit, SurfaceShadow ray, inout ShadowCounts counts) {
#if GLINT_SHADES_ALL
    if (sumsLight) {
        return ray.light;
    }
#if GLINT_EMISSIVE_LIGHTS && GLINT_SHADOW_GLASS
    ray.pastGlass = partOfWhole(ray.pastGlass);
#endif
#endif
    ray.light = partOfWhole(ray.light);
    return sendShadow(hit, ray, counts);
}

#endif

#if GLINT_SIZED_LIGHTS && GLINT_LIGHT_SAMPLES > 0 && GLINT_RAY_EFFECTS > 0

// The light of all lights that the rays of effects meet, as far as it is known.
vec3 foundLight(Hit hit, Features features, inout ShadowCounts counts) {
    vec3 sum = vec3(0.0);
    LightReceiver receiver = receiverOf(hit, features);
    for (uint slot = 0u; slot < GLINT_RAY_EFFECTS; ++slot) {
        LightSearch search = lightsOnRay(hit.position, findingRays[slot].direction, 2.0 * kFarDistance,
                                         findingRays[slot].weight != vec3(0.0));
        GLINT_EACH_LIGHT(leaf, search) {
            HostLight light = lightToFind(leaf);
            LightSample centre = hostSampleLight(light, hit.position);
            if (lightAlong(light, centre, findingRays[slot].direction).irradiance != vec3(0.0)) {
                light.chance = leafChance(receiver, leaf);
                LightSample point = foundPoint(light, centre, slot, lightPointCount(light));
                sum += sendLight(
                    hit, surfaceShadow(point.direction, point.distance, point.irradiance, kShadowOfLight), counts);
            }
        }
    }
    return sum;
}

#endif

#if GLINT_EFFECT_SHADOW

// The light of all lights as far as it is known. traceWaiting() returns the rest.
vec3 lightOfEach(Hit hit, Surface surface, Features features, SkyShares sky, inout ShadowCounts counts) {
    vec3 sum = vec3(0.0);
    uint lights = hostLightCount(hit.position);
    for (uint i = 0u; i < lights; ++i) {
        HostLight light = lightOfHost(hit, features, i);
        LightSample centre;
        uint points = 1u;
        uint sees = kShadowOfLight;
#if GLINT_SHARED_LIGHTS
        bool shares = isShared(light);
        SharedSample drawn;
        if (shares) {
            drawn = sampleShared(hit, light, i, 0u);
            if (drawn.density <= 0.0) {
                continue;
            }
            centre = aimAtShared(hit, light, drawn);
            centre.irradiance = centre.distance > 0.0 ? drawn.radiance / drawn.density : vec3(0.0);
            sees = passesAsLight(light.emitter) ? kShadowOfLight : kShadowOfShared;
        } else
#endif
        {
            centre = hostSampleLight(light, hit.position);
            if (!passesGate(centre, counts)) {
                continue;
            }
            points = lightPointCount(light);
            centre.irradiance /= float(points);
        }
#if GLINT_SIZED_LIGHTS && GLINT_LIGHT_SAMPLES == 0
        uint found = !shares && lobesFind(light) ? GLINT_RAY_EFFECTS : 0u;
        for (uint j = 0u; j < found; ++j) {
            LightSample point = foundPoint(light, centre, j, points);
            if (point.irradiance != vec3(0.0)) {
                vec3 arriving = float(points) * point.irradiance;
                sum += sendLight(hit, surfaceShadow(point.direction, point.distance, arriving, sees), counts);
            }
        }
#endif
        for (uint j = 0u; j < points; ++j) {
            // All kinds of lights share one evaluation of the BSDF, which is most of the code.
#if GLINT_SHARED_LIGHTS
            Surface lit = surface;
            LightSample point = centre;
            vec3 direction;
            if (shares) {
                keepLobesOfLight(features, light, drawn.direction, drawn.density, sky, lit);
                direction = drawn.direction;
            } else {
                point = lightPoint(hit, light, centre, i, j);
                direction = point.direction;
#if GLINT_SIZED_LIGHTS
                float density = densityOfPoints(light, centre, direction, points);
                if (density > 0.0) {
                    keepLobesOfLight(features, light, direction, density, sky, lit);
                }
#endif
            }
            vec3 scattered = scatteredLight(lit, features, hit.geometricNormal, direction) * point.irradiance;
#else
            LightSample point = lightPoint(hit, light, centre, i, j);
            vec3 scattered = unshadowedLight(hit, surface, features, point);
#endif
            if (luminance(scattered) <= 0.0) {
                counts.facing += 1u;
            } else if (point.distance <= 0.0) {
                sum += partOfWhole(scattered);  // nothing is between the surface and a light around it
            } else {
                SurfaceShadow shadow = surfaceShadow(point.direction, point.distance, scattered, sees);
#if GLINT_EMISSIVE_LIGHTS && GLINT_SHADOW_GLASS
                if (shares && light.emitter != kSkyEmitter) {
                    // Rays of effects bring none of the light of emissive triangles behind glass.
                    Surface whole = surface;
                    keepLobesOfLight(features, light, direction, kWholeDensity, sky, whole);
                    shadow.pastGlass =
                        scatteredLight(whole, features, hit.geometricNormal, direction) * point.irradiance;
                }
#endif
                sum += sendLight(hit, shadow, counts);
            }
        }
    }
#if GLINT_SIZED_LIGHTS && GLINT_LIGHT_SAMPLES > 0 && GLINT_RAY_EFFECTS > 0
    sum += foundLight(hit, features, counts);
#endif
    return sum;
}

vec3 directLight(Hit hit, Surface surface, Features features, SkyShares sky, inout ShadowCounts counts) {
#if GLINT_SHADES_ALL
    vec3 sum;
    for (uint turn = shadesAll(features) ? 0u : 1u; turn < 2u; ++turn) {
        sumsLight = turn == 0u;
        ShadowCounts counted = counts;
        sum = lightOfEach(hit, surface, features, sky, counted);
        if (sumsLight) {
            wholeLuminance = luminance(sum);
            wholeLight = shadeAll(surface.bsdf.layers, features, surface.bsdf.view, sum);
        } else {
            counts = counted;
        }
    }
    return sum;
#else
    return lightOfEach(hit, surface, features, sky, counts);
#endif
}

#else

vec3 directLight(Hit hit, Surface surface, Features features) {
    vec3 sum = vec3(0.0);
    uint lights = hostLightCount(hit.position);
    for (uint i = 0u; i < lights; ++i) {
        LightSample light = hostSampleLight(lightOfHost(hit, features, i), hit.position);
        vec3 scattered = unshadowedLight(hit, surface, features, light);
        sum += luminance(scattered) > 0.0 ? scattered : vec3(0.0);
    }
#if GLINT_SHADES_ALL
    sum = shadeAll(surface.bsdf.layers, features, surface.bsdf.view, sum);
#endif
    return sum;
}

#endif
