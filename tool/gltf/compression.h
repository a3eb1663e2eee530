// The JSON of the extensions that compress geometry or replace a texture's image.
#pragma once

#include "gltf/schema.h"

#include <optional>
#include <string_view>

namespace glint::gltf {

// Types, ranges and references of EXT_meshopt_compression and KHR_meshopt_compression in buffer views,
// KHR_draco_mesh_compression in primitives, EXT_texture_webp and KHR_texture_basisu in textures. Requires a
// document that checkDocument() passed.
std::optional<SchemaError> checkCompression(Json& root);

// EXT_meshopt_compression or KHR_meshopt_compression of a buffer view or buffer; null for none.
const Json* findMeshopt(const Json& object);

// The image that the texture's extension of that name refers to; -1 where the texture has none.
int extensionSource(const Json& texture, std::string_view extension);

}  // namespace glint::gltf
