// Stone: all of it is noise in space, so it has no seams and needs no UVs. The level of detail follows the ray's cone.
#include "hit/noise.glsl"
#include "hit/surface_values.glsl"

// Four octaves; the mean is 0.5. Octaves that are finer than the footprint keep their mean.
float stoneNoise(vec3 p, float detail, float footprint) {
    float sum = 0.0;
    float total = 0.0;
    float share = 1.0;
    for (int octave = 0; octave < 4; ++octave) {
        float seen = clamp(2.0 - 2.0 * footprint, 0.0, 1.0);
        sum += share * mix(0.5, valueNoise(p), seen);
        total += share;
        share *= detail;
        p = 2.03 * p + 17.0;
        footprint *= 2.03;
    }
    return sum / total;
}

// 1 in a line where noise has its mean, 0 away from it.
float stoneLine(float noise, float width) {
    return 1.0 - smoothstep(0.0, width, abs(noise - 0.5));
}

float stoneCrack(Hit hit, vec3 p, float footprint) {
    return GLINT_MATERIAL_STONE_CRACKS(hit) *
           stoneLine(stoneNoise(GLINT_MATERIAL_STONE_CRACK_SCALE(hit) * p - 31.0, 0.5, footprint), 0.02);
}

// The height of the surface, in cells.
float stoneHeight(Hit hit, vec3 p, float footprint) {
    return GLINT_MATERIAL_STONE_RELIEF(hit) * (stoneNoise(3.0 * p + 5.0, 0.5, 3.0 * footprint) -
                                               2.0 * stoneCrack(hit, p, footprint));
}

void stoneSurface(Hit hit, Features features, inout SurfaceValues values) {
    float scale = GLINT_MATERIAL_STONE_SCALE(hit);
    vec3 p = hit.position / scale;
    // The axes of the footprint are in units of the edges.
    vec3 across = hit.footprint.x * hit.edges[0] + hit.footprint.y * hit.edges[1];
    float footprint = length(across) / scale;
    float detail = GLINT_MATERIAL_STONE_DETAIL(hit);

    float fold = stoneNoise(0.7 * p, detail, footprint) - 0.5;
    float height = GLINT_MATERIAL_STONE_BEDS(hit) * (p.y + 2.0 * GLINT_MATERIAL_STONE_FOLDS(hit) * fold);
    float bed = 0.5 + 0.5 * sin(2.0 * kPi * height) * clamp(2.0 - 4.0 * footprint, 0.0, 1.0);
    bed = mix(bed, stoneNoise(p + 7.0, detail, footprint), 0.5);
    bed = clamp(0.5 + GLINT_MATERIAL_STONE_CONTRAST(hit) * (bed - 0.5), 0.0, 1.0);
    vec3 color = mix(GLINT_MATERIAL_STONE_DARK(hit), GLINT_MATERIAL_STONE_LIGHT(hit), bed);

    float veinScale = GLINT_MATERIAL_STONE_VEIN_SCALE(hit);
    float vein = stoneLine(stoneNoise(veinScale * p + 3.0 * fold, detail, veinScale * footprint),
                           GLINT_MATERIAL_STONE_VEIN_WIDTH(hit));
    color = mix(color, GLINT_MATERIAL_STONE_VEIN_COLOR(hit), GLINT_MATERIAL_STONE_VEINS(hit) * vein);

    float grainScale = GLINT_MATERIAL_STONE_GRAIN_SCALE(hit);
    float share = GLINT_MATERIAL_STONE_GRAINS(hit);
    float seen = clamp(2.0 - 2.0 * grainScale * footprint, 0.0, 1.0);
    float grain = mix(share, smoothstep(0.9 - 0.8 * share, 1.0 - 0.8 * share, valueNoise(grainScale * p)) *
                                 (share > 0.0 ? 1.0 : 0.0), seen);
    color = mix(color, GLINT_MATERIAL_STONE_GRAIN_COLOR(hit), grain);

    float crack = stoneCrack(hit, p, footprint);
    values.color.rgb *= color * (1.0 - 0.8 * crack);
    values.metallic = 0.0;
    float wear = GLINT_MATERIAL_STONE_WEAR(hit);
    float patches = stoneNoise(1.7 * p - 11.0, detail, 1.7 * footprint);
    float worn = max(smoothstep(0.9 - wear, 1.1 - wear, patches), crack);
    values.roughness = mix(GLINT_MATERIAL_STONE_ROUGHNESS(hit), GLINT_MATERIAL_STONE_WORN_ROUGHNESS(hit), worn);

    // The slope of the relief, over a step that the footprint does not blur.
    float h = max(0.02, footprint);
    float here = stoneHeight(hit, p, footprint);
    vec3 slope = (vec3(stoneHeight(hit, p + vec3(h, 0.0, 0.0), footprint),
                       stoneHeight(hit, p + vec3(0.0, h, 0.0), footprint),
                       stoneHeight(hit, p + vec3(0.0, 0.0, h), footprint)) - here) / h;
    values.normal = directionOr(values.normal - (slope - values.normal * dot(values.normal, slope)), values.normal);
}
