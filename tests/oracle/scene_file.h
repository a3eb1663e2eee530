// Scenes of the oracle's tests, written as glTF files and imported again, so that both renderers read one
// file.
#pragma once

#include "oracle/vectors.h"
#include "unit/gltf/gltf_builder.h"

#include <functional>
#include <vector>

namespace glint::oracle {

using test::Json;

class SceneFile {
public:
    // Appends a material as glTF has it; its extensions are declared. Returns its index.
    int addMaterial(Json material);
    // Front side towards right × up.
    void addQuad(int material, const Vec3& corner, const Vec3& right, const Vec3& up);
    // As addQuad(), with COLOR_0 at corner, + right, + right + up, + up.
    void addColoredQuad(int material, const Vec3& corner, const Vec3& right, const Vec3& up,
                        const std::vector<Vec3>& colors);
    // A regular polygon about `center` whose front is towards `axis`, of the area of a disk of that radius.
    void addDisk(int material, const Vec3& center, const Vec3& axis, double radius, int corners);
    // Meridians and parallels with the sphere's own normals; `rings` from pole to pole, twice as many around.
    // The corners are on the sphere, so that the solid is a little smaller.
    void addSphere(int material, const Vec3& center, double radius, int rings);
    // Six quads; the fronts are inside if `inwards`.
    void addBox(const std::vector<int>& materials, const Vec3& low, const Vec3& high, bool inwards);
    // Perspective, from a place towards another.
    void addCamera(const Vec3& from, const Vec3& to, double verticalDegrees);
    // A light as KHR_lights_punctual has it, at a place, shining towards another.
    void addLight(Json light, const Vec3& from, const Vec3& to);
    // A light of no intensity, for scenes that the sky alone lights: viewers add a sun to scenes without a
    // light.
    void addDarkness();

    // A failure of the importer, and any of its warnings, fails the test.
    Scene import() const;
    const test::GltfBuilder& builder() const {
        return builder_;
    }

private:
    void addMesh(int material, const std::vector<Vec3>& positions, const std::vector<Vec3>& normals,
                 const std::vector<Vec3>& colors, const std::vector<std::uint32_t>& indices);
    void declare(const std::string& extension);

    test::GltfBuilder builder_;
};

// White by default; reflects diffusely alone: no specular lobe, neither at normal incidence nor at grazing.
Json diffuseMaterial(const Vec3& color = Vec3(1.0), bool doubleSided = false);
// Unlit, of that color.
Json unlitMaterial(const Vec3& color = Vec3(1.0), bool doubleSided = false);
// Gives off light and reflects nothing.
Json emissiveMaterial(const Vec3& radiance);

struct Glass {
    double ior = 1.5;
    double thickness = 1.0;            // 0: thin-walled
    double attenuationDistance = 0.0;  // 0: none
    Vec3 attenuationColor{1.0};
    double dispersion = 0.0;
};
// Smooth and clear.
Json glassMaterial(const Glass& glass);

}  // namespace glint::oracle
