// KHR_animation_pointer: what a JSON pointer lets an animation change.
#pragma once

#include "gltf/animation.h"
#include "gltf/document.h"
#include "gltf/node_numbers.h"
#include "gltf/scene.h"

#include <cstdint>
#include <string>
#include <vector>

namespace glint::gltf {

// What the accessor of the keyframes must have.
enum class ValueKind : std::uint8_t {
    Vector,  // an element a keyframe, as wide as the property
    Array,   // scalars, as many a keyframe as the property has numbers
    Bool     // unsigned bytes, and STEP
};

struct PointerTarget {
    enum class Verdict : std::uint8_t {
        Known,
        Unknown,  // nothing that Glint has data for
        Wrong     // the pointer breaks a rule: `why`
    };
    Verdict verdict = Verdict::Unknown;
    std::string why{};
    AnimationPath path = AnimationPath::Translation;
    int property = 0;          // as AnimationChannel::property
    std::vector<int> targets;  // as AnimationChannel::target; empty: the scene does not show it
    std::size_t width = 0;
    ValueKind kind = ValueKind::Vector;
};

// Of a material, `targets` holds its index into Scene::materials.
PointerTarget resolvePointer(const Document& document, const Scene& scene, const NodeNumbers& numbers,
                             const std::string& pointer);

}  // namespace glint::gltf
