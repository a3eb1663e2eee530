// Probes of the functions that find a hit, its light and its place in the picture.
#include "bsdf/exact.glsl"
#include "hit/geometry.glsl"
#include "hit/accumulate.glsl"
#include "order/direction_bin.glsl"
#include "hit/lod.glsl"
#include "light/punctual.glsl"
#include "hit/random.glsl"
#include "hit/sequence.glsl"
#include "effects/screen_ray.glsl"
#include "numerics/probe_vectors.glsl"

// hit/geometry.glsl

PROBE(BuildBasis) {
    vec3 tangent;
    vec3 bitangent;
    buildBasis(VEC3(0), tangent, bitangent);
    WRITE3(0, tangent);
    WRITE3(3, bitangent);
}

PROBE(Octahedral) {
    vec3 v = octahedralDecode(octahedralEncode(VEC3(0)));
    WRITE3(0, v);
}

PROBE(DirectionOr) {
    vec3 v = directionOr(VEC3(0), vec3(0.0, 0.0, 1.0));
    WRITE3(0, v);
}

PROBE(OnSide) {
    vec3 v = onSide(VEC3(0), VEC3(3));
    WRITE3(0, v);
}

// The scale is the sum of the absolute terms.
PROBE(TransformPoint) {
    vec4 rows[3];
    rows[0] = VEC4(0);
    rows[1] = VEC4(4);
    rows[2] = VEC4(8);
    vec3 p = transformPoint(rows, VEC3(12));
    WRITE3(0, p);
    vec3 terms = abs(VEC3(12));
    o[3] = max(max(dot(abs(VEC4(0)), vec4(terms, 1.0)), dot(abs(VEC4(4)), vec4(terms, 1.0))),
               dot(abs(VEC4(8)), vec4(terms, 1.0)));
}

PROBE(TransformNormal) {
    vec3 rows[3];
    rows[0] = VEC3(0);
    rows[1] = VEC3(3);
    rows[2] = VEC3(6);
    vec3 n = transformNormal(rows, VEC3(9));
    WRITE3(0, n);
    vec3 terms = abs(VEC3(9));
    o[3] = max(max(dot(abs(VEC3(0)), terms), dot(abs(VEC3(3)), terms)), dot(abs(VEC3(6)), terms));
}

PROBE(PlaneError) {
    vec4 rows[3];
    rows[0] = VEC4(15);
    rows[1] = VEC4(19);
    rows[2] = VEC4(23);
    vec3 cofactors[3];
    cofactors[0] = VEC3(27);
    cofactors[1] = VEC3(30);
    cofactors[2] = VEC3(33);
    o[0] = planeError(VEC3(0), TrianglePoint(VEC3(3), VEC3(6), VEC3(9), VEC3(12)), rows, cofactors);
}

// order/direction_bin.glsl

// The distance to the nearest edge of the direction's bin, in components of the direction or in cells of the
// map.
float binEdge(vec3 v, uint binning) {
    if (binning == kBinningNone) {
        return 1.0;
    }
    if (binning == kBinningSign) {
        return min(min(abs(v.x), abs(v.y)), abs(v.z));
    }
    vec2 cell = octahedralEncode(v) * 4.0 + 4.0;
    vec2 edge = abs(cell - clamp(round(cell), vec2(1.0), vec2(7.0)));
    // The lower hemisphere is cut along the planes x = 0 and y = 0, which meet the border of the map.
    float seam = v.z < 0.0 ? 4.0 * min(abs(v.x), abs(v.y)) / (abs(v.x) + abs(v.y) + abs(v.z)) : 1.0;
    return min(min(edge.x, edge.y), seam);
}

PROBE(DirectionBin) {
    o[0] = binEdge(VEC3(1), uint(i[0]));
    o[1] = float(directionBin(VEC3(1), uint(i[0])));
}

// hit/lod.glsl

// The axis along the ray over its length, for a cone of width 1. The closer the ellipse is to a circle, the
// less its axes are determined, and the less they matter.
PROBE(ConeAxes) {
    vec3 across;
    vec3 along;
    coneAxes(1.0, VEC3(0), VEC3(3), across, along);
    vec3 unit = along * max(abs(accurateDot(VEC3(0), VEC3(3))), 0.01);
    WRITE3(0, across);
    WRITE3(3, unit);
    o[6] = 1.0 / max(length(accurateCrossOfSum(VEC3(0), VEC3(3), vec3(0.0))), 1e-7);
}

PROBE(InEdges) {
    vec2 found = inEdges(VEC3(0), VEC3(3), VEC3(6));
    o[0] = found.x;
    o[1] = found.y;
    o[2] = max(abs(found.x), abs(found.y));
}

PROBE(ConeGradients) {
    vec4 g = coneGradients(VEC4(0), VEC4(4), VEC2(8), i[10]);
    o[0] = g.x;
    o[1] = g.y;
    o[2] = g.z;
    o[3] = g.w;
    o[4] = max(max(abs(g.x), abs(g.y)), max(abs(g.z), abs(g.w)));
}

// light/punctual.glsl

PROBE(SampleLight) {
    LightSample light =
        sampleLight(LightRecord(VEC3(0), uint(i[3]), VEC3(4), i[7], VEC3(8), i[11], i[12], 0.0), VEC3(13));
    WRITE3(0, light.irradiance);
    // The factor of the intensity at the distance, before window and cone, which end at 0.
    o[3] = uint(i[3]) == kLightDirectional ? 1.0 : 1.0 / max(light.distance * light.distance, 1e-6);
}

PROBE(SampleLightDirection) {
    LightSample light =
        sampleLight(LightRecord(VEC3(0), uint(i[3]), VEC3(4), i[7], VEC3(8), i[11], i[12], 0.0), VEC3(13));
    WRITE3(0, light.direction);
    o[3] = light.distance / (length(VEC3(0) - VEC3(13)) + 1.0);
}

// hit/accumulate.glsl

float givenSample(float pixel, float value, float spread, uint index) {
    return value * (1.0 + spread * (randomUnit(uint(pixel), index, 0u, 0u) - 0.5));
}

// The mean of i[2] samples that spread by i[3] about i[1].
PROBE(RunningMean) {
    RunningMean mean = RunningMean(vec3(0.0), vec3(0.0));
    uint count = uint(i[2]);
    for (uint k = 0u; k < count; ++k) {
        mean = includeSample(mean, vec3(givenSample(i[0], i[1], i[3], k)), k);
    }
    o[0] = mean.mean.x;
}

// hit/random.glsl

PROBE(RandomUnit) {
    o[0] = randomUnit(uint(i[0]) * 65537u + uint(i[1]), uint(i[2]), uint(i[3]), uint(i[4]));
}

// hit/sequence.glsl

PROBE(SequencePair) {
    vec2 u = sequencePair(uint(i[0]) * 65537u + uint(i[1]), uint(i[2]), uint(i[3]), uint(i[4]));
    o[0] = u.x;
    o[1] = u.y;
}

// effects/screen_ray.glsl

#define GIVEN_RAY(ray)                                                      \
    ScreenRay ray = screenRay(VEC4(0), VEC4(4), VEC2(8), kFarDistance);     \
    float reach = ray.distanceOverEnd / ray.inverseEnd

// A pixel of the line, in widths and heights of the image. The scale is the size of the sums that make the
// line's end, over its w. They cancel where a ray from far away ends at the near plane.
PROBE(ScreenPixel) {
    GIVEN_RAY(ray);
    vec2 pixel = screenPixel(ray, i[10]) / VEC2(8);
    o[0] = pixel.x;
    o[1] = pixel.y;
    vec4 terms = abs(VEC4(0)) + reach * abs(VEC4(4));
    o[2] = 1.0 + i[10] * max(max(terms.x, terms.y), terms.w) * ray.inverseEnd;
}

// The distance along the ray to that pixel. The scale is the distance itself, times the magnification by w at
// the line's end.
PROBE(ScreenDistance) {
    GIVEN_RAY(ray);
    o[0] = screenDistance(ray, i[10]);
    float terms = i[3] + reach * abs(i[7]);
    float end = 1.0 / ray.inverseEnd;
    o[1] = o[0] * (1.0 + (1.0 - i[10]) * terms / mix(end, i[3], i[10]));
}
