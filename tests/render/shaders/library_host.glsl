// The host of Glint's library in the tests: Glint's own scene, by other ways than those of Glint's shaders.
#include "hit/bindings.glsl"
#include "hit/random.glsl"
#extension GL_EXT_buffer_reference_uvec2 : require

GlintGeometry glintHostGeometry(const uint geometry) {
    GeometryRecord record = GLINT_FRAME.geometries.data[geometry];
    return GlintGeometry(record.shaderId, record.materialIndex, record.featureLobes, record.featureInputs,
                         record.featureModel, record.featureOwn);
}

mat4x3 glintHostObjectToWorld(const uint geometry) {
    InstanceRecord instance = GLINT_FRAME.instances.data[GLINT_FRAME.geometries.data[geometry].instanceIndex];
    return transpose(mat3x4(instance.objectToWorld[0], instance.objectToWorld[1], instance.objectToWorld[2]));
}

uint glintHostVertex(const uint geometry, const uint corner) {
    return GLINT_FRAME.geometries.data[geometry].indices.data[corner];
}

vec3 glintHostPosition(const uint geometry, const uint vertex) {
    return GLINT_FRAME.geometries.data[geometry].positions.data[vertex];
}

vec3 glintHostNormal(const uint geometry, const uint vertex) {
    return GLINT_FRAME.geometries.data[geometry].normals.data[vertex];
}

vec4 glintHostTangent(const uint geometry, const uint vertex) {
    return GLINT_FRAME.geometries.data[geometry].tangents.data[vertex];
}

vec2 glintHostTexCoord(const uint geometry, const uint vertex, const uint set) {
    GeometryRecord record = GLINT_FRAME.geometries.data[geometry];
    return set == 0u ? record.texCoords0.data[vertex] : record.texCoords1.data[vertex];
}

vec4 glintHostColor(const uint geometry, const uint vertex) {
    return GLINT_FRAME.geometries.data[geometry].colors.data[vertex];
}

// The tests' scene has no such attributes.
float glintHostAttribute(const uint geometry, const uint vertex, const uint channel) {
    return 0.0;
}

float glintHostTime() {
    return GLINT_FRAME.time;
}

uvec2 glintHostMaterials() {
    return uvec2(GLINT_FRAME.materials);
}

vec4 glintHostTexture(const uint textureIndex, const uint samplerIndex, const vec2 uv, const vec2 gradientX,
                      const vec2 gradientY) {
    return textureGrad(sampler2D(sceneTextures[nonuniformEXT(textureIndex)],
                                 sceneSamplers[nonuniformEXT(samplerIndex)]),
                       uv, gradientX, gradientY);
}

vec3 glintHostTextureFilter(const uint textureIndex, const uint samplerIndex) {
#ifndef GLINT_TEST_WITHOUT_TEXTURES
    for (uint m = 0u; m < kTestMaterials; ++m) {
        for (uint i = 0u; i < GLINT_FRAME.materials.data[m].textures.length(); ++i) {
            TextureRecord record = GLINT_FRAME.materials.data[m].textures[i];
            if (record.texels.x > 0.0 && record.textureIndex == textureIndex && record.samplerIndex == samplerIndex) {
                return vec3(record.texels, record.anisotropy);
            }
        }
    }
#endif
    return vec3(0.0);
}

uint glintHostLightCount(const vec3 position) {
    return GLINT_FRAME.lightCount;
}

// The tests' lights are directional.
GlintLight glintHostLight(const uint index, const vec3 position, const vec3 random) {
    LightRecord light = GLINT_FRAME.lights.data[index];
    return GlintLight(-light.direction, 1e30, light.intensity);
}

vec3 glintHostSky(const vec3 direction) {
    vec3 pole = direction.y >= 0.0 ? GLINT_FRAME.skyZenith : GLINT_FRAME.skyGround;
    return mix(GLINT_FRAME.skyHorizon, pole, min(abs(direction.y), 1.0));
}

vec3 glintHostSkyIrradianceOverPi(const vec3 normal) {
    return 0.25 * (2.0 * GLINT_FRAME.skyHorizon + GLINT_FRAME.skyZenith + GLINT_FRAME.skyGround) +
           (GLINT_FRAME.skyZenith - GLINT_FRAME.skyGround) * (normal.y / 3.0);
}

vec3 glintHostSkyAround(const vec3 direction, const float roughness) {
    return mix(glintHostSky(direction), glintHostSkyIrradianceOverPi(direction), roughness);
}

float glintHostRandom(const uint number, const uint dimension) {
    return randomUnit(number, GLINT_FRAME.sampleIndex, GLINT_FRAME.seed, dimension);
}
