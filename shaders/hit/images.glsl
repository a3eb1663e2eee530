// The images of a frame.
#include "hit/bindings.glsl"

layout(set = kSetFrame, binding = kBindingSurface, rg32ui) uniform readonly uimage2D surfaceImage;
layout(set = kSetFrame, binding = kBindingRadiance, rgba32f) uniform image2D radianceImage;
layout(set = kSetFrame, binding = kBindingReflectionRay, rgba32f) uniform image2D reflectionRayImage;
layout(set = kSetFrame, binding = kBindingPosition, rgba32f) uniform image2D positionImage;
layout(set = kSetFrame, binding = kBindingReflectance, rgba32f) uniform image2D reflectanceImage;
layout(set = kSetFrame, binding = kBindingReflection, rgba32f) uniform image2D reflectionImage;
layout(set = kSetFrame, binding = kBindingAccumulated, rgba32f) uniform image2D accumulatedImage;
layout(set = kSetFrame, binding = kBindingResidual, rgba32f) uniform image2D residualImage;

ivec2 pixelCoordinates(uint pixel) {
    return ivec2(pixel % GLINT_FRAME.width, pixel / GLINT_FRAME.width);
}
