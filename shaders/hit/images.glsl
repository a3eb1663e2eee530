// The images of a frame.
#include "hit/bindings.glsl"

layout(set = kSetFrame, binding = kBindingSurface, rg32ui) uniform readonly uimage2D surfaceImage;
layout(set = kSetFrame, binding = kBindingRadiance, rgba32f) uniform image2D radianceImage;
layout(set = kSetFrame, binding = kBindingAccumulated, rgba32f) uniform image2D accumulatedImage;
layout(set = kSetFrame, binding = kBindingResidual, rgba32f) uniform image2D residualImage;
layout(set = kSetFrame, binding = kBindingPosition, rgba32f) uniform image2D positionImage;
