// Checks a glTF document's JSON before anything is read from it, because tinygltf does not check it.
#pragma once

#include "gltf/document/schema.h"
#include "materials/material_model.h"

#include <optional>
#include <vector>

namespace glint::gltf {

// Checks types, ranges and references of everything that the importer reads. It checks only the accessors
// that a mesh, an animation or a skin uses. It ignores `extras`
// that the model does not declare.
std::optional<SchemaError> checkDocument(Json& root, const MaterialModel& model);

// Returns the part of a checked document that tinygltf gets. It has no buffers and images, which the importer
// opens itself; no animations, skins and morph targets, which the importer reads from the JSON; and no
// extras. Accessors that nothing uses are replaced by stand-ins, so that indices stay valid.
Json projectDocument(const Json& root, const MaterialModel& model);

// Returns the index of a buffer view that projectDocument() appends; it equals the number of the file's
// buffer views. Index accessors without a buffer view refer to it, because tinygltf refuses them otherwise.
int standInBufferView(const Json& root);

// The attributes of primitives that the importer reads.
inline constexpr const char* kAttributes[] = {
    "POSITION", "NORMAL",   "TANGENT",  "TEXCOORD_0", "TEXCOORD_1", "COLOR_0",   "JOINTS_0",
    "JOINTS_1", "JOINTS_2", "JOINTS_3", "WEIGHTS_0",  "WEIGHTS_1",  "WEIGHTS_2", "WEIGHTS_3"};
// The attributes of EXT_mesh_gpu_instancing that the importer reads.
inline constexpr const char* kInstanceAttributes[] = {"TRANSLATION", "ROTATION", "SCALE"};
// The attributes of morph targets that the importer reads.
inline constexpr const char* kTargetAttributes[] = {"POSITION", "NORMAL", "TANGENT"};

}  // namespace glint::gltf
