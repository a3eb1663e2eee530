// Effects, that is, the uses of rays in a picture, as shaders/effects/*/*.json and the declarations of packs
// define them.
#pragma once

#include <glint/package_format.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace glint::materials {

enum class Behaviour : std::uint8_t;

// The lit surfaces that call for an effect.
struct EffectCall {
    bool byAll = false;     // every surface does; otherwise those with the behaviour
    Behaviour behaviour{};  // the surface's behaviour towards light
    bool lights = false;    // only where some light shines
    std::string because{};  // of the surfaces that call for it, where all do: "is lit by the sky"
    // The reason if no surface does; {limit} stands for the roughness limit.
    std::string otherwise{};
};

// The similarity of neighbouring rays' hits (Round::coherence), on smooth surfaces and on others.
struct EffectCoherence {
    double mirror = 0.1;
    double glossy = 0.1;
};

struct EffectDeclaration {
    std::string name;         // "ambient-occlusion"
    std::string declaration;  // its file
    std::string about;        // a sentence
    package::EffectKind kind = package::EffectKind::Rays;
    double order = 0.0;
    bool isOfPack = false;
    EffectCall call;
    // The light that the effect refines. Pictures without the effect have this light too, so no scene calls
    // for it by itself. If empty, a scene may call for it.
    std::string refines{};
    EffectCoherence coherence{};
    std::vector<std::string> settings{};  // the settings that only change this effect
    std::string absent{};                 // why they are not worth trying without it
    // The kind Rays: the sampled direction has a density, so that samples of emissive lights share the light
    // of its lobes. `sample` then also has density…() and share…().
    bool sharesLights = false;
    // Effects of the kind Rays have these two members, for layers. `albedo` names the lobes that bring the
    // light: "diffuse", "specular" or "transmission"; all of them if it is empty. `shows` names the points
    // that surfaces show by it: "mirrored" or "refracted" ones; it is empty if they show only light.
    std::string albedo{};
    std::string shows{};
    // Names of files as an #include gives them, empty where there are none. Each has a function whose name
    // ends with function(). light: shaders/hit/ calls it. apply: changes the sky's shares. sample: makes a
    // ray and its weight. compose: weights the found light for the pixel; without it, the light is multiplied
    // by the weight. start: endsEarly(), before the ray joins the list. walk: a pass over the pixels before
    // that. hit: changes the sky's shares at a hit.
    std::string light{};
    std::string apply{};
    std::string sample{};
    std::string compose{};
    std::string start{};
    std::string walk{};
    std::string hit{};

    std::string function() const;  // "AmbientOcclusion"
    std::string macro() const;     // "AMBIENT_OCCLUSION"
    std::string file() const;      // "ambient_occlusion": part of names of modules
    std::uint32_t abilities() const;
    // Returns the file that every effect of the kind has.
    const std::string& main() const;
    std::vector<const std::string*> files() const;
};

// Returns whether an effect may have the name: words of small letters and digits, joined by hyphens.
bool isEffectName(std::string_view name);
// Returns the package's entry for an effect with that number.
package::EffectInfo infoOf(const EffectDeclaration& effect, std::size_t number);
// Returns the set of those of `effects` that `bits` has.
package::EffectSet effectSetOf(const std::vector<EffectDeclaration>& effects, std::uint32_t bits);
// Returns the bit of the effect of that name, or 0 if there is none.
package::Effect findEffect(const std::vector<EffectDeclaration>& effects, std::string_view name);

}  // namespace glint::materials
