// The functions that Glint's library needs from the shader that includes it. The host writes their bodies; those that
// the package's materials never need may be left out. Lengths are metres, directions are unit vectors of the world,
// and colours are linear.
#ifndef GLINT_HOST
#define GLINT_HOST

// The host's data about a geometry of an instance. The shader ID and the key of a primitive are in
// tables.bin.
struct GlintGeometry {
    uint shaderId;       // the case that shades it
    uint material;       // the number of its record, from glintHostMaterials()
    uint featureLobes;   // its key: lobes
    uint featureInputs;  // inputs
    uint featureModel;   // the model of a pack; 0: one of glTF's
    uvec4 featureOwn;    // the model's own features
};

// A light at a point, without shadows.
struct GlintLight {
    vec3 direction;   // towards the light
    float distance;   // to it; 1e30 for a light at infinity
    vec3 irradiance;  // on a surface that faces it
};

// `geometry` is the number in GlintHit::geometry. Glint only hands it to these functions.
GlintGeometry glintHostGeometry(const uint geometry);

// The matrix from the mesh's space to the world, as in gl_ObjectToWorldEXT.
mat4x3 glintHostObjectToWorld(const uint geometry);

// The number of the vertex at a corner. Triangle t has the corners 3t, 3t + 1 and 3t + 2.
uint glintHostVertex(const uint geometry, const uint corner);

// Returns the position in the mesh's space. Counter-clockwise corners show the front.
vec3 glintHostPosition(const uint geometry, const uint vertex);

// The following attributes are read only if the key says that the geometry has them. Normal and tangent are unit
// vectors of the mesh's space; w = ±1 is the sign of the bitangent, which is w cross(normal, tangent). The coordinates
// of set 0 or 1 are those of glTF. A colour is linear RGBA.
vec3 glintHostNormal(const uint geometry, const uint vertex);
vec4 glintHostTangent(const uint geometry, const uint vertex);
vec2 glintHostTexCoord(const uint geometry, const uint vertex, const uint set);
vec4 glintHostColor(const uint geometry, const uint vertex);

// One number of a vertex's attributes that packs declare; `channel` counts over all of them, in the order of
// Package::attributes().
float glintHostAttribute(const uint geometry, const uint vertex, const uint channel);

// The address of an array of the package's material records (MaterialRecord in glint_tables.h): low word, high word.
uvec2 glintHostMaterials();

// The seconds that materials of packs may follow.
float glintHostTime();

// A filtered sample of a texture. Both indices are those of the material's TextureRecord. gradientX and gradientY are
// (du, dv) along the axes of the footprint, and 0 for the finest level.
vec4 glintHostTexture(const uint textureIndex, const uint samplerIndex, const vec2 uv, const vec2 gradientX,
                      const vec2 gradientY);

// The same for textures that packs declare with another dimension: arrays, cubes and 3D textures, by gradients or by a
// level.
vec4 glintHostArrayTexture(const uint textureIndex, const uint samplerIndex, const vec3 uvAndLayer,
                           const vec2 gradientX, const vec2 gradientY);
vec4 glintHostArrayTextureLevel(const uint textureIndex, const uint samplerIndex, const vec3 uvAndLayer,
                                const float level);
vec4 glintHostCubeTexture(const uint textureIndex, const uint samplerIndex, const vec3 direction, const float level);
vec4 glintHostVolumeTexture(const uint textureIndex, const uint samplerIndex, const vec3 place, const float level);

// The size of a texture's finest level in texels, and the most anisotropy that the sampler covers (1 for none).
vec3 glintHostTextureFilter(const uint textureIndex, const uint samplerIndex);

// The light at a point is the sum over the lights of its list. A host with many lights may return few: each stands for
// those that it was chosen from, and its irradiance is divided by the probability of the choice. An area light gives
// the sample of a point of it. `random` is uniform in [0, 1)³, and the same arguments give the same light.
uint glintHostLightCount(const vec3 position);
GlintLight glintHostLight(const uint index, const vec3 position, const vec3 random);

// The radiance from outside of the scene: from a direction; its mean over a lobe of that roughness about a direction;
// and its irradiance on a surface with that normal, over π.
vec3 glintHostSky(const vec3 direction);
vec3 glintHostSkyAround(const vec3 direction, const float roughness);
vec3 glintHostSkyIrradianceOverPi(const vec3 normal);

// A number in [0, 1). `number` is that of GlintHit::number.
float glintHostRandom(const uint number, const uint dimension);

#endif
