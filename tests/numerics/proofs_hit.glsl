// Claims about the functions that find a hit, its light and its place in the picture; proofs_hit.cpp has their domains.
#include "bsdf/constants.glsl"
#include "hit/geometry.glsl"
#include "hit/accumulate.glsl"
#include "order/direction_bin.glsl"
#include "hit/lod.glsl"
#include "hit/noise.glsl"
#include "light/punctual.glsl"
#include "hit/random.glsl"
#include "hit/sequence.glsl"
#include "effects/screen_ray.glsl"
#include "numerics/proof_vectors.glsl"

PROOF(OctahedralEncode) {
    vec2 e = octahedralEncode(UNIT(0));
    o[0] = e.x;
    o[1] = e.y;
}

PROOF(OctahedralDecode) {
    vec3 v = octahedralDecode(vec2(i[0], i[1]));
    WRITE3(0, v);
    o[3] = dot(v, v);
}

PROOF(TransformPoint) {
    vec4 rows[3];
    rows[0] = vec4(i[0], i[1], i[2], i[3]);
    rows[1] = rows[0];
    rows[2] = rows[0];
    vec3 p = transformPoint(rows, vec3(i[4], i[5], i[6]));
    o[0] = p.x;
}

PROOF(TransformNormal) {
    vec3 rows[3];
    rows[0] = vec3(i[0], i[1], i[2]);
    rows[1] = rows[0];
    rows[2] = rows[0];
    vec3 n = transformNormal(rows, UNIT(3));
    o[0] = n.x;
}

// Lengths from 1e-37 to 1e37.
PROOF(DirectionOr) {
    vec3 v = directionOr(i[3] * UNIT(0), vec3(0.0, 0.0, 1.0));
    WRITE3(0, v);
    o[3] = dot(v, v);
}

PROOF(OnSide) {
    vec3 v = onSide(UNIT(0), UNIT(3));
    WRITE3(0, v);
}

PROOF(ConeAxes) {
    vec3 across;
    vec3 along;
    coneAxes(i[5], UNIT(0), directionAt(i[3], i[4], 0.0), across, along);
    WRITE3(0, across);
    WRITE3(3, along);
}

PROOF(SampleLight) {
    LightSample light = sampleLight(LightRecord(vec3(0.0), kLightSpot, UNIT(0), i[3], vec3(i[4]), i[5], i[6], 0.0),
                                    i[10] * UNIT(7));
    o[0] = light.distance;
    o[1] = light.irradiance.x;
    WRITE3(2, light.direction);
}

PROOF(SampleLightArea) {
    LightRecord sun = LightRecord(vec3(0.0), kLightDirectional, vec3(0.0, 0.0, -1.0), 0.0, vec3(1.0), 0.0, 0.0, i[0]);
    LightSample centre = LightSample(vec3(0.0, 0.0, 1.0), 1.0, vec3(1.0), 0u);
    vec3 l = sampleLightArea(sun, centre, vec2(i[1], i[2])).direction;
    WRITE3(0, l);
    o[3] = dot(l, l);
}

PROOF(RandomUnit) {
    o[0] = randomUnit(uint(i[0]), uint(i[1]), uint(i[2]), uint(i[3]));
}

PROOF(SequencePair) {
    vec2 u = sequencePair(uint(i[0]), uint(i[1]), uint(i[2]), uint(i[3]));
    o[0] = u.x;
    o[1] = u.y;
}

PROOF(IncludeSample) {
    RunningMean mean = includeSample(RunningMean(vec3(i[0]), vec3(i[1])), vec3(i[2]), uint(i[3]));
    o[0] = mean.mean.x;
    o[1] = mean.residual.x;
}

PROOF(DirectionBin) {
    o[0] = float(directionBin(UNIT(0), kBinningOctahedral));
    o[1] = float(directionBin(UNIT(0), kBinningSign));
}

PROOF(ValueNoise) {
    o[0] = valueNoise(vec3(i[0], i[1], i[2]));
}

PROOF(LeavesAt) {
    o[0] = leavesAt(i[0], i[1], i[2]);
}
