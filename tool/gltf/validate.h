// Checks of a glTF document's JSON before anything is read by it: what tinygltf takes on trust.
#pragma once

#include "gltf/schema.h"

#include <optional>
#include <vector>

namespace glint::gltf {

// Types, ranges and references of everything that the importer reads, but of accessors only those that a
// mesh, an animation or a skin uses. `extras` are not looked at.
std::optional<SchemaError> checkDocument(Json& root);

// The part of a checked document that the importer reads, for tinygltf: no buffers and images (the importer
// opens those itself), no animations, skins, morph targets (it reads those from the JSON) and extras.
// Accessors that nothing uses are stand-ins, so that indices stay.
Json projectDocument(const Json& root);

// A buffer view that projectDocument() appends: index accessors without a buffer view refer to it, since
// tinygltf refuses them. Equal to the count of the file's buffer views.
int standInBufferView(const Json& root);

// The attributes of primitives that the importer reads.
inline constexpr const char* kAttributes[] = {
    "POSITION", "NORMAL",   "TANGENT",  "TEXCOORD_0", "TEXCOORD_1", "COLOR_0",   "JOINTS_0",
    "JOINTS_1", "JOINTS_2", "JOINTS_3", "WEIGHTS_0",  "WEIGHTS_1",  "WEIGHTS_2", "WEIGHTS_3"};
// And those of EXT_mesh_gpu_instancing.
inline constexpr const char* kInstanceAttributes[] = {"TRANSLATION", "ROTATION", "SCALE"};
// And those of morph targets.
inline constexpr const char* kTargetAttributes[] = {"POSITION", "NORMAL", "TANGENT"};

}  // namespace glint::gltf
