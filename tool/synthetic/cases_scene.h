// Scenes whose rays hit as many cases as wanted: what strategies are compared on.
//
// A camera looks straight down on a floor that fills the picture; above it hangs a ceiling of square tiles,
// each of one of the cases. Every pixel sends one ray from the floor, and hits a tile: of a mirror, as
// neighbours do in a picture; of a white floor, which scatters them, wherever chance sends them.
#pragma once

#include "gltf/scene.h"

#include <cstdint>
#include <string_view>

namespace glint::synthetic {

inline constexpr int kMaxCases = 256;

// What shading a hit takes.
enum class Cost : std::uint8_t {
    Cheap,     // metal and roughness, with some of their textures
    Expensive  // clearcoat, anisotropy, iridescence, specular and about half of four further lobes
};

// Whether neighbouring rays hit the same case.
enum class Coherence : std::uint8_t {
    Coherent,   // rays of a mirror (the effect reflection); tiles of a case lie together
    Incoherent  // rays by the cosine (the effect indirect-diffuse); tiles in random order, many in reach
};

// How the ceiling is divided among the cases; each has a tile at least.
enum class Shares : std::uint8_t {
    Uniform,
    Zipf  // in proportion to 1, 1/2, 1/3, …
};

struct CasesOptions {
    int cases = 16;  // 1 to kMaxCases
    Cost cost = Cost::Cheap;
    Coherence coherence = Coherence::Coherent;
    Shares shares = Shares::Uniform;
    int lights = 0;       // point lights between floor and ceiling; 0: the sky alone
    double aspect = 2.0;  // of the picture, width by height: the coherent ceiling fills it
};

std::string_view nameOf(Cost cost);            // "cheap"
std::string_view nameOf(Coherence coherence);  // "coherent"
std::string_view nameOf(Shares shares);        // "uniform"

// As importScene() would read it with its images. With MergePolicy::None it has exactly `cases` keys, hence
// cases; the floor shares the key of one of them. Sources: none.
Scene makeCasesScene(const CasesOptions& options);

}  // namespace glint::synthetic
