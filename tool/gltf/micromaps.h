// EXT_mesh_opacity_micromap, as drafted in 2026 (KhronosGroup/glTF, pull request 2623): opacity micromaps of
// primitives in a glTF file.
//
// Importing a scene ignores the extension, because what a file says about opacity is not proved. These
// functions are for programs that exchange micromaps with other tools.
#pragma once

#include "gltf/document/schema.h"

#include <glint/opacity_micromap.h>
#include <glint/result.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace glint::gltf {

inline constexpr const char* kMicromapExtension = "EXT_mesh_opacity_micromap";

struct PrimitiveMicromap {
    std::size_t mesh = 0;
    std::size_t primitive = 0;  // within the mesh
    opacity::MicromapArray array;
};

// Returns the bytes of a buffer view.
using ReadBufferView = std::function<Result<std::span<const std::uint8_t>>(std::size_t view)>;

// Returns the micromaps of the primitives of a document, each with the records that the file's micromap has,
// and one index for each triangle. Checks all that the draft demands. Requires JSON whose meshes, accessors
// and buffer views were checked. Errors: "micromap" at the JSON pointer of the fault, and those of `read`.
Result<std::vector<PrimitiveMicromap>> readMicromaps(const Json& json, const ReadBufferView& read);

// Adds the extension to a document: a micromap for each primitive, whose data, records and indices follow
// each other in `bytes`, which becomes a buffer with the URI `uri` (empty: the buffer of a .glb). Replaces
// what the document had of the extension. Requires primitives of the document that are lists of triangles.
void writeMicromaps(std::span<const PrimitiveMicromap> micromaps, const std::string& uri, Json& json,
                    std::vector<std::uint8_t>& bytes);

}  // namespace glint::gltf
