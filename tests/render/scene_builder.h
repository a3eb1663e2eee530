// Builds small scenes by hand, for pictures whose pixels can be computed by hand.
#pragma once

#include "gltf/scene.h"

#include <string>

namespace glint::testing {

// Returns a scene without meshes, cameras or lights.
Scene emptyScene();

// Each of these returns the index of what it appends.
int addMaterial(Scene& scene, const Material& material);
Material unlitMaterial(Float3 color);
// Returns a perfect mirror: metallic, roughness 0, white.
Material mirrorMaterial();

// Returns a parallelogram with the corners `corner`, + right, + right + up, + up; its front faces right × up.
// Texture coordinates are (0, 1) at `corner` and (1, 0) at the opposite corner, so that an image stands
// upright.
Primitive makeQuad(int material, Float3 corner, Float3 right, Float3 up);
// Adds a mesh with one primitive.
int addMesh(Scene& scene, Primitive primitive);
// `world` is column-major.
void addInstance(Scene& scene, int mesh, const Matrix4& world);
void addInstance(Scene& scene, int mesh);
Matrix4 scaling(double x, double y, double z);

// Adds an image of width × height RGBA8 texels with nearest sampling. Returns the texture.
int addTexture(Scene& scene, int width, int height, std::vector<std::uint8_t> rgba8);

// Adds a perspective camera at the origin that looks along -Z, 90° by 90° if the image is square.
void addCamera(Scene& scene);
void addDirectionalLight(Scene& scene, Float3 direction, float lux);

}  // namespace glint::testing
