// Reads numbers and textures from the JSON objects of a material.
#pragma once

#include "gltf/document/document.h"
#include "gltf/textures.h"

#include <string>
#include <string_view>

namespace glint::gltf {

// One object of a checked document, and its JSON pointer.
class ObjectReader {
public:
    ObjectReader(Document& document, const Json& object, std::string pointer)
        : document_(document), object_(object), pointer_(std::move(pointer)) {}

    const Json& json() const {
        return object_;
    }
    // Returns the JSON pointer of a member.
    std::string pointerTo(std::string_view member) const;
    // Reads the texture info of that name into `info`. If there is none, or none that can be used, `info`
    // stays as it is.
    Status texture(std::string_view member, TextureTable& textures, materials::TextureInfo& info) const;
    void warn(std::string_view member, std::string message, std::string hint) const;

private:
    Document& document_;
    const Json& object_;
    std::string pointer_;
};

}  // namespace glint::gltf
