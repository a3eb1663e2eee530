// The alpha of a candidate, for ray traversal over masked geometry.
#include "generated/mask_stages.glsl"

// Returns whether the candidate passes its material's alpha test: glTF 2.0, section 3.9.4. It reads mip 0, because
// traversal knows no footprint. The module's own cases do not matter here: a ray of any case meets masks of all cases.
bool passesAlphaTest(HostGeometry geometry, uint primitive, vec2 barycentrics) {
    Features features = Features(GLINT_ALPHA_ALWAYS_LOBES, GLINT_ALPHA_ALWAYS_INPUTS, GLINT_ALPHA_SOMETIMES_LOBES,
                                 GLINT_ALPHA_SOMETIMES_INPUTS, geometry.featureLobes, geometry.featureInputs);
    MaterialRecord material = hostMaterials().data[geometry.materialIndex];
    SurfacePoint point = surfacePoint(geometry, primitive, barycentrics, features);
    runMaskCoordinates(point, features);
    float alpha = material.baseColorFactor.a;
    if (inputOfKey(features, GLINT_BASE_COLOR_TEXTURE)) {
        alpha *= samplePoint(point, kBaseColorTexture, features).a;
    }
    if (inputOfKey(features, GLINT_VERTEX_COLOR)) {
        alpha *= vertexAlpha(geometry, primitive, barycentrics);
    }
    runMaskOpacity(point, features, alpha);
    return alpha >= material.alphaCutoff;
}
