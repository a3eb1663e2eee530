// Helpers that place exhibits: sets of attributes, turns, and a mesh that is shown once.
#pragma once

#include "scene.h"

#include <glm/trigonometric.hpp>

#include <string>

namespace gallery {

inline constexpr unsigned kPlain = kNormals;
inline constexpr unsigned kTextured = kNormals | kTexCoord0;
inline constexpr unsigned kBumped = kTextured | kTangents;

inline const glm::vec3 kX(1.0F, 0.0F, 0.0F);
inline const glm::vec3 kY(0.0F, 1.0F, 0.0F);
inline const glm::vec3 kZ(0.0F, 0.0F, 1.0F);

inline glm::quat turn(float degrees, const glm::vec3& axis) {
    return glm::angleAxis(glm::radians(degrees), axis);
}

struct Builder {
    GltfWriter& writer;
    const MaterialSet& materials;

    // Adds a mesh that is placed once.
    void show(const std::string& name, const MeshData& mesh, unsigned attributes, int material,
              const Placement& placement) const {
        const int geometry = writer.addGeometry(mesh, attributes);
        writer.addMeshNode(name, writer.addMesh(name, {{geometry, material}}), placement);
    }
};

}  // namespace gallery
