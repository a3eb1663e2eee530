// Resolves JSON pointers of KHR_animation_pointer to the properties that they animate.
#pragma once

#include "gltf/animation.h"
#include "gltf/document/document.h"
#include "gltf/scene.h"
#include "gltf/steps.h"

#include <cstdint>
#include <string>
#include <vector>

namespace glint::gltf {

// The form that the accessor of the keyframes must have.
enum class ValueKind : std::uint8_t {
    Vector,  // one element for each keyframe, as wide as the property
    Array,   // scalars; each keyframe has as many as the property has numbers
    Bool     // unsigned bytes, with STEP interpolation
};

struct PointerTarget {
    enum class Verdict : std::uint8_t {
        Known,
        Unknown,  // Glint has no data for it
        Wrong     // the pointer breaks a rule, which `why` names
    };
    Verdict verdict = Verdict::Unknown;
    std::string why{};
    AnimationPath path = AnimationPath::Translation;
    int property = 0;          // as AnimationChannel::property
    std::vector<int> targets;  // as AnimationChannel::target; empty if the scene shows none
    std::size_t width = 0;
    ValueKind kind = ValueKind::Vector;
};

// If the pointer leads to a material, `targets` holds the index into Scene::materials.
PointerTarget resolvePointer(const Document& document, const Scene& scene, const NodeNumbers& numbers,
                             const std::string& pointer);

}  // namespace glint::gltf
