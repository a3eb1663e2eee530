// A ray that a primary surface sends for an effect.
#include "bsdf/fresnel.glsl"
#include "hit/hit.glsl"
#include "hit/samples.glsl"

// coneSpread: growth of the ray's cone by metre. The sample is not sent where what it finds would count for nothing, or
// for less than FrameConstants::faintWeight.
EffectSample sentSample(Hit hit, vec3 direction, vec3 weight, float coneSpread) {
    EffectSample result;
    float share = luminance(weight);
    result.outcome = share <= 0.0 ? kRayBlack : share < GLINT_FRAME.faintWeight ? kRayFaint : kRaySent;
    result.origin = rayOrigin(hit, direction);
    result.direction = direction;
    // Cones of an orthographic camera do not grow: from where in its plane they come does not matter.
    result.coneWidth = GLINT_FRAME.pixelWidth +
                       GLINT_FRAME.pixelSpread * distance(result.origin, GLINT_FRAME.cameraPosition);
    result.weight = weight;
    result.coneSpread = coneSpread;
    return result;
}
