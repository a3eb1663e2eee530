// Locates each texture slot in the JSON of a material.
#pragma once

#include "plan/material.h"

#include <span>

namespace glint::gltf {

struct TexturePlace {
    const char* owner;  // the object that holds it: an extension's name, "" for the material itself
    const char* member;
    TextureSlot slot;
};

// Two places can fill one slot, because there are two base models.
std::span<const TexturePlace> texturePlaces();

}  // namespace glint::gltf
