// shadeFirst(): the light of a surface that the camera sees, and the samples that effects take there. Where its shadow
// rays wait in memory and are more than fit, it is called again for the others.
#include "first/first_store.glsl"
#include "generated/effects.glsl"
#include "hit/primary.glsl"
#include "hit/shade.glsl"
#include "light/direct.glsl"
#if GLINT_SURFACE_LAYERS
#include "generated/surface_layers.glsl"
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

// Returns whether something is left of a pixel that earlier rounds of shadow rays have shaded.
bool shadesInRound(uvec2 pixel) {
#if GLINT_FIRST_SHADOW_RAYS > 0
    uint place = pixel.x + pixel.y * GLINT_FRAME.width - GLINT_FRAME.bandFirst;
    return pushed.shadowRound == 0u ||
           GLINT_FRAME.firstShadowCounts.data[place] > kFirstShadowRays * pushed.shadowRound;
#else
    return true;
#endif
}

// Shades the surface of a pixel: `primitive` of the geometry with that number.
void shadeFirst(uvec2 pixel, uint number, HostGeometry geometry, uint primitive, Features features) {
    ivec2 place = ivec2(pixel);
    CameraRay ray = cameraRay(pixel);
    Hit hit = primaryHit(geometry, primitive, ray, pixel.x + pixel.y * GLINT_FRAME.width, features);
    vec4 origin = vec4(rayOrigin(hit, hit.geometricNormal),
                       uintBitsToFloat(packSnorm2x16(octahedralEncode(hit.geometricNormal))));
    float depth = dot(hit.position - GLINT_FRAME.cameraPosition, GLINT_FRAME.cameraForward);
    Surface surface = evaluateAny(hit, features);
    bool lit = isLit(features);
    vec3 radiance = surface.emission;
    vec3 scattered = vec3(0.0);
    if (lit) {
        SkyShares sky = wholeSky();
        sampleEffects(hit, surface, features, sky);
        scattered = scatteredBy(hit, surface, features, sky);
        radiance += scattered;
    } else {
        skipEffects(hit.target, kRayUnlit);
    }
#if GLINT_FIRST_SHADOW_RAYS > 0
    if (pushed.shadowRound > 0u) {
        return;
    }
#endif
#if GLINT_SURFACE_LAYERS
    storeSurfaceLayers(PrimaryPoint(place, geometry, number, primitive, ray, hit, surface, features, lit, depth),
                       scattered);
#endif
    storeFirst(place, radiance, depth, origin);
}
