// Checks and reads the JSON of extensions that compress geometry or replace a texture's image.
#pragma once

#include "gltf/document/schema.h"

#include <optional>
#include <string_view>

namespace glint::gltf {

// Checks types, ranges and references of EXT_meshopt_compression and KHR_meshopt_compression in buffer views,
// of KHR_draco_mesh_compression in primitives, and of EXT_texture_webp and KHR_texture_basisu in textures.
// checkDocument() must have accepted the document.
std::optional<SchemaError> checkCompression(Json& root);

// Returns the EXT_meshopt_compression or KHR_meshopt_compression object of a buffer view or buffer, or null
// if there is none.
const Json* findMeshopt(const Json& object);

// Returns the image that the texture's extension of that name refers to, or -1 if the texture has no such
// extension.
int extensionSource(const Json& texture, std::string_view extension);

}  // namespace glint::gltf
