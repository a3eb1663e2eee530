// A layer's reflection as the effect reflection traces it.
#include "bsdf/layer.glsl"
#include "generated/scene.glsl"
#include "hit/bindings.glsl"

struct TracedLayer {
    float share;    // of the layer's reflection that rays bring and the layers above let out
    vec3 light;     // the same of a uniform white sky
    vec3 normal;    // unit, in the frame of the base
    bool isMirror;  // rays go to the mirror direction alone
    float chance;   // that a ray samples it
};

// The share of a surface's reflection that its ray brings; the sky stands in for the rest. It falls to 0 over the last
// fifth below the roughness limit, so that no edge shows where a texture crosses the limit. Just below the limit a ray
// is still sent. With a limit of 1 every lobe is traced whole.
float tracedShare(float roughness) {
    float limit = GLINT_FRAME.maxReflectionRoughness;
    if (limit >= 1.0) {
        return 1.0;
    }
    if (roughness > limit) {
        return 0.0;
    }
    float fade = limit > 0.0 ? clamp((roughness - 0.8 * limit) / (0.2 * limit), 0.0, 0.999) : 0.0;
    return 1.0 - fade * fade * (3.0 - 2.0 * fade);
}

bool isMirror(float roughness) {
    return roughness <= GLINT_FRAME.mirrorRoughness;
}

TracedLayer untracedLayer() {
    return TracedLayer(0.0, vec3(0.0), vec3(0.0, 0.0, 1.0), false, 0.0);
}

TracedLayer tracedLayer(float share, LayerMirror lobe, LayerAlbedo albedo) {
    return TracedLayer(share, share * albedo.reflected, lobe.normal, isMirror(lobe.roughness), 0.0);
}

void passLayer(inout TracedLayer traced, float passed) {
    traced.share *= passed;
    traced.light *= passed;
}

// Sets the layer's chance, not yet divided by the sum of all. Where base and layer are mirrors and their directions
// differ by less than a quarter of a degree, one ray serves both, and the base has it.
void weighLayer(inout TracedLayer traced, bool baseMirror, inout vec3 base) {
    if (baseMirror && traced.isMirror && traced.normal.z > 0.99999) {
        base += traced.light;
    } else {
        traced.chance = luminance(traced.light);
    }
}
