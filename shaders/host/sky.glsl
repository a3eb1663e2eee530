// The sky's radiance. Here it is an environment map, or a gradient that is linear in the cosine: from horizon to zenith
// above, and from horizon to ground below. Directions are unit vectors of the world.
//
// In packages whose sky is a light (--sky-light), this file also samples directions with a known density.
#include "bsdf/constants.glsl"
#include "host/resources.glsl"

#if GLINT_SKY_LIGHT
// A direction that is chosen for the sky's light.
struct SkySample {
    vec3 direction;
    float density;  // by solid angle
};

// The largest float below 1.
const float kBelowWhole = 0.99999994;
#endif

#if GLINT_ENVIRONMENT_MAP

// An equirectangular map. Each level holds the means over the lobes of one roughness.
layout(set = GLINT_BINDING_ENVIRONMENT_SET, binding = GLINT_BINDING_ENVIRONMENT) uniform sampler2D environmentMap;

// v is the polar angle from +Y; u is the azimuth from +X towards +Z, with +X at the middle of the map. Both come from
// atan, which keeps its digits at the poles.
vec2 environmentCoordinates(vec3 direction) {
    // At a pole any azimuth is right, and atan(0, 0) is undefined.
    float across = length(direction.xz);
    float azimuth = across > 0.0 ? atan(direction.z, direction.x) : 0.0;
    return vec2(azimuth / (2.0 * kPi) + 0.5 + GLINT_FRAME.environmentTurn, atan(across, direction.y) / kPi);
}

// The light that a lobe of this roughness about the direction sees. An explicit level avoids a seam where u jumps.
vec3 hostSkyAround(vec3 direction, float roughness) {
    float level = roughness * (GLINT_FRAME.environmentLevels - 1.0);
    return textureLod(environmentMap, environmentCoordinates(direction), level).rgb * GLINT_FRAME.environmentScale;
}

vec3 hostSky(vec3 direction) {
    return hostSkyAround(direction, 0.0);
}

// Irradiance over π from nine spherical harmonics. With a small bright sun they are negative where there is hardly any
// light.
vec3 hostSkyIrradianceOverPi(vec3 n) {
    vec3 sum = GLINT_FRAME.skyHarmonics[0] + GLINT_FRAME.skyHarmonics[1] * n.x + GLINT_FRAME.skyHarmonics[2] * n.y +
               GLINT_FRAME.skyHarmonics[3] * n.z + GLINT_FRAME.skyHarmonics[4] * (3.0 * n.y * n.y - 1.0) +
               GLINT_FRAME.skyHarmonics[5] * (n.x * n.y) + GLINT_FRAME.skyHarmonics[6] * (n.y * n.z) +
               GLINT_FRAME.skyHarmonics[7] * (n.x * n.z) + GLINT_FRAME.skyHarmonics[8] * (n.x * n.x - n.z * n.z);
    return max(sum, vec3(0.0));
}

#if GLINT_SKY_LIGHT

// The distribution of the map has cells in rows and columns, which are uniform in the polar angle and the azimuth. It
// holds running sums of counts: those of the rows, then for each row those of its columns. Every cell has a count.

// Returns the cell, of `cells` whose running sums begin at `first`, that a number below kSkyCounts falls into.
uint skyCellOf(uint first, uint cells, uint number) {
    uint below = 0u;
    uint size = cells;
    while (size > 1u) {
        uint lower = size / 2u;
        if (number >= GLINT_FRAME.skyCounts.data[first + below + lower - 1u]) {
            below += lower;
            size -= lower;
        } else {
            size = lower;
        }
    }
    return below;
}

// The running sum before the cell, and its count.
uvec2 skyCountOf(uint first, uint cell) {
    uint begin = cell == 0u ? 0u : GLINT_FRAME.skyCounts.data[first + cell - 1u];
    return uvec2(begin, GLINT_FRAME.skyCounts.data[first + cell] - begin);
}

// The product of both chances over the cell's solid angle, 4π/columns times the difference of sin²(θ/2).
float skyCellDensity(uint row, uint rowCount, uint columnCount) {
    float half_ = kPi / (2.0 * float(GLINT_FRAME.skyRows));
    float rows = sin(half_ * float(2u * row + 1u)) * sin(half_);
    precise float chance = (float(rowCount) / float(kSkyCounts)) * (float(columnCount) / float(kSkyCounts));
    precise float density = chance * float(GLINT_FRAME.skyColumns) / (4.0 * kPi * rows);
    return density;
}

float hostSkyDensity(vec3 direction) {
    precise vec2 place = environmentCoordinates(direction);
    precise float across = fract(place.x) * float(GLINT_FRAME.skyColumns);
    precise float down = place.y * float(GLINT_FRAME.skyRows);
    uint column = min(uint(across), GLINT_FRAME.skyColumns - 1u);
    uint row = min(uint(max(down, 0.0)), GLINT_FRAME.skyRows - 1u);
    return skyCellDensity(row, skyCountOf(0u, row).y,
                          skyCountOf(GLINT_FRAME.skyRows + row * GLINT_FRAME.skyColumns, column).y);
}

// `u` chooses the cell. Its numbers are multiples of 2^-24, as the counts are; `within` chooses the place between them.
SkySample hostSampleSky(vec2 u, vec2 within) {
    uvec2 number = uvec2(u * float(kSkyCounts));
    uint row = skyCellOf(0u, GLINT_FRAME.skyRows, number.x);
    uvec2 ofRow = skyCountOf(0u, row);
    uint first = GLINT_FRAME.skyRows + row * GLINT_FRAME.skyColumns;
    uint column = skyCellOf(first, GLINT_FRAME.skyColumns, number.y);
    uvec2 ofColumn = skyCountOf(first, column);
    precise vec2 part = min((vec2(number - uvec2(ofRow.x, ofColumn.x)) + within) / vec2(ofRow.y, ofColumn.y),
                            vec2(kBelowWhole));
    // The place is uniform in sin²(θ/2), which keeps its digits at the pole.
    float half_ = kPi / (2.0 * float(GLINT_FRAME.skyRows));
    precise float above = sin(half_ * float(row));
    precise float below = sin(half_ * float(row + 1u));
    precise float square = mix(above * above, below * below, part.x);
    precise float sine = 2.0 * sqrt(max(square * (1.0 - square), 0.0));
    precise float turns = (float(column) + part.y) / float(GLINT_FRAME.skyColumns) - 0.5 - GLINT_FRAME.environmentTurn;
    precise float azimuth = 2.0 * kPi * turns;
    precise vec3 direction = vec3(sine * cos(azimuth), 1.0 - 2.0 * square, sine * sin(azimuth));
    return SkySample(direction, skyCellDensity(row, ofRow.y, ofColumn.y));
}

#endif

#else

vec3 hostSky(vec3 direction) {
    vec3 pole = direction.y >= 0.0 ? GLINT_FRAME.skyZenith : GLINT_FRAME.skyGround;
    return mix(GLINT_FRAME.skyHorizon, pole, min(abs(direction.y), 1.0));
}

// Irradiance over π from the first two orders of spherical harmonics (Ramamoorthi and Hanrahan 2001): the mean of the
// radiance plus 2/3 of its first moment. Both are exact for this sky.
vec3 hostSkyIrradianceOverPi(vec3 normal) {
    vec3 mean = 0.25 * (2.0 * GLINT_FRAME.skyHorizon + GLINT_FRAME.skyZenith + GLINT_FRAME.skyGround);
    vec3 slope = 0.5 * (GLINT_FRAME.skyZenith - GLINT_FRAME.skyGround);
    return mean + (2.0 / 3.0) * slope * normal.y;
}

// The sky in one direction. A rough lobe sees the sky's mean around it.
vec3 hostSkyAround(vec3 direction, float roughness) {
    return mix(hostSky(direction), hostSkyIrradianceOverPi(direction), roughness);
}

#if GLINT_SKY_LIGHT

// The luminance (ITU-R BT.709) at horizon, zenith and ground. A small amount is added, so that every direction is
// possible and a black sky is uniform.
vec3 skyWeights() {
    const vec3 kLuminance = vec3(0.2126, 0.7152, 0.0722);
    precise vec3 weights = vec3(dot(GLINT_FRAME.skyHorizon, kLuminance), dot(GLINT_FRAME.skyZenith, kLuminance),
                                dot(GLINT_FRAME.skyGround, kLuminance));
    precise float sum = 2.0 * weights.x + weights.y + weights.z;
    precise vec3 possible = sum > 0.0 ? weights + 0.0025 * sum : vec3(1.0);
    return possible;
}

// The weight is linear in the cosine on both sides of the horizon, and so is the density.
float skyDensityAt(vec3 weights, float cosine) {
    precise float weight = mix(weights.x, cosine >= 0.0 ? weights.y : weights.z, min(abs(cosine), 1.0));
    precise float density = weight / (kPi * (2.0 * weights.x + weights.y + weights.z));
    return density;
}

float hostSkyDensity(vec3 direction) {
    return skyDensityAt(skyWeights(), direction.y);
}

// Chooses a side of the horizon, and inverts the linear density there. The gradient needs no table.
SkySample hostSampleSky(vec2 u, vec2 within) {
    vec3 weights = skyWeights();
    precise float random = u.x + within.x / 16777216.0;
    precise float above = (weights.x + weights.y) / (2.0 * weights.x + weights.y + weights.z);
    bool up = random < above;
    precise float part = up ? random / above : (random - above) / (1.0 - above);
    float pole = up ? weights.y : weights.z;
    precise float both = part * (weights.x + pole);
    precise float height = both / (weights.x + sqrt(mix(weights.x * weights.x, pole * pole, clamp(part, 0.0, 1.0))));
    precise float cosine = clamp(height, 0.0, 1.0) * (up ? 1.0 : -1.0);
    precise float sine = sqrt(max((1.0 - cosine) * (1.0 + cosine), 0.0));
    precise float azimuth = 2.0 * kPi * (u.y + within.y / 16777216.0);
    precise vec3 direction = vec3(sine * cos(azimuth), cosine, sine * sin(azimuth));
    return SkySample(direction, skyDensityAt(weights, cosine));
}

#endif

#endif
