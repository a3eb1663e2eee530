// The list of first hits is that of the pixels, row by row.
uint firstElement(uint k) {
    return (gl_WorkGroupID.x * kFirstPixelsOfThread + k) * kFirstGroupSize + gl_LocalInvocationIndex;
}

uvec2 pixelOf(uint element) {
    return uvec2(element % FRAME.width, element / FRAME.width);
}

uint bucketOfPixel(uint element) {
    uint geometry = imageLoad(surfaceImage, ivec2(pixelOf(element))).x;
    return geometry == kNoSurface ? 0u : 1u + FRAME.geometries.data[geometry].shaderId;
}

// Returns whether the thread has a pixel of the bucket that is shaded.
bool hasPixel() {
    return gl_GlobalInvocationID.x < FRAME.bucketCounts.data[pushed.bucket];
}

uvec2 shadedPixel() {
    return pixelOf(FRAME.orderedHits.data[FRAME.bucketBegins.data[pushed.bucket] + gl_GlobalInvocationID.x]);
}

// Where no ray is sent, no light is found.
void storeFirst(uvec2 pixel, vec4 radiance) {
    imageStore(radianceImage, ivec2(pixel), radiance);
    FRAME.sampleStarts.data[pixel.x + pixel.y * FRAME.width] = SampleStart(vec3(0.0), 0u);
}
