// Buffer views that EXT_meshopt_compression or KHR_meshopt_compression packs.
#pragma once

#include "gltf/document.h"

#include <glint/result.h>

namespace glint::gltf {

// Decodes `packed`, as the extension's members say, which checkCompression() passed; `byteLength` is that of
// the buffer view. Errors at `pointer`, the buffer view's: "meshopt-layout" (members that contradict each
// other), "meshopt-decode", "meshopt-size" (more than the packed bytes can hold, or than the budget of
// ImportOptions::maxFileBytes).
Result<Bytes> unpackMeshopt(Document& document, const Json& extension, const std::string& pointer,
                            ByteView packed, std::uint64_t byteLength);

}  // namespace glint::gltf
