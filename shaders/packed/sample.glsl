// The packed record of a sample (--sample-record packed): 24 bytes, in two arrays. The first one holds in turn the
// start of the ray, its hit, and the light that it brings:
//
// | word | the ray | its hit, with GLINT_HITS_IN_SAMPLES | its light |
// |---|---|---|---|
// | start.x | origin.x | triangle | light.r |
// | start.y | origin.y | barycentric u 24, width 8 | light.g |
// | start.z | origin.z | barycentric v 24, width 3, direction 5 | light.b |
// | start.w | outcome 4, direction 4, direction 5, width 9, spread 10 | outcome 4, direction 4, geometry 24 | outcome 4, kPath* 4, kLitGeometry24 |
// | aim.x | weight 11, 11, 10 | the same | the same |
// | aim.y | direction 27, exponent of the weight 5 | the same | the same |
//
// Numbers are bits, from the lowest one. A pass that meets a record which another pass may be lighting decides by
// start.w alone, because a word is written as a whole.

layout(buffer_reference, scalar, buffer_reference_align = 16) buffer PackedStartArray { uvec4 data[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer PackedAimArray { uvec2 data[]; };

// Both take the memory of the full record's arrays.
#define GLINT_PACKED_STARTS PackedStartArray(GLINT_FRAME.sampleStarts)
#define GLINT_PACKED_AIMS PackedAimArray(GLINT_FRAME.sampleAims)

// The geometry of a ray that hit nothing, and of one whose light is stored.
const uint kNoGeometry24 = 0xFFFFFFu;
const uint kLitGeometry24 = 0xFFFFFEu;

// A direction in 36 bits: its octahedral coordinates as numbers of 18 bits. The error is at most 1.2e-5 rad. Directions
// along an axis are exact.
struct DirectionCode {
    uint low;   // 4 bits: the lowest two of each coordinate
    uint high;  // 2 x 16 bits
};

const float kDirectionSteps = 131071.0;
const int kDirectionZero = 131072;

DirectionCode encodeDirection(vec3 v) {
    // octahedralEncode(), rounded in the same way in each shader.
    precise vec2 p = v.xy / (abs(v.x) + abs(v.y) + abs(v.z));
    precise vec2 folded = (1.0 - abs(p.yx)) * vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
    precise vec2 steps = (v.z >= 0.0 ? p : folded) * kDirectionSteps;
    uvec2 code = uvec2(ivec2(roundEven(steps)) + kDirectionZero);
    return DirectionCode((code.x & 3u) | (code.y & 3u) << 2, code.x >> 2 | (code.y >> 2) << 16);
}

vec3 decodeDirection(DirectionCode code) {
    ivec2 steps = ivec2((code.high & 0xFFFFu) << 2 | (code.low & 3u), (code.high >> 16) << 2 | code.low >> 2) -
                  kDirectionZero;
    precise vec2 e = vec2(steps) * (1.0 / kDirectionSteps);
    precise float z = 1.0 - abs(e.x) - abs(e.y);
    float t = max(-z, 0.0);
    precise vec3 v = vec3(e.x + (e.x >= 0.0 ? -t : t), e.y + (e.y >= 0.0 ? -t : t), z);
    precise float squared = dot(v, v);
    precise vec3 direction = v * inversesqrt(squared);
    return direction;
}

// Returns the direction that a record keeps of a unit vector. Densities are computed for it.
vec3 keptDirection(vec3 direction) {
    return decodeDirection(encodeDirection(direction));
}

// The largest weight that a record keeps. A larger one is cut, and one that is not a number becomes 0.
const float kMostWeight = 16000.0;

float powerOfTwo(int exponent) {
    return uintBitsToFloat(uint(exponent + 127) << 23);
}

// Encodes a weight as three numbers of 11, 11 and 10 bits with a common exponent of 5, which stands for -17 to 14. The
// error is at most 2^-11 of the largest component, and 2^-10 for blue.
uvec2 encodeWeight(vec3 weight) {
    vec3 kept = mix(vec3(0.0), min(weight, vec3(kMostWeight)), greaterThan(weight, vec3(0.0)));
    // The factor leaves room for numbers that are rounded up.
    float most = max(kept.r, max(kept.g, kept.b)) * 1.0009765625;
    int exponent = clamp(int(floatBitsToUint(most) >> 23) - 126, -17, 14);
    float scale = powerOfTwo(11 - exponent);
    uvec3 numbers = uvec3(kept * vec3(scale, scale, 0.5 * scale) + 0.5);
    return uvec2(numbers.r | numbers.g << 11 | numbers.b << 22, uint(exponent + 17));
}

vec3 decodeWeight(uvec2 code) {
    float scale = powerOfTwo(int(code.y) - 17 - 11);
    return vec3(code.x & 0x7FFu, code.x >> 11 & 0x7FFu, code.x >> 22) * vec3(scale, scale, 2.0 * scale);
}

// The number of steps of the cone's codes in a power of two, and the largest code. See encodeLog2().
const float kWidthSteps = 16.0;
const uint kMostWidthCode = 0x1FFu;
const float kSpreadSteps = 32.0;
const uint kMostSpreadCode = 0x3FFu;

uint packedState(EffectSample drawn, DirectionCode direction) {
    return drawn.outcome | direction.low << 4 | (direction.high >> 27) << 8 |
           encodeWidth(drawn.coneWidth, kWidthSteps, kMostWidthCode) << 13 |
           encodeLog2(drawn.coneSpread, kSpreadSteps, kMostSpreadCode) << 22;
}

void putStart(uint place, EffectSample drawn, DirectionCode direction) {
    GLINT_PACKED_STARTS.data[place] = uvec4(floatBitsToUint(drawn.origin), packedState(drawn, direction));
}

void putAim(uint place, vec3 weight, uint directionHigh) {
    uvec2 code = encodeWeight(weight);
    GLINT_PACKED_AIMS.data[place] = uvec2(code.x, (directionHigh & 0x7FFFFFFu) | code.y << 27);
}

// Stores a whole sample. The weight of one that is not sent is stored for the march in screen space alone.
void putSample(uint place, EffectSample drawn, bool withWeight) {
    if (drawn.outcome != kRaySent) {
        GLINT_PACKED_STARTS.data[place].w = drawn.outcome;
        if (withWeight) {
            putAim(place, drawn.weight, 0u);
        }
        return;
    }
    DirectionCode direction = encodeDirection(drawn.direction);
    putStart(place, drawn, direction);
    putAim(place, drawn.weight, direction.high);
}

// Stores another ray with the weight that the sample has.
void putRay(uint place, EffectSample drawn) {
    DirectionCode direction = encodeDirection(drawn.direction);
    putStart(place, drawn, direction);
    uint aim = GLINT_PACKED_AIMS.data[place].y;
    GLINT_PACKED_AIMS.data[place].y = (direction.high & 0x7FFFFFFu) | (aim & 0xF8000000u);
}

uint packedOutcome(uint place) {
    return GLINT_PACKED_STARTS.data[place].w & kPackedOutcomeMask;
}

void putOutcome(uint place, uint outcome) {
    GLINT_PACKED_STARTS.data[place].w = (GLINT_PACKED_STARTS.data[place].w & ~kPackedOutcomeMask) | outcome;
}

vec3 packedWeight(uint place) {
    uvec2 aim = GLINT_PACKED_AIMS.data[place];
    return decodeWeight(uvec2(aim.x, aim.y >> 27));
}

// `state` is start.w of a ray.
vec3 packedDirection(uint state, uint aim) {
    return decodeDirection(DirectionCode(state >> 4 & 0xFu, (aim & 0x7FFFFFFu) | (state >> 8) << 27));
}

EffectSample packedSample(uint place) {
    uvec4 start = GLINT_PACKED_STARTS.data[place];
    uvec2 aim = GLINT_PACKED_AIMS.data[place];
    EffectSample drawn;
    drawn.origin = uintBitsToFloat(start.xyz);
    drawn.outcome = start.w & kPackedOutcomeMask;
    drawn.direction = packedDirection(start.w, aim.y);
    drawn.coneWidth = decodeWidth(start.w >> 13 & kMostWidthCode, kWidthSteps);
    drawn.weight = decodeWeight(uvec2(aim.x, aim.y >> 27));
    drawn.coneSpread = decodeLog2(start.w >> 22, kSpreadSteps);
    return drawn;
}

RayRecord packedRay(uint place, uint target) {
    EffectSample drawn = packedSample(place);
    return RayRecord(drawn.origin, target, drawn.direction, drawn.coneWidth, drawn.coneSpread);
}

void putLight(uint place, vec3 light, uint outcome, uint path) {
    GLINT_PACKED_STARTS.data[place] =
        uvec4(floatBitsToUint(light), outcome | path << kPackedPathShift | kLitGeometry24 << 8);
}

#if GLINT_HITS_IN_SAMPLES

void putHit(uint place, HitRecord hit) {
    uint state = GLINT_PACKED_STARTS.data[place].w;
    uint width = encodeWidth(hit.coneWidth, kHitWidthSteps, kMostHitWidthCode);
    GLINT_PACKED_STARTS.data[place] =
        uvec4(hit.primitive, encodeBarycentric(hit.barycentricU) | width << 24,
              encodeBarycentric(hit.barycentricV) | (width >> 8) << 24 | (state >> 8) << 27,
              (state & 0xFFu) | hit.geometry << 8);
}

// Returns the geometry of a hit, kMissGeometry, or kLitGeometry24.
uint packedHitGeometry(uint place) {
    uint geometry = GLINT_PACKED_STARTS.data[place].w >> 8;
    return geometry == kNoGeometry24 ? kMissGeometry : geometry;
}

// Returns a hit that waits for its light. Other records are returned as misses.
HitRecord packedHit(uint place) {
    uvec4 start = GLINT_PACKED_STARTS.data[place];
    uint geometry = start.w >> 8;
    uint width = start.y >> 24 | (start.z >> 24 & 7u) << 8;
    return HitRecord(geometry >= kLitGeometry24 ? kMissGeometry : geometry, start.x, decodeBarycentric(start.y),
                     decodeBarycentric(start.z), decodeWidth(width, kHitWidthSteps));
}

// Returns the direction of a ray whose hit is stored.
vec3 directionOfHit(uint place) {
    uvec4 start = GLINT_PACKED_STARTS.data[place];
    return decodeDirection(DirectionCode(start.w >> 4 & 0xFu,
                                         (GLINT_PACKED_AIMS.data[place].y & 0x7FFFFFFu) | (start.z >> 27) << 27));
}

#endif
