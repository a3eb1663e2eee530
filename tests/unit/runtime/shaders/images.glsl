layout(set = kSetScene, binding = kBindingTextures) uniform texture2D sceneTextures[];
layout(set = kSetScene, binding = kBindingSamplers) uniform sampler sceneSamplers[];
layout(set = kSetFrame, binding = kBindingSurface, rg32ui) uniform readonly uimage2D surfaceImage;
layout(set = kSetFrame, binding = kBindingRadiance, rgba32f) uniform image2D radianceImage;
layout(set = kSetFrame, binding = kBindingAccumulated, rgba32f) uniform image2D accumulatedImage;

