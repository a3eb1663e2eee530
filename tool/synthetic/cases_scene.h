// Scenes whose rays hit as many cases as wanted, on which strategies are compared.
//
// A camera looks straight down on a floor that fills the picture. Above it hangs a ceiling of square tiles,
// each of which belongs to one case. Every pixel sends one ray from the floor, and it hits a tile. From a
// mirror, neighbouring rays hit neighbouring tiles, as in a picture; from a white floor, which scatters rays,
// each hits a random tile.
#pragma once

#include "gltf/scene.h"

#include <cstdint>
#include <string_view>

namespace glint::synthetic {

inline constexpr int kMaxCases = 256;

// The work of shading a hit.
enum class Cost : std::uint8_t {
    Cheap,     // metal and roughness, with some of their textures
    Expensive  // clearcoat, anisotropy, iridescence, specular and about half of four further lobes
};

// The similarity of neighbouring rays' hits.
enum class Coherence : std::uint8_t {
    Coherent,   // rays from a mirror (the effect reflection); tiles of a case lie together
    Incoherent  // cosine-weighted rays (the effect indirect-diffuse); tiles in random order, many in reach
};

// The division of the ceiling among the cases. Each case has at least one tile.
enum class Shares : std::uint8_t {
    Uniform,
    Zipf  // in proportion to 1, 1/2, 1/3, …
};

struct CasesOptions {
    int cases = 16;  // 1 to kMaxCases
    Cost cost = Cost::Cheap;
    Coherence coherence = Coherence::Coherent;
    Shares shares = Shares::Uniform;
    int lights = 0;       // point lights between floor and ceiling; with 0 there is only the sky
    double aspect = 2.0;  // of the picture, width by height; the coherent ceiling fills it
};

std::string_view nameOf(Cost cost);            // "cheap"
std::string_view nameOf(Coherence coherence);  // "coherent"
std::string_view nameOf(Shares shares);        // "uniform"

// Returns the scene as importScene() would read it, with its images and without sources. With
// MergePolicy::None it has exactly `cases` keys and so as many cases; the floor has the key of one of them.
gltf::Scene makeCasesScene(const CasesOptions& options);

}  // namespace glint::synthetic
