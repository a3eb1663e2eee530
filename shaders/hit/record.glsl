// Hit records in memory, whole or packed.
#include "hit/bindings.glsl"
#include "hit/geometry.glsl"
#include "host/geometry.glsl"

// A shader ID that no case has.
const uint kNoShader = 0xFFFFFFFFu;

// Encodes a cone's width in eighths of a power of two, from 2^-20 of FrameConstants::lengthUnit as 1 to
// 2^11.6 of it as 254. The error is at most a sixteenth of a mip level. 0 means no width.
uint packConeWidth(float width) {
    return width > 0.0 ? uint(clamp(round(8.0 * (log2(width * GLINT_FRAME.perLengthUnit) + 20.0)), 1.0, 254.0)) : 0u;
}

float unpackConeWidth(uint code) {
    return code > 0u ? exp2(float(code) * 0.125 - 20.0) * GLINT_FRAME.lengthUnit : 0.0;
}

#if GLINT_HITS_IN_SAMPLES

// A file that includes this one also includes hit/samples.glsl, which has these functions.
uint samplePlace(uint target);
void putHit(uint place, HitRecord hit);
HitRecord packedHit(uint place);
uint packedHitGeometry(uint place);

// Stores the hit in the place of the ray's start.
void storeHit(uint index, HitRecord hit) {
    putHit(samplePlace(GLINT_FRAME.listed.data[index]), hit);
}

HitRecord storedHit(uint index) {
    return packedHit(samplePlace(GLINT_FRAME.listed.data[index]));
}

// Returns the geometry of a stored hit, or kMissGeometry, or, after its light is stored, a number of no geometry.
uint storedGeometry(uint index) {
    return packedHitGeometry(samplePlace(GLINT_FRAME.listed.data[index]));
}

#elif GLINT_HIT_RECORD_PACKED

void storeHit(uint index, HitRecord hit) {
    uint geometry = hit.geometry == kMissGeometry ? kMissGeometry : hit.geometry << 8 | packConeWidth(hit.coneWidth);
    GLINT_FRAME.packedHits.data[index] =
        PackedHitRecord(geometry, hit.primitive, packUnorm2x16(vec2(hit.barycentricU, hit.barycentricV)));
}

HitRecord storedHit(uint index) {
    PackedHitRecord record = GLINT_FRAME.packedHits.data[index];
    if (record.geometry24_coneLog8 == kMissGeometry) {
        return HitRecord(kMissGeometry, 0u, 0.0, 0.0, 0.0);
    }
    vec2 barycentrics = unpackUnorm2x16(record.barycentrics2x16);
    return HitRecord(record.geometry24_coneLog8 >> 8, record.primitive, barycentrics.x, barycentrics.y,
                     unpackConeWidth(record.geometry24_coneLog8 & 0xFFu));
}

// Returns the geometry of a stored hit, or kMissGeometry.
uint storedGeometry(uint index) {
    uint word = GLINT_FRAME.packedHits.data[index].geometry24_coneLog8;
    return word == kMissGeometry ? kMissGeometry : word >> 8;
}

#else

void storeHit(uint index, HitRecord hit) {
    GLINT_FRAME.hits.data[index] = hit;
}

HitRecord storedHit(uint index) {
    return GLINT_FRAME.hits.data[index];
}

uint storedGeometry(uint index) {
    return GLINT_FRAME.hits.data[index].geometry;
}

#endif
