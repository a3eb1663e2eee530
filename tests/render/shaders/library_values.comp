#version 460
// Writes what Glint's library says about a few hits of each geometry of the scene. With PRODUCT, what Glint's own
// functions say stands behind it; the test then includes them.
#include "library.glsl"
#include "library_host.glsl"

layout(local_size_x = kRayGroupSize) in;

const uint kTilts = 4u;
const uint kValues = 32u;

uint place;

void store(float value) {
    GLINT_FRAME.counters.data[place++] = floatBitsToUint(value);
}

void store(vec3 value) {
    store(value.x);
    store(value.y);
    store(value.z);
}

vec3 corner(uint geometry, uint number) {
    return glintHostObjectToWorld(geometry) *
           vec4(glintHostPosition(geometry, glintHostVertex(geometry, number)), 1.0);
}

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= GLINT_FRAME.width) {
        return;
    }
    uint geometry = index / kTilts;
    // A ray that meets the first triangle on its front, more slanted for each tilt.
    vec3 a = corner(geometry, 0u);
    vec3 b = corner(geometry, 1u);
    vec3 c = corner(geometry, 2u);
    vec3 n = normalize(cross(b - a, c - a));
    vec3 t = normalize(b - a);
    vec3 s = cross(n, t);
    float tilt = 0.2 + 0.4 * float(index % kTilts);
    vec3 direction = normalize(-n + tilt * t + 0.3 * tilt * s);
    vec3 wi = normalize(n + 0.5 * t - 0.2 * s);
    vec3 wo = normalize(n - 0.1 * t + 0.4 * s);
    vec2 barycentrics = vec2(0.3, 0.25);
    float coneWidth = 0.05 * float(index % kTilts);
    vec3 random = vec3(0.37, 0.61, (float(index % kTilts) + 0.5) / float(kTilts));

#if PRODUCT
    place = 2u * kValues * index;
#else
    place = kValues * index;
#endif
    GlintSurface surface = glintSurface(GlintHit(geometry, 0u, barycentrics, direction, coneWidth, index));
    GlintRadiance light = glintRadiance(surface);
    GlintSample drawn = glintSample(surface, surface.view, random);
    store(surface.normal);
    store(surface.emission);
    store(surface.roughness);
    store(light.radiance);
    store(light.direct);
    store(light.shadowOrigin);
    store(light.shadowDistance > 0.0 ? 1.0 : 0.0);
    store(glintEvaluate(surface, surface.view, wi));
    store(glintEvaluate(surface, wo, wi));
    store(glintDensity(surface, wo, wi));
    store(drawn.weight);
    store(drawn.density);
    store(glintMirror(surface).weight);

#if PRODUCT
    place = 2u * kValues * index + kValues;
    HostGeometry record = hostGeometry(geometry);
    Features features = GLINT_HIT_FEATURES(record);
    Hit hit = fetchHit(record, 0u, barycentrics, direction, coneWidth, index, features);
    ShadeResult shaded = shadeHit(record.shaderId, hit, record);
    if (hasLobe(features, GLINT_UNLIT)) {
        store(hit.normal);
        store(shaded.radiance);
        store(1.0);
        store(shaded.radiance);
        return;
    }
    Surface own = evaluateSurface(hit, features);
    store(own.normal);
    store(own.emission);
    store(own.roughness);
    store(shaded.radiance);
    store(shaded.direct);
    store(rayOrigin(hit, shaded.shadowDirection));
    store(shaded.shadowDistance > 0.0 ? 1.0 : 0.0);
    store(scatteredLight(own, features, hit.geometricNormal, wi));
    Surface other = own;
    prepareBsdf(other.bsdf, features, toSurface(own, wo));
    store(scatteredLight(other, features, hit.geometricNormal, wi));
    store(bsdfPdf(other.bsdf, features, toSurface(own, wi)));
    BsdfSample sampled = sampleBsdf(own.bsdf, features, random);
    vec3 weight = vec3(0.0);
    if (sampled.pdf > 0.0) {
        weight = scatteredLight(own, features, hit.geometricNormal, toWorld(own, sampled.direction)) / sampled.pdf;
    }
    store(weight);
    store(sampled.pdf);
    store(singleScatterAlbedo(own.bsdf.base, features) * baseShare(own, features));
#endif
}
