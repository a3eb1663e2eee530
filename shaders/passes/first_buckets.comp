#version 460
// Stores the bucket of each pixel of a band, by the surface that it sees: the passes that order hits then order the
// pixels. Pixels without a surface, and those beyond the picture in its last tiles, are in bucket 0.
#include "hit/first_list.glsl"
#include "hit/images.glsl"
#include "hit/record.glsl"
#include "order/bucket_key.glsl"

GLINT_RAY_WORKGROUP

shared uint groupKeys[kRayGroupSize];

void main() {
    uint index = listIndex();
    uint thread = gl_LocalInvocationIndex;
    uvec2 pixel = listedPixel(index);
    uint geometry = isInPicture(pixel) ? imageLoad(surfaceImage, ivec2(pixel)).x : kNoSurface;
    groupKeys[thread] = bucketOfGeometry(geometry);
    barrier();
    if (thread < kRayGroupSize / kKeysOfWord) {
        uint word = 0u;
        for (uint i = 0u; i < kKeysOfWord; ++i) {
            word |= groupKeys[thread * kKeysOfWord + i] << (i * kKeyBits);
        }
        KeyWordArray(GLINT_FRAME.bucketKeys).data[index / kRayGroupSize * (kRayGroupSize / kKeysOfWord) + thread] = word;
    }
    if (index == 0u) {
        uint tilesY = (GLINT_FRAME.endRow - GLINT_FRAME.firstRow + (kPixelGroupSize - 1u)) / kPixelGroupSize;
        GLINT_FRAME.rayDispatch.data[0] = listDispatch(kRayGroupSize * firstTilesX() * tilesY, kRayGroupSize);
    }
}
