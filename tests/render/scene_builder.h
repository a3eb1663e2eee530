// Builds small scenes by hand, for pictures whose pixels can be computed by hand.
#pragma once

#include "gltf/scene.h"

#include <string>

namespace glint::testing {

// Returns a scene without meshes, cameras or lights.
gltf::Scene emptyScene();
// The same with the camera of addCamera().
gltf::Scene sceneWithCamera();

// Each of these returns the index of what it appends.
int addMaterial(gltf::Scene& scene, const materials::Material& material);
materials::Material unlitMaterial(gltf::Float3 color);
// Returns an opaque dielectric.
materials::Material paint(gltf::Float3 color, float roughness = 0.5F);
// Returns a perfect mirror: metallic, roughness 0, white.
materials::Material mirrorMaterial();

// Returns a parallelogram with the corners `corner`, + right, + right + up, + up; its front faces right × up.
// Texture coordinates are (0, 1) at `corner` and (1, 0) at the opposite corner, so that an image stands
// upright.
gltf::Primitive makeQuad(int material, gltf::Float3 corner, gltf::Float3 right, gltf::Float3 up);
// Adds a mesh with one primitive.
int addMesh(gltf::Scene& scene, gltf::Primitive primitive);
// `world` is column-major.
void addInstance(gltf::Scene& scene, int mesh, const gltf::Matrix4& world);
void addInstance(gltf::Scene& scene, int mesh);
// Adds an instance of a mesh of one quad, whose material is an index or is added, too.
void addQuad(gltf::Scene& scene, int material, gltf::Float3 corner, gltf::Float3 right, gltf::Float3 up);
void addQuad(gltf::Scene& scene, const materials::Material& material, gltf::Float3 corner, gltf::Float3 right,
             gltf::Float3 up);
gltf::Matrix4 scaling(double x, double y, double z);

// Adds an image of width × height RGBA8 texels with nearest sampling. Returns the texture.
int addTexture(gltf::Scene& scene, int width, int height, std::vector<std::uint8_t> rgba8);

// Adds a perspective camera at the origin that looks along -Z, 90° by 90° if the image is square.
void addCamera(gltf::Scene& scene);
void addDirectionalLight(gltf::Scene& scene, gltf::Float3 direction, float lux);

}  // namespace glint::testing
