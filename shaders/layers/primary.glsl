// The layers of primary surfaces.
#include "generated/layers.glsl"
#include "hit/camera.glsl"
#include "hit/hit.glsl"
#include "hit/surface.glsl"
#include "hit/surface_values.glsl"
#if GLINT_LAYER_HISTORY
#include "layers/motion.glsl"
#endif

// An albedo in layers is at least this, so that light over the albedo keeps the faint light of dark surfaces.
const float kLeastAlbedo = 1.0 / 1024.0;

// A primary surface. Of one that is unlit, `surface` has the emission alone.
struct PrimaryPoint {
    ivec2 place;
    HostGeometry geometry;
    uint number;  // of the geometry
    uint primitive;
    CameraRay ray;
    Hit hit;
    Surface surface;
    Features features;
    bool isLit;
    float depth;
};

vec4 primaryDepth(PrimaryPoint at) {
    return vec4(at.depth, 0.0, 0.0, 0.0);
}

vec4 primaryPosition(PrimaryPoint at) {
    return vec4(at.hit.position, 0.0);
}

vec4 primaryGeometricNormal(PrimaryPoint at) {
    return vec4(at.hit.geometricNormal, 0.0);
}

vec4 primaryNormal(PrimaryPoint at) {
    return vec4(at.isLit ? at.surface.normal : at.hit.normal * facing(at.hit, at.features), 0.0);
}

vec4 storedAlbedo(vec3 albedo) {
    return vec4(max(albedo, vec3(kLeastAlbedo)), 0.0);
}

// The share of light that passes microfacets and layers both ways.
float passedToDiffuse(PrimaryPoint at) {
    return diffusePassed(at.surface.bsdf.base) * baseShare(at.surface, at.features);
}

vec3 diffuseAlbedo(PrimaryPoint at) {
    vec3 both = at.surface.bsdf.diffuse;
    if (scattersBehind(at.features)) {
        both += at.surface.bsdf.diffuseTransmitted;
    }
    return both * passedToDiffuse(at);
}

vec3 specularAlbedoWithLayers(PrimaryPoint at) {
    Bsdf b = at.surface.bsdf;
    return addAlbedoOfLayers(b.layers, at.features, b.view, specularAlbedo(b.base, at.features));
}

vec3 transmissionAlbedo(PrimaryPoint at) {
    return passesFacets(at.features) ? at.surface.bsdf.base.transmitted * passedToDiffuse(at) : vec3(0.0);
}

vec4 primaryAlbedo(PrimaryPoint at) {
    return storedAlbedo(
        at.isLit ? diffuseAlbedo(at) + specularAlbedoWithLayers(at) + transmissionAlbedo(at) : vec3(0.0));
}

vec4 primaryDiffuseAlbedo(PrimaryPoint at) {
    return storedAlbedo(at.isLit ? diffuseAlbedo(at) : vec3(0.0));
}

vec4 primarySpecularAlbedo(PrimaryPoint at) {
    return storedAlbedo(at.isLit ? specularAlbedoWithLayers(at) : vec3(0.0));
}

vec4 primaryTransmissionAlbedo(PrimaryPoint at) {
    return storedAlbedo(at.isLit ? transmissionAlbedo(at) : vec3(0.0));
}

vec4 primaryRoughness(PrimaryPoint at) {
    return vec4(at.isLit ? at.surface.roughness : 1.0, 0.0, 0.0, 0.0);
}

vec4 primaryEmission(PrimaryPoint at) {
    return vec4(isFinite(at.surface.emission) ? at.surface.emission : vec3(0.0), 0.0);
}

uvec4 primaryMaterial(PrimaryPoint at) {
    return uvec4(at.geometry.materialIndex, 0u, 0u, 0u);
}

uvec4 primaryShader(PrimaryPoint at) {
    return uvec4(at.geometry.shaderId, 0u, 0u, 0u);
}

uvec4 primaryLobes(PrimaryPoint at) {
    return uvec4(at.features.lobes);
}

#if GLINT_LAYER_BRANCHES
#if !GLINT_RAY_GENERATION
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#endif
// Ray generation shaders may lack subgroup operations, so they use the pixel's own features.
uvec4 primaryBranches(PrimaryPoint at) {
    uint lobes = at.features.lobes & at.features.sometimesLobes;
    uint inputs = at.features.inputs & at.features.sometimesInputs;
#if !GLINT_RAY_GENERATION
    lobes = subgroupOr(lobes);
    inputs = subgroupOr(inputs);
#endif
    return uvec4(bitCount(lobes) + bitCount(inputs));
}
#endif

vec4 primaryFootprint(PrimaryPoint at) {
    return vec4(GLINT_FRAME.pixelWidth + GLINT_FRAME.pixelSpread * distance(at.hit.position, at.ray.origin), 0.0, 0.0,
                0.0);
}

// The level that a sampler chooses: Vulkan 1.3, "Scale Factor, Level-of-Detail and Image Level(s) Operations". It is that
// of the whole image, and below 0 where it is magnified.
float levelOfGradients(vec4 gradients, vec2 texels, float anisotropy) {
    vec4 inTexels = gradients * vec4(texels, texels);
    float first = dot(inTexels.xy, inTexels.xy);
    float second = dot(inTexels.zw, inTexels.zw);
    float width = max(max(first, second) / (anisotropy * anisotropy), min(first, second));
    return width > 0.0 ? 0.5 * log2(width) : 0.0;
}

const float kNoLevel = 65504.0;  // the surface reads no texture

#if GLINT_LAYER_TEXTURE_LEVEL
vec4 primaryTextureLevel(PrimaryPoint at) {
    float finest = kNoLevel;
#if GLINT_TEXTURE_SLOTS > 0
    uint read = GLINT_SLOTS_READ(at.features);
    for (uint slot = 0u; slot < GLINT_TEXTURE_SLOTS; ++slot) {
        TextureRecord record = GLINT_TEXTURE(GLINT_MATERIAL(at.hit), slot);
        if ((read >> slot & 1u) != 0u) {
            vec4 edges = readsSecondSet(at.hit, slot, at.features) ? at.hit.uvEdges[1] : at.hit.uvEdges[0];
            edges = vec4(dot(record.rowU.xy, edges.xy), dot(record.rowV.xy, edges.xy), dot(record.rowU.xy, edges.zw),
                         dot(record.rowV.xy, edges.zw));
            vec3 filtered = hostTextureFilter(record);
            vec4 gradients = coneGradients(at.hit.footprint, edges, filtered.xy, filtered.z);
            finest = min(finest, levelOfGradients(gradients, filtered.xy, filtered.z));
        }
    }
#endif
    return vec4(finest, 0.0, 0.0, 0.0);
}
#endif

#if GLINT_LAYER_HISTORY
vec4 primaryMotion(PrimaryPoint at) {
    vec3 corners[3] = currentCorners(at.geometry, at.primitive);
    vec2 barycentrics = rayTriangleBarycentrics(at.ray, corners[0], corners[1] - corners[0], corners[2] - corners[0]);
    vec3 before = cornerMean(previousCorners(at.geometry, at.number, at.primitive), barycentrics);
    return motionOf(vec4(cornerMean(corners, barycentrics), 1.0), vec4(before, 1.0));
}
#endif
