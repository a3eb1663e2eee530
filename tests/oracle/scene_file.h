// Builds scenes of the oracle's tests. They are written as glTF files and imported again, so that both
// renderers read one file.
#pragma once

#include "oracle/vectors.h"
#include "unit/gltf/gltf_builder.h"

#include <functional>
#include <vector>

namespace glint::oracle {

using test::Json;

class SceneFile {
public:
    // Appends a material as in glTF; its extensions are declared. Returns its index.
    int addMaterial(Json material);
    // Adds a quad whose front faces right × up.
    void addQuad(int material, const Vec3& corner, const Vec3& right, const Vec3& up);
    // Like addQuad(), with COLOR_0 at corner, + right, + right + up, + up.
    void addColoredQuad(int material, const Vec3& corner, const Vec3& right, const Vec3& up,
                        const std::vector<Vec3>& colors);
    // Adds a regular polygon about `center` whose front faces `axis`, with the area of a disk of that radius.
    void addDisk(int material, const Vec3& center, const Vec3& axis, double radius, int corners);
    // Adds a sphere of meridians and parallels with its own normals, with `rings` from pole to pole and twice
    // as many around. The corners are on the sphere, so the solid is a little smaller.
    void addSphere(int material, const Vec3& center, double radius, int rings);
    // Adds six quads. The fronts are inside if `inwards` is set.
    void addBox(const std::vector<int>& materials, const Vec3& low, const Vec3& high, bool inwards);
    // Adds a perspective camera at one place that looks at another.
    void addCamera(const Vec3& from, const Vec3& to, double verticalDegrees);
    // Adds a light as in KHR_lights_punctual, at one place, shining towards another.
    void addLight(Json light, const Vec3& from, const Vec3& to);
    // Adds a light without intensity, for scenes that only the sky lights: viewers add a sun to scenes
    // without a light.
    void addDarkness();

    // Imports the scene. A failure of the importer, or a warning, fails the test.
    gltf::Scene import() const;
    const test::GltfBuilder& builder() const {
        return builder_;
    }

private:
    void addMesh(int material, const std::vector<Vec3>& positions, const std::vector<Vec3>& normals,
                 const std::vector<Vec3>& colors, const std::vector<std::uint32_t>& indices);
    void declare(const std::string& extension);

    test::GltfBuilder builder_;
};

// Returns a material, white by default, that reflects only diffusely: it has no specular lobe, neither at
// normal incidence nor at grazing.
Json diffuseMaterial(const Vec3& color = Vec3(1.0), bool doubleSided = false);
// Returns an unlit material of that color.
Json unlitMaterial(const Vec3& color = Vec3(1.0), bool doubleSided = false);
// Returns a material that emits light and reflects nothing.
Json emissiveMaterial(const Vec3& radiance);

struct Glass {
    double ior = 1.5;
    double thickness = 1.0;            // 0: thin-walled
    double attenuationDistance = 0.0;  // 0: none
    Vec3 attenuationColor{1.0};
    double dispersion = 0.0;
};
// Returns a smooth and clear material.
Json glassMaterial(const Glass& glass);

}  // namespace glint::oracle
