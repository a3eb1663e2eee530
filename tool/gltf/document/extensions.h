// Defines which glTF extensions Glint reads, and which messages others cause.
#pragma once

#include "materials/material_model.h"

#include <glint/result.h>

#include <string>
#include <string_view>

namespace glint::gltf {

class Document;

// Returns an error for extensionsRequired that Glint can't honour. Warns once about each other extension that
// it doesn't read. One note names all those that change no picture.
Status checkExtensions(Document& document);

bool isSupportedExtension(const materials::MaterialModel& model, std::string_view name);

// Returns whether the extension holds only data that no picture shows: metadata, and choices for users.
bool changesNoPicture(std::string_view name);

// Returns whether the checked document lists the extension as required.
bool requiresExtension(const Document& document, std::string_view name);

// Returns the error "extension-unsupported" at `pointer`.
Diagnostic unsupportedExtension(const Document& document, std::string_view name, std::string_view pointer);

}  // namespace glint::gltf
