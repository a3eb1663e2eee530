// Small scenes made by hand, for pictures whose pixels can be worked out on paper.
#pragma once

#include "gltf/scene.h"

#include <string>

namespace glint::testing {

// A scene without meshes, cameras or lights.
Scene emptyScene();

// Each returns the index of what it appends.
int addMaterial(Scene& scene, const Material& material);
Material unlitMaterial(Float3 color);
// A perfect mirror: metallic, roughness 0, white.
Material mirrorMaterial();

// A parallelogram with corners `corner`, + right, + right + up, + up; front side towards right × up. Texture
// coordinates: (0, 1) at `corner`, (1, 0) at the opposite one, so that an image stands upright.
Primitive makeQuad(int material, Float3 corner, Float3 right, Float3 up);
// One mesh of one primitive.
int addMesh(Scene& scene, Primitive primitive);
// `world` is column-major.
void addInstance(Scene& scene, int mesh, const Matrix4& world);
void addInstance(Scene& scene, int mesh);
Matrix4 scaling(double x, double y, double z);

// An image of width × height RGBA8 texels with nearest sampling; returns the texture.
int addTexture(Scene& scene, int width, int height, std::vector<std::uint8_t> rgba8);

// A perspective camera at the origin that looks along -Z, 90° by 90° if the image is square.
void addCamera(Scene& scene);
void addDirectionalLight(Scene& scene, Float3 direction, float lux);

}  // namespace glint::testing
