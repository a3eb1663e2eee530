// Access to the only primitive, which most geometry tests check.
#pragma once

#include "unit/gltf/gltf_builder.h"

#include <gtest/gtest.h>

namespace glint::test {

// Returns the only primitive of a scene that must import.
inline const gltf::Primitive& onlyPrimitive(const Result<gltf::Scene>& scene) {
    static const gltf::Primitive kNone;
    if (!scene || scene->meshes.empty() || scene->meshes[0].primitives.empty()) {
        ADD_FAILURE() << (scene ? "no primitive" : toString(scene.error()));
        return kNone;
    }
    return scene->meshes[0].primitives[0];
}

}  // namespace glint::test
