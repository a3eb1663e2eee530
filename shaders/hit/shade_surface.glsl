// shade() for rays that are answered with the surface that they hit.
#include "hit/answer_surface.glsl"
#include "hit/material.glsl"

ShadeResult shade(Hit hit, Features features) {
    SurfaceRecord answer = noSurface(hit.shaderId);
    answer.position = hit.position;
    answer.geometricNormal = hit.geometricNormal;
    answer.clearance = hit.clearance;
    answer.motion = hit.position - hit.previousPosition;
    answer.material = hit.material;
    Surface surface = evaluateAny(hit, features);
    if (!isLit(features)) {
        answer.normal = hit.geometricNormal;
        answer.roughness = 1.0;
        answer.occlusion = 1.0;
        answer.emission = surface.emission;
        return ShadeResult(answer);
    }
    Base b = surface.bsdf.base;
    answer.normal = surface.normal;
    answer.roughness = surface.roughness;
    answer.albedo = surface.bsdf.diffuse;
    answer.occlusion = surface.occlusion;
    answer.f0 = withMetal(b, features, b.f0, b.metalF0);
    answer.f90 = hasBothBases(features) ? mix(b.f90, 1.0, b.metallic) : b.f90;
    answer.emission = surface.emission;
    answer.transmission = luminance(b.transmitted) + luminance(surface.bsdf.diffuseTransmitted);
    return ShadeResult(answer);
}

void resolveHit(Hit hit, ShadeResult result) {
    storeSurface(hit.target, result.surface);
}
