// Checks a glTF document's JSON before anything is read from it.
#pragma once

#include "gltf/document/schema.h"
#include "materials/material_model.h"

#include <optional>
#include <vector>

namespace glint::gltf {

// Checks types, ranges and references of everything that the importer reads. It checks only the accessors
// that a mesh, an animation or a skin uses. It ignores `extras` that the model does not declare.
std::optional<SchemaError> checkDocument(Json& root, const materials::MaterialModel& model);

// Returns for each accessor whether the importer reads it. Only these have been checked.
std::vector<bool> usedAccessors(const Json& root, const materials::MaterialModel& model);

// The attributes of primitives that the importer reads.
inline constexpr const char* kAttributes[] = {
    "POSITION", "NORMAL",   "TANGENT",  "TEXCOORD_0", "TEXCOORD_1", "COLOR_0",   "JOINTS_0",
    "JOINTS_1", "JOINTS_2", "JOINTS_3", "WEIGHTS_0",  "WEIGHTS_1",  "WEIGHTS_2", "WEIGHTS_3"};
// How many sets of joints and weights are among them.
inline constexpr int kInfluenceSets = 4;
// The attributes of EXT_mesh_gpu_instancing that the importer reads.
inline constexpr const char* kInstanceAttributes[] = {"TRANSLATION", "ROTATION", "SCALE"};
// The attributes of morph targets that the importer reads.
inline constexpr const char* kTargetAttributes[] = {"POSITION", "NORMAL", "TANGENT"};

}  // namespace glint::gltf
