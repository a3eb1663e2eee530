// Which glTF extensions Glint reads, and what it says of the others.
#pragma once

#include <glint/result.h>

#include <string>
#include <string_view>

namespace glint::gltf {

class Document;

// Errors on extensionsRequired that Glint can't honour; warns once of each other extension it doesn't read,
// but for those that change no picture, which one note names together.
Status checkExtensions(Document& document);

bool isSupportedExtension(std::string_view name);

// Whether the extension holds what no picture shows: metadata, and what users may select.
bool changesNoPicture(std::string_view name);

// Whether the checked document lists the extension as required.
bool requiresExtension(const Document& document, std::string_view name);

// "extension-unsupported" at `pointer`.
Diagnostic unsupportedExtension(const Document& document, std::string_view name, std::string_view pointer);

}  // namespace glint::gltf
