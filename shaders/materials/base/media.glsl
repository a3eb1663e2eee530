// The volumes that a ray is in, one within the other.
#include "hit/hit.glsl"

// Four volumes at most, the innermost first: numbers of 16 bits, 1 + index of the material, or 0 for none.
#define Media uvec2
const uint kMostMedia = 4u;
const uint kLastMediumMaterial = 0xFFFEu;  // volumes of materials with a greater index are left out

bool isWithin(Media media) {
    return media.x != 0u;
}

// The number at a place, counted from the innermost.
uint mediumAt(Media media, uint place) {
    uint word = place < 2u ? media.x : media.y;
    return (word >> (16u * (place & 1u))) & 0xFFFFu;
}

// The material of the innermost volume, if there is one.
uint innermostMaterial(Media media) {
    return mediumAt(media, 0u) - 1u;
}

// The place of a material's innermost volume, or kMostMedia if the ray is in none.
uint placeOf(Media media, uint material) {
    for (uint place = 0u; place < kMostMedia; ++place) {
        if (mediumAt(media, place) == material + 1u) {
            return place;
        }
    }
    return kMostMedia;
}

// A ray that is in four volumes stays in those four.
Media enterMedium(Media media, uint material) {
    bool fits = mediumAt(media, kMostMedia - 1u) == 0u && material <= kLastMediumMaterial;
    return fits ? uvec2(media.x << 16u | (material + 1u), media.y << 16u | media.x >> 16u) : media;
}

Media leaveMedium(Media media, uint place) {
    if (place == 0u) {
        return uvec2(media.x >> 16u | media.y << 16u, media.y >> 16u);
    }
    if (place == 1u) {
        return uvec2((media.x & 0xFFFFu) | media.y << 16u, media.y >> 16u);
    }
    return uvec2(media.x, place == 2u ? media.y >> 16u : place == 3u ? media.y & 0xFFFFu : media.y);
}

// The media beyond the surface of a volume.
Media mediaBeyond(Hit hit, Media media) {
    return hit.frontFace ? enterMedium(media, hit.material) : leaveMedium(media, placeOf(media, hit.material));
}
