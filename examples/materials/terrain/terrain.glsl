// Grounds by an attribute of the vertices. Each ground has patches of its own height; where two meet, the higher one
// shows, with a narrow transition. Mishkinis, "Advanced Terrain Texture Splatting" (2013), blends textures in this way.
#include "hit/noise.glsl"
#include "hit/surface_values.glsl"

// The difference of heights over which two grounds mix.
const float kTerrainTransition = 0.15;

void terrainSurface(Hit hit, Features features, inout SurfaceValues values) {
    vec3 p = hit.position / GLINT_MATERIAL_TERRAIN_SCALE(hit);
    vec3 patches = vec3(valueNoise(2.0 * p), valueNoise(0.7 * p + 17.0), valueNoise(p - 29.0));
    vec3 height = hit.attributes.terrainShares + GLINT_MATERIAL_TERRAIN_RELIEF(hit) * (patches - 0.5);
    float top = max(height.x, max(height.y, height.z));
    vec3 weights = max(height - (top - kTerrainTransition), 0.0);
    weights /= weights.x + weights.y + weights.z;
    float grain = 0.75 + 0.5 * valueNoise(7.0 * p);
    values.color.rgb *= weights.x * grain * GLINT_MATERIAL_TERRAIN_GRASS(hit) +
                        weights.y * grain * GLINT_MATERIAL_TERRAIN_ROCK(hit) +
                        weights.z * GLINT_MATERIAL_TERRAIN_SNOW(hit);
    values.color.rgb = min(values.color.rgb, vec3(1.0));
    values.metallic = 0.0;
    values.roughness = dot(weights, vec3(0.9, 0.75, 0.4));
}
