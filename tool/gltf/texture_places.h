// Where each texture slot stands in the JSON of a material.
#pragma once

#include "plan/material.h"

#include <span>

namespace glint::gltf {

struct TexturePlace {
    const char* owner;  // the object that holds it, of an extension its name; "": the material itself
    const char* member;
    TextureSlot slot;
};

// Two places can fill one slot: those of the two base models.
std::span<const TexturePlace> texturePlaces();

}  // namespace glint::gltf
