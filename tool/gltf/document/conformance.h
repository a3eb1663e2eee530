// Warns of rules of glTF that a file breaks and that Glint can read it without.
#pragma once

namespace glint::gltf {

class Document;

// Checks what the JSON of an opened document says: extensions, the names and forms of attributes, and where
// the elements of accessors lie. Equal warnings are given once, at the first place.
void warnOfBrokenRules(Document& document);

}  // namespace glint::gltf
