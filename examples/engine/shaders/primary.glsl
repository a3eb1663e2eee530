// Lights what the camera sees, with Glint's materials in a shader of the engine's own, and lists a ray for what
// reflects. Below are the functions that the library asks for, in terms of the engine's scene. primary.comp and
// primary.rgen trace the shadow rays.
#include "glint_library.glsl"
#include "engine.glsl"

layout(set = 0, binding = 0, rg32ui) uniform readonly uimage2D seenImage;
layout(set = 1, binding = 4) uniform accelerationStructureEXT structure;
layout(set = 1, binding = 5) uniform texture2D textures[];
layout(set = 1, binding = 6) uniform sampler samplers[];

GlintGeometry glintHostGeometry(const uint number) {
    EngineGeometry geometry = FRAME.geometries.data[number];
    return GlintGeometry(geometry.shaderId, geometry.material, geometry.featureLobes, geometry.featureInputs,
                         geometry.featureModel, geometry.featureOwn);
}

mat4x3 glintHostObjectToWorld(const uint number) {
    uint row = 3u * FRAME.geometries.data[number].instance;
    return mat4x3(transpose(mat3x4(FRAME.transforms.rows[row], FRAME.transforms.rows[row + 1u],
                                   FRAME.transforms.rows[row + 2u])));
}

uint glintHostVertex(const uint number, const uint corner) {
    return storedIndex(FRAME.geometries.data[number].indices, FRAME.compact, corner);
}

vec3 glintHostPosition(const uint number, const uint vertex) {
    return storedPosition(FRAME.geometries.data[number].vertices, FRAME.compact, vertex);
}

vec3 glintHostNormal(const uint number, const uint vertex) {
    return storedNormal(FRAME.geometries.data[number].vertices, FRAME.compact, vertex);
}

vec4 glintHostTangent(const uint number, const uint vertex) {
    return storedTangent(FRAME.geometries.data[number].vertices, FRAME.compact, vertex);
}

vec2 glintHostTexCoord(const uint number, const uint vertex, const uint set) {
    return storedTexCoord(FRAME.geometries.data[number].vertices, FRAME.compact, vertex, set);
}

vec4 glintHostColor(const uint number, const uint vertex) {
    return storedColor(FRAME.geometries.data[number].vertices, FRAME.compact, vertex);
}

uvec2 glintHostMaterials() {
    return FRAME.materials;
}

vec4 glintHostTexture(const uint image, const uint filtering, const vec2 uv, const vec2 gradientX,
                      const vec2 gradientY) {
    return textureGrad(sampler2D(textures[nonuniformEXT(image)], samplers[nonuniformEXT(filtering)]), uv, gradientX,
                       gradientY);
}

// The engine's samplers have no anisotropy.
vec3 glintHostTextureFilter(const uint image, const uint filtering) {
    return vec3(vec2(FRAME.textureSizes.data[image]), FRAME.anisotropy);
}

uint glintHostLightCount(const vec3 position) {
    return FRAME.sunCount;
}

GlintLight glintHostLight(const uint index, const vec3 position, const vec3 random) {
    return GlintLight(-FRAME.suns.data[index].direction, 1e18, FRAME.suns.data[index].lux);
}

vec3 glintHostSky(const vec3 direction) {
    return sky(direction);
}

// The mean of the sky, plus two thirds of its first moment.
vec3 glintHostSkyIrradianceOverPi(const vec3 normal) {
    return 0.25 * (2.0 * FRAME.skyHorizon + FRAME.skyZenith + FRAME.skyGround) +
           (1.0 / 3.0) * (FRAME.skyZenith - FRAME.skyGround) * normal.y;
}

vec3 glintHostSkyAround(const vec3 direction, const float roughness) {
    return mix(sky(direction), glintHostSkyIrradianceOverPi(direction), roughness);
}

// One sun is always chosen, so there is nothing to draw.
float glintHostRandom(const uint number, const uint dimension) {
    return 0.5;
}

// Returns whether nothing stands between `origin` and a light.
bool isVisible(vec3 origin, vec3 direction, float distance);

// Where the pixel's ray meets the plane of a triangle, clamped to the triangle (Möller and Trumbore 1997).
vec2 barycentrics(vec3 direction, vec3 p0, vec3 edge1, vec3 edge2) {
    vec3 p = cross(direction, edge2);
    float determinant = dot(edge1, p);
    if (determinant == 0.0) {
        return vec2(0.0);
    }
    vec3 t = FRAME.cameraPosition - p0;
    float u = clamp(dot(t, p) / determinant, 0.0, 1.0);
    return vec2(u, clamp(dot(direction, cross(t, edge1)) / determinant, 0.0, 1.0 - u));
}

GlintHit primaryHit(uvec2 seen, vec3 direction, uint pixel) {
    mat4x3 toWorld = glintHostObjectToWorld(seen.x);
    vec3 corners[3];
    for (uint i = 0u; i < 3u; ++i) {
        corners[i] = toWorld * vec4(glintHostPosition(seen.x, glintHostVertex(seen.x, 3u * seen.y + i)), 1.0);
    }
    vec3 edge1 = corners[1] - corners[0];
    vec3 edge2 = corners[2] - corners[0];
    vec2 place = barycentrics(direction, corners[0], edge1, edge2);
    vec3 position = corners[0] + place.x * edge1 + place.y * edge2;
    return GlintHit(seen.x, seen.y, place, direction, FRAME.pixelSpread * distance(position, FRAME.cameraPosition),
                    pixel);
}

void lightPixel(uvec2 place) {
    if (place.x >= FRAME.width || place.y >= FRAME.height) {
        return;
    }
    uint pixel = place.x + place.y * FRAME.width;
    vec3 direction = cameraDirection(place);
    uvec2 seen = imageLoad(seenImage, ivec2(place)).xy;
    vec3 color = sky(direction);
    vec3 weight = vec3(0.0);
    if (seen.x != 0xFFFFFFFFu) {
        GlintSurface surface = glintSurface(primaryHit(seen, direction, pixel));
        GlintRadiance light = glintRadiance(surface);
        color = light.radiance;
        if (light.shadowDistance > 0.0 && isVisible(light.shadowOrigin, light.shadowDirection, light.shadowDistance)) {
            color += light.direct;
        }
        GlintMirror mirror = glintMirror(surface);
        if (dot(mirror.weight, vec3(1.0)) > 0.0) {
            color -= mirror.sky;
            weight = mirror.weight;
            vec3 origin = glintRayOrigin(surface, mirror.direction);
            uint index = atomicAdd(FRAME.rayCount.value, 1u);
            FRAME.rays.data[index] =
                EngineRay(origin, pixel, mirror.direction, FRAME.pixelSpread * distance(origin, FRAME.cameraPosition),
                          FRAME.pixelSpread);
        }
    }
    FRAME.colors.data[pixel] = vec4(color, 1.0);
    FRAME.weights.data[pixel] = vec4(weight, 0.0);
}
