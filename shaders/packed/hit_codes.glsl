// Parts of a hit in fewer bits, for packed records of samples.
#include "hit/bindings.glsl"

#if GLINT_SAMPLE_RECORD_PACKED

// Encodes a number as steps of its logarithm, `steps` of which make a factor of two, from 2^-20 as 1 to the largest
// code. 0 stands for 0. Widths are encoded in units of FrameConstants::lengthUnit.
uint encodeLog2(float value, float steps, uint most) {
    precise float code = (log2(value) + 20.0) * steps;
    return value > 0.0 ? uint(clamp(roundEven(code), 1.0, float(most))) : 0u;
}

float decodeLog2(uint code, float steps) {
    precise float power = float(code) / steps - 20.0;
    return code > 0u ? exp2(power) : 0.0;
}

uint encodeWidth(float width, float steps, uint most) {
    precise float units = width * GLINT_FRAME.perLengthUnit;
    return encodeLog2(units, steps, most);
}

float decodeWidth(uint code, float steps) {
    precise float width = decodeLog2(code, steps) * GLINT_FRAME.lengthUnit;
    return width;
}

// The width of a cone at a hit: 11 bits, exact to 1/128 of a mip level.
const float kHitWidthSteps = 64.0;
const uint kMostHitWidthCode = 0x7FFu;

// Barycentric coordinates in 24 bits keep the precision that float has for numbers above a half.
uint encodeBarycentric(float value) {
    precise float steps = value * 16777216.0;
    return uint(clamp(roundEven(steps), 0.0, 16777215.0));
}

// `code` may have more bits above.
float decodeBarycentric(uint code) {
    return float(code & 0xFFFFFFu) * (1.0 / 16777216.0);
}

#if GLINT_HITS_IN_SAMPLES
// Returns barycentric coordinates, or a cone's width, as a record keeps them. Strategies that keep no record round
// their hits in the same way, so all pictures are the same.
vec2 keptBarycentrics(vec2 barycentrics) {
    return vec2(decodeBarycentric(encodeBarycentric(barycentrics.x)),
                decodeBarycentric(encodeBarycentric(barycentrics.y)));
}

float keptConeWidth(float width) {
    return decodeWidth(encodeWidth(width, kHitWidthSteps, kMostHitWidthCode), kHitWidthSteps);
}
#endif

#endif
