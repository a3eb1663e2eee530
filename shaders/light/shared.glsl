// Lights that rays of lobes find, too: emissive triangles and the sky. Samples of such lights and rays share the light
// by the balance heuristic (Veach and Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering",
// 1995).
#include "light/emitter.glsl"
#include "effects/sky_shares.glsl"
#include "bsdf/constants.glsl"
#include "hit/surface.glsl"
#include "host/lights.glsl"
#include "host/random.glsl"
#include "host/sky.glsl"
#include "light/shared_sample.glsl"

#if GLINT_SHARED_LIGHTS

// The pairs of dimensions of the sequence: a cell of the sky, and a place within it.
const uint kPairSky = 8u;
const uint kPairSkyWithin = 9u;

// The sample of a light that hostLight() has given as number `index`. Its density is that of all samples of a surface
// together. `bounce` is the first dimension of the bounce.
SharedSample sampleShared(Hit hit, HostLight light, uint index, uint bounce) {
#if GLINT_SKY_LIGHT
    if (light.emitter == kSkyEmitter) {
        SkySample drawn = hostSampleSky(hostRandomPair(hit.target, bounce + kPairSky),
                                        hostRandomPair(hit.target, bounce + kPairSkyWithin));
        return SharedSample(drawn.direction, hostSky(drawn.direction), drawn.density, vec3(0.0));
    }
#endif
#if GLINT_EMISSIVE_LIGHTS
    return emitterLight(hit, light, bounce + kPairEmitter + index);
#else
    return SharedSample(vec3(0.0), vec3(0.0), 0.0, vec3(0.0));
#endif
}

// The shadow ray of a sample, in place of its direction.
LightSample aimAtShared(Hit hit, HostLight light, SharedSample drawn) {
#if GLINT_EMISSIVE_LIGHTS
    if (light.emitter != kSkyEmitter) {
        return emitterAim(hit, drawn);
    }
#endif
    return LightSample(drawn.direction, kFarDistance, vec3(0.0), kRaySent);
}

// Returns whether the shadow ray meets the surfaces that rays to other lights meet, instead of those that a ray of a
// lobe meets. That holds for the sky with --shadow-through opaque or glass.
bool passesAsLight(uint emitter) {
#if GLINT_SKY_LIGHT && (GLINT_SHADOW_GLASS || GLINT_SHADOW_OPAQUE)
    return emitter == kSkyEmitter;
#else
    return false;
#endif
}

// Keeps these shares of the lobes.
void keepShares(Features features, SkyShares shares, inout Surface surface) {
    surface.bsdf.base.mirrored = shares.mirrored;
    surface.bsdf.counted = shares.diffuse;
    surface.bsdf.layers.counted = shares.layers;
    surface.bsdf.diffuse *= shares.diffuse;
    surface.bsdf.base.transmitted *= shares.transmitted;
    surface.bsdf.diffuseTransmitted *= shares.behind;
}

#endif
