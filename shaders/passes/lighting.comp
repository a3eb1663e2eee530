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
#include "passes/primary_surface.glsl"
#if GLINT_SURFACE_LAYERS
#include "generated/surface_layers.glsl"
#endif

GLINT_PIXEL_WORKGROUP

#if GLINT_SHARED_LIGHTS

// The light of a shared light, without its shadow, for the shares of the lobes that rays of effects don't bring.
vec3 lightOfShared(Hit hit, Surface surface, Features features, HostLight light, SharedSample drawn, SkyShares sky) {
    SkyShares shares = sky;
    shareWithEffects(surface, features, toSurface(surface, drawn.direction), drawn.density, shares);
#if GLINT_SKY_LIGHT
    if (light.emitter == kSkyEmitter) {
        shares = sampledShares(surface, features, shares, sky);
    }
#endif
    keepShares(shares, surface);
    return scatteredLight(surface, features, hit.geometricNormal, drawn.direction) * drawn.radiance / drawn.density;
}

// The same with its shadow.
vec3 visibleShared(Hit hit, Surface surface, Features features, HostLight light, uint index, SkyShares sky,
                   inout ShadowCounts counts) {
    SharedSample drawn = sampleShared(hit, light, index, 0u);
    if (drawn.density <= 0.0) {
        return vec3(0.0);
    }
    vec3 contribution = lightOfShared(hit, surface, features, light, drawn, sky);
    LightSample aim = aimAtShared(hit, light, drawn);
    if (luminance(contribution) <= 0.0 || aim.distance <= 0.0) {
        counts.facing += 1u;
        return vec3(0.0);
    }
    uint sees = passesAsLight(light) ? kShadowOfLight : kShadowOfShared;
    bool visible = lightArrivesTo(sees, rayOrigin(hit, aim.direction), aim.direction, aim.distance, contribution);
    counts.rays += 1u;
    counts.misses += visible ? 1u : 0u;
    return visible ? contribution : vec3(0.0);
}

#endif

vec3 directLight(Hit hit, Surface surface, Features features, SkyShares sky) {
    vec3 sum = vec3(0.0);
    uint lights = hostLightCount(hit.position);
#if GLINT_EFFECT_SHADOW
    ShadowCounts counts = ShadowCounts(0u, 0u, 0u, 0u, 0u);
#endif
    for (uint i = 0u; i < lights; ++i) {
        HostLight light = lightOfHost(hit, features, i);
#if GLINT_SHARED_LIGHTS
        if (isShared(light)) {
            sum += visibleShared(hit, surface, features, light, i, sky, counts);
            continue;
        }
#endif
        LightSample centre = hostSampleLight(light, hit.position);
#if GLINT_EFFECT_SHADOW
        if (!passesGate(centre, counts)) {
            continue;
        }
        uint points = lightPointCount(light);
        centre.irradiance /= float(points);
        for (uint j = 0u; j < points; ++j) {
            LightSample point = lightPoint(hit, light, centre, i, j);
            sum += visibleLight(hit, point, unshadowedLight(hit, surface, features, point), counts);
        }
#else
        vec3 contribution = unshadowedLight(hit, surface, features, centre);
        sum += luminance(contribution) > 0.0 ? contribution : vec3(0.0);
#endif
    }
#if GLINT_EFFECT_SHADOW
    reportShadows(counts);
#endif
    return sum;
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
#if GLINT_SURFACE_LAYERS
            direct = directLight(hit, surface, features, sky) + ambientLight(surface, features, hit.view, sky);
            radianceDepth.rgb = surface.emission + direct;
#else
            radianceDepth.rgb = surface.emission + directLight(hit, surface, features, sky) +
                                ambientLight(surface, features, hit.view, sky);
#endif
        }
#if GLINT_SURFACE_LAYERS
        storeSurfaceLayers(PrimaryPoint(place, geometry, surfaceId.x, surfaceId.y, ray, hit, surface, features,
                                        !hasLobe(features, GLINT_UNLIT), radianceDepth.w),
                           direct);
#endif
    }
    imageStore(radianceImage, place, storable(radianceDepth));
#if GLINT_STARTS_ON_SCREEN
    if (GLINT_FRAME.screenSteps != 0u) {
        imageStore(positionImage, place, position);
    }
#endif
    GLINT_CLOCK_STOP
}
