// Which glTF extensions Glint reads, and what it says of the others.
#pragma once

#include "gltf/schema.h"

#include <glint/result.h>

#include <string>
#include <string_view>

namespace glint::gltf {

class Document;

// Errors on extensionsRequired that Glint can't honour; warns once of each other extension it doesn't read.
Status checkExtensions(Document& document);

bool isSupportedExtension(std::string_view name);

// "extension-unsupported" at `pointer`.
Diagnostic unsupportedExtension(const Document& document, std::string_view name, std::string_view pointer);

// The extension that compresses a buffer, buffer view or primitive; null for none.
const char* compressionOf(const Json& object);

}  // namespace glint::gltf
