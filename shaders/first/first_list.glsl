// The list of first hits: the pixels of a band, tile by tile, so that pixels that are shaded together lie side by side.
// Tiles may reach beyond the band.
#include "hit/list.glsl"

uint firstTilesX() {
    return (GLINT_FRAME.width + (kPixelGroupSize - 1u)) / kPixelGroupSize;
}

// Returns the length of the list.
uint firstElements() {
    uint rows = GLINT_FRAME.endRow - GLINT_FRAME.firstRow;
    uint tilesY = (rows + (kPixelGroupSize - 1u)) / kPixelGroupSize;
    return kPixelGroupSize * kPixelGroupSize * firstTilesX() * tilesY;
}

// Returns the pixel of the element `index` of the list.
uvec2 listedPixel(uint index) {
    const uint kTilePixels = kPixelGroupSize * kPixelGroupSize;
    uint tile = index / kTilePixels;
    uint inTile = index % kTilePixels;
    return kPixelGroupSize * uvec2(tile % firstTilesX(), tile / firstTilesX()) +
           uvec2(inTile % kPixelGroupSize, GLINT_FRAME.firstRow + inTile / kPixelGroupSize);
}

// Returns a pixel of the bucket that this dispatch shades.
uvec2 orderedPixel(uint index) {
    return listedPixel(GLINT_FRAME.orderedHits.data[GLINT_FRAME.bucketBegins.data[pushed.bucket] + index]);
}

bool isInPicture(uvec2 pixel) {
    return pixel.x < GLINT_FRAME.width && pixel.y < GLINT_FRAME.endRow;
}
