// The BSDF of a surface: layers over a base, which is a model that a pack declares (bsdf/model.glsl) or Glint's own
// (materials/base/). Vectors are in the frame of the surface: z is the shading normal on the viewer's side, x the
// direction of anisotropy.
#include "generated/layers.glsl"
#include "materials/base/base.glsl"

struct Bsdf {
    GLINT_RELAXED vec3 diffuse;             // albedo of the base's diffuse lobe; what a model reflects in all
    GLINT_RELAXED vec3 diffuseTransmitted;  // the same on the far side
    Base base;      // does nothing where the key has a model
    Layers layers;  // with the models
#if GLINT_SHARED_LIGHTS
    float counted;  // share of a model's light that counts; 1 unless rays bring the rest
#endif
    vec3 view;      // unit, z >= kMinViewCosine; prepareBsdf() sets it
};

// Prepares the BSDF for a view, which is a unit vector in the frame of the surface.
void prepareBsdf(inout Bsdf b, Features features, vec3 view) {
    b.view = view;
    if (view.z < kMinViewCosine) {
        vec2 across = view.xy;
        float length2 = dot(across, across);
        b.view = vec3(length2 > 0.0 ? across * inversesqrt(length2) : vec2(1.0, 0.0), kMinViewCosine);
    }
    if (!hasModel(features)) {
        basePrepare(b.base, features, b.view);
    }
    prepareLayers(b.layers, features, b.view);
}

// Returns the light that the base reflects or transmits, times |n·l|, without the layers above it.
vec3 evaluateBase(Bsdf b, Features features, vec3 l) {
    if (hasModel(features)) {
        vec3 light = l.z > 0.0 || transmits(features) ? evaluateModel(b.layers, features, b.view, l) : vec3(0.0);
#if GLINT_SHARED_LIGHTS
        light *= b.counted;
#endif
        return light;
    }
    if (l.z > 0.0) {
        return baseReflection(b.base, features, b.view, l, diffuseLobe(b.layers, features, b.diffuse, b.view, l));
    }
    return transmits(features) && l.z < 0.0 ? baseTransmission(b.base, features, b.view, l, b.diffuseTransmitted)
                                            : vec3(0.0);
}

#if GLINT_SHARED_LIGHTS

// Returns π times the light that the diffuse lobes of the base send from l to the view, through the layers above it. It
// is their part of evaluateBsdf(): rays that share the light with samples must bring the same.
vec3 evaluateDiffuse(Bsdf b, Features features, vec3 l) {
    vec3 base = vec3(0.0);
    if (hasModel(features)) {
        if (l.z > 0.0 || transmits(features)) {
            // Both vanish together where light grazes the surface.
            base = evaluateModel(b.layers, features, b.view, l) * (kPi / max(abs(l.z), 1e-6));
        }
    } else if (l.z > 0.0) {
        base = diffuseLobe(b.layers, features, b.diffuse, b.view, l) *
               diffuseShare(b.base, features, b.view, l, false);
    } else if (scattersBehind(features)) {
        base = b.diffuseTransmitted * diffuseShare(b.base, features, b.view, vec3(l.xy, -l.z), true);
    }
    // The layers count without their own reflection. That of mirrors would cost the digits of the difference.
    b.layers.counted = noLayerShares();
    return addLayersAbove(b.layers, features, b.view, l, l.z, base) -
           addLayersAbove(b.layers, features, b.view, l, l.z, vec3(0.0));
}

#endif

// Returns the BSDF times |n·l| for the prepared view. l is a unit vector in the frame of the surface; if l.z < 0 it is
// on the far side.
vec3 evaluateBsdf(Bsdf b, Features features, vec3 l) {
    return addLayers(b.layers, features, b.view, l, evaluateBase(b, features, l));
}
