// Makes a Surface of a hit and its material, by the stages of the material's features.
#include "generated/material_stages.glsl"
#include "materials/base/values.glsl"

// Returns the material's values of the surface at coordinates that are already changed.
SurfaceValues valuesAt(Hit hit, Features features) {
    SurfaceValues values = SurfaceValues(vec4(1.0), 0.0, 1.0, vec3(0.04), 1.0, hit.normal, 1.0, 1.0);
    runSurfaceStage(hit, features, values);
    return values;
}

// Returns the material's values of the surface.
SurfaceValues surfaceValues(Hit hit, Features features) {
    changeCoordinates(hit, features);
    return valuesAt(hit, features);
}

// Returns the BSDF of Glint's own base, or what that of a model has unless it says more. The layers are not set.
Bsdf makeBsdf(SurfaceValues values, Features features) {
    if (hasModel(features)) {
        values.f0 = vec3(0.0);
        values.f90 = values.metallic = 0.0;
        values.dielectric = 1.0;
    }
    Bsdf bsdf;
    bsdf.diffuse = values.color.rgb * values.dielectric;
    bsdf.diffuseTransmitted = vec3(0.0);
    bsdf.base = makeBase(values, features);
#if GLINT_SHARED_LIGHTS
    bsdf.counted = 1.0;
    bsdf.layers.counted = wholeLayerShares();
#endif
    return bsdf;
}

// Returns the surface of a lit key at coordinates that are already changed.
Surface surfaceWith(Hit hit, Features features, SurfaceValues values) {
    values.dielectric = 1.0 - values.metallic;
    Surface surface;
    surface.normal = values.normal * facing(hit, features);
    surface.occlusion = values.occlusion;
    surface.roughness = values.roughness;
#if GLINT_SHADOW_GLASS
    surface.unabsorbed = vec3(1.0);
#endif
    buildBasis(surface.normal, surface.tangent, surface.bitangent);
    surface.bsdf = makeBsdf(values, features);
    runBsdfStage(hit, features, values, surface);
    prepareBsdf(surface.bsdf, features, toSurface(surface, hit.view));
    surface.emission = runEmissionStage(hit, features) *
                       emissionPassedByLayers(surface.bsdf.layers, features, surface.bsdf.view);
    return surface;
}

// Requires a lit key.
Surface evaluateSurface(Hit hit, Features features) {
    changeCoordinates(hit, features);
    return surfaceWith(hit, features, valuesAt(hit, features));
}

// Returns the surface of any key. An unlit surface has a colour alone, which is the emission. Shaders of both kinds of
// keys have the code of the stage "surface" only once in this way.
Surface evaluateAny(Hit hit, Features features) {
    changeCoordinates(hit, features);
    SurfaceValues values = valuesAt(hit, features);
    if (!isLit(features)) {
        Surface surface;
        surface.emission = values.color.rgb;
        return surface;
    }
    return surfaceWith(hit, features, values);
}
