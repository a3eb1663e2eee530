// Reads the outer layer of a glTF file: splits GLB chunks and parses JSON text.
//
// tinygltf's own functions are not used. They refuse a GLB whose binary chunk is empty or no multiple of 4
// bytes long, which exporters write, and copy that chunk. Its parser refuses a document for a number such as
// 1e400 in the extras, and its messages name no place.
#pragma once

#include "base/files.h"
#include "gltf/document/schema.h"

#include <glint/result.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glint::gltf {

struct Container {
    std::span<const std::uint8_t> json;
    std::optional<std::span<const std::uint8_t>> binary;  // the BIN chunk
};

// Splits a GLB. A file without GLB's magic number is JSON as a whole. The spans view `bytes`. Errors:
// "glb-version", "glb-length", "glb-chunk".
Result<Container> splitContainer(std::span<const std::uint8_t> bytes, const std::string& file,
                                 std::vector<Diagnostic>& warnings);

// A number that a double can't hold becomes a text that isHugeNumber() recognises, so that it does not matter
// where nothing reads it. Errors: "scene-empty" and "scene-format" if it is a whole file of another kind,
// "json-depth", "json-syntax", and "json-type" if the root is not an object.
Result<Json> parseJson(std::span<const std::uint8_t> bytes, const std::string& file,
                       std::vector<Diagnostic>& warnings);

}  // namespace glint::gltf
