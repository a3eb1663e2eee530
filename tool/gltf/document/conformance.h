// Compares what a document says with the extensions that Glint reads, and with rules of glTF that Glint can
// do without.
#pragma once

#include "gltf/document/document.h"

#include <glint/result.h>

#include <string_view>

namespace glint::gltf {

// Returns an error for extensionsRequired that Glint can't honour. Warns once about each other extension that
// it doesn't read. One note names all those that change no picture.
Status checkExtensions(Document& document, const Json& root);

bool isSupportedExtension(const materials::MaterialModel& model, std::string_view name);

// Returns whether the extension holds only data that no picture shows: metadata, and choices for users.
bool changesNoPicture(std::string_view name);

// Warns of rules that a document breaks which checkDocument() has accepted: extensions, the names and forms
// of attributes, and where the elements of accessors lie. Equal warnings are given once, at the first place.
void warnOfBrokenRules(Document& document, const Json& root);

}  // namespace glint::gltf
