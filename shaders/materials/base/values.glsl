// Makes Glint's own base of the material's values: glTF 2.0, appendix B.3.5.
#include "materials/base/base.glsl"
#include "hit/surface_values.glsl"

Base makeBase(SurfaceValues values, Features features) {
    Base b;
    bool both = hasBothBases(features);
    b.metalF0 = values.color.rgb;
    b.metallic = values.metallic;
    b.f0 = both ? values.f0 : mix(values.f0, values.color.rgb, values.metallic);
    b.f90 = both ? values.f90 : mix(values.f90, 1.0, values.metallic);
    b.alpha = vec2(max(values.roughness * values.roughness, kMinAlpha));
    b.transmitted = vec3(0.0);
    b.eta = vec3(1.0);
    b.viewLoss = b.viewBias = b.meanLoss = b.meanBias = 0.0;
#if GLINT_SHARED_LIGHTS
    b.mirrored = 1.0;
#endif
    return b;
}
