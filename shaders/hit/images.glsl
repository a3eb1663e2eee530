// The images of a frame. Where the picture has 16-bit floats, the runtime replaces the format rgba32f in the modules that
// it loads (runtime/src/package/shader_modules.h).
#include "hit/bindings.glsl"

layout(set = kSetFrame, binding = kBindingSurface, rg32ui) uniform readonly uimage2D surfaceImage;
layout(set = kSetFrame, binding = kBindingRadiance, rgba32f) uniform image2D radianceImage;
layout(set = kSetFrame, binding = kBindingAccumulated, rgba32f) uniform image2D accumulatedImage;
layout(set = kSetFrame, binding = kBindingResidual, rgba32f) uniform image2D residualImage;
layout(set = kSetFrame, binding = kBindingPosition, rgba32f) uniform image2D positionImage;

// Returns a value as the images of light can hold it. NaN stays NaN.
vec4 storable(vec4 value) {
    if ((GLINT_FRAME.accumulates & kPictureIsHalf) != 0u) {
        value = mix(value, vec4(kMostHalf), greaterThan(value, vec4(kMostHalf)));
    }
    return value;
}
