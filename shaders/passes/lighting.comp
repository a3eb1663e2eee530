#version 460
// Lighting of the primary surfaces: materials, every punctual light, the sky. It also makes the samples of the effects.
#define GLINT_MODULE_ALWAYS_LOBES GLINT_ALWAYS_LOBES
#define GLINT_MODULE_ALWAYS_INPUTS GLINT_ALWAYS_INPUTS
#define GLINT_MODULE_ANY_LOBES (GLINT_ALWAYS_LOBES | GLINT_SOMETIMES_LOBES)
#define GLINT_MODULE_ANY_INPUTS (GLINT_ALWAYS_INPUTS | GLINT_SOMETIMES_INPUTS)
#include "generated/effects.glsl"
#include "hit/images.glsl"
#include "hit/primary.glsl"
#include "hit/shade.glsl"
#include "hit/stage.glsl"
#include "light/sized.glsl"
#include "passes/primary_surface.glsl"
#if GLINT_SURFACE_LAYERS
#include "generated/surface_layers.glsl"
#endif

GLINT_PIXEL_WORKGROUP

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
    keepShares(shares, surface);
}

#endif

#if GLINT_SIZED_LIGHTS

// The density, by solid angle, of the samples of a light that rays of lobes find, too; 0 for other lights.
float densityOfPoints(HostLight light, LightSample centre, uint points) {
    return lobesFind(light) ? float(points) * lightPointDensity(light, centre) : 0.0;
}

// Returns the point of the light that the ray of an effect meets, with the light that it brings to the viewer.
LightSample foundPoint(HostLight light, LightSample centre, uint slot, float density) {
#if GLINT_RAY_EFFECTS > 0
    FindingRay ray = findingRays[slot];
    LightSample point = lightAlong(light, centre, ray.direction);
    point.irradiance *= ray.weight * (ray.density > 0.0 ? ray.density / (ray.density + density) : 1.0);
    return point;
#else
    return centre;
#endif
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
                float density = densityOfPoints(light, centre, lightPointCount(light));
                LightSample point = foundPoint(light, centre, slot, density);
                sum += sendShadow(
                    hit, surfaceShadow(point.direction, point.distance, point.irradiance, kShadowOfLight), counts);
            }
        }
    }
    return sum;
}

#endif

#if GLINT_EFFECT_SHADOW

// The light of all lights as far as it is known. traceWaiting() returns the rest.
vec3 directLight(Hit hit, Surface surface, Features features, SkyShares sky, inout ShadowCounts counts) {
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
#if GLINT_SIZED_LIGHTS
        float density = shares ? 0.0 : densityOfPoints(light, centre, points);
#endif
#if GLINT_SIZED_LIGHTS && GLINT_LIGHT_SAMPLES == 0
        uint found = density > 0.0 ? GLINT_RAY_EFFECTS : 0u;
        for (uint j = 0u; j < found; ++j) {
            LightSample point = foundPoint(light, centre, j, density);
            if (point.irradiance != vec3(0.0)) {
                vec3 arriving = float(points) * point.irradiance;
                sum += sendShadow(hit, surfaceShadow(point.direction, point.distance, arriving, sees), counts);
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
                sum += scattered;  // nothing is between the surface and a light around it
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
                sum += sendShadow(hit, shadow, counts);
            }
        }
    }
#if GLINT_SIZED_LIGHTS && GLINT_LIGHT_SAMPLES > 0 && GLINT_RAY_EFFECTS > 0
    sum += foundLight(hit, features, counts);
#endif
    return sum;
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
    return sum;
}

#endif

// The light that a lit surface scatters, without its emission. `sky` holds the remaining shares of the sky's light.
vec3 scatteredBy(Hit hit, Surface surface, Features features, SkyShares sky) {
#if GLINT_EFFECT_SHADOW
    ShadowCounts counts = ShadowCounts(0u, 0u, 0u, 0u, 0u);
    vec3 direct = directLight(hit, surface, features, sky, counts);
    vec3 ambient = ambientLight(surface, features, hit.view, sky);
    direct += traceWaiting(hit, counts);
    reportShadows(counts);
    return direct + ambient;
#else
    return directLight(hit, surface, features) + ambientLight(surface, features, hit.view, sky);
#endif
}

void main() {
    uvec2 pixel = GLINT_PIXEL_OF_THREAD;
    if (pixel.x >= GLINT_FRAME.width || pixel.y >= GLINT_FRAME.endRow) {
        return;
    }
    ivec2 place = ivec2(pixel);
#if GLINT_TALLIES
    beginTallies(pixel);
#endif
    GLINT_CLOCK_START
    uint number = pixel.x + pixel.y * GLINT_FRAME.width;
    uvec2 surfaceId = imageLoad(surfaceImage, place).xy;
    CameraRay ray = cameraRay(pixel);
    vec4 radianceDepth = vec4(hostSky(ray.direction), 0.0);
    vec4 position = vec4(0.0);

    if (surfaceId.x == kNoSurface) {
        skipEffects(number, kRayNoSurface);
#if GLINT_SURFACE_LAYERS
        storeSkyLayers(place, ray.direction, radianceDepth.rgb);
#endif
    } else {
        HostGeometry geometry = hostGeometry(surfaceId.x);
        Features features = GLINT_PRIMARY_FEATURES(geometry);
        Hit hit = primaryHit(geometry, surfaceId.y, ray, number, features);
        vec3 origin = rayOrigin(hit, hit.geometricNormal);
        position = vec4(origin, uintBitsToFloat(packSnorm2x16(octahedralEncode(hit.geometricNormal))));
        radianceDepth.w = dot(hit.position - GLINT_FRAME.cameraPosition, GLINT_FRAME.cameraForward);
        Surface surface = surfaceOfPrimary(hit, features.lobes, features.inputs);
#if GLINT_SURFACE_LAYERS
        vec3 direct = vec3(0.0);
#endif
        if (hasLobe(features, GLINT_UNLIT)) {
            radianceDepth.rgb = surface.emission;
            skipEffects(number, kRayUnlit);
        } else {
            SkyShares sky = wholeSky();
            sampleEffects(hit, surface, features, sky);
            vec3 emission = surface.emission;
            vec3 scattered = scatteredBy(hit, surface, features, sky);
            radianceDepth.rgb = emission + scattered;
#if GLINT_SURFACE_LAYERS
            direct = scattered;
#endif
        }
#if GLINT_SURFACE_LAYERS
        storeSurfaceLayers(PrimaryPoint(place, geometry, surfaceId.x, surfaceId.y, ray, hit, surface, features,
                                        !hasLobe(features, GLINT_UNLIT), radianceDepth.w),
                           direct);
#endif
    }
    radianceDepth.w *= GLINT_FRAME.perLengthUnit;
    imageStore(radianceImage, place, storable(radianceDepth));
#if GLINT_STARTS_ON_SCREEN
    if (GLINT_FRAME.screenSteps != 0u) {
        imageStore(positionImage, place, position);
    }
#endif
    GLINT_CLOCK_STOP
}
