// Decodes buffer views that are compressed with EXT_meshopt_compression or KHR_meshopt_compression.
#pragma once

#include "base/files.h"
#include "gltf/document/document.h"
#include "gltf/document/model.h"
#include "gltf/scene.h"

#include <glint/result.h>

namespace glint::gltf {

// Decodes `packed` as the members of the extension say. checkDocument() must have accepted them.
// `byteLength` and `pointer` are those of the buffer view. Errors: "meshopt-layout" (members that contradict
// each other), "meshopt-decode", "meshopt-size" (more than the packed bytes can hold, or than the budget of
// ImportOptions::maxFileBytes).
Result<base::Bytes> unpackMeshopt(Document& document, const Value& extension, const std::string& pointer,
                                  ByteView packed, std::uint64_t byteLength);

}  // namespace glint::gltf
