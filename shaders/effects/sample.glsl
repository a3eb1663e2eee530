// A ray that a primary surface sends for an effect.
#include "bsdf/fresnel.glsl"
#include "hit/hit.glsl"
#include "hit/samples.glsl"

// coneSpread is the growth of the ray's cone in a metre. The sample is not sent if its result would have no weight, or
// less than FrameConstants::faintWeight.
EffectSample sentSample(Hit hit, vec3 direction, vec3 weight, float coneSpread) {
    EffectSample result;
    float share = luminance(weight);
    result.outcome = share <= 0.0 ? kRayBlack : share < GLINT_FRAME.faintWeight ? kRayFaint : kRaySent;
    result.origin = rayOrigin(hit, direction);
    result.direction = direction;
    // The cones of an orthographic camera do not grow, so it does not matter where in its plane they start.
    result.coneWidth = GLINT_FRAME.pixelWidth +
                       GLINT_FRAME.pixelSpread * distance(result.origin, GLINT_FRAME.cameraPosition);
    result.weight = weight;
    result.coneSpread = coneSpread;
    return result;
}
