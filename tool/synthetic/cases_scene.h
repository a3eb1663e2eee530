// Scenes whose rays hit as many cases as wanted, on which strategies are compared.
//
// A camera looks straight down on a floor that fills the picture. Above it hangs a ceiling of square tiles,
// each of which belongs to one case. Every pixel sends one ray from the floor, and it hits a tile. From a
// mirror, neighbouring rays hit neighbouring tiles, as in a picture; from a white floor, which scatters rays,
// each hits a random tile.
#pragma once

#include "gltf/scene.h"

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

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

// The half size of the camera's view at a distance, from the middle to the edge.
struct Extent {
    double x = 0.0;
    double z = 0.0;
};

// The ceiling. It is parallel to the floor, around the vertical axis.
struct Ceiling {
    Extent extent;             // from the middle to the edge
    int tiles = 0;             // number of tiles a side
    std::vector<int> cases{};  // row by row from -z, and within a row from -x

    std::size_t place(int row, int column) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(tiles) +
               static_cast<std::size_t>(column);
    }
    // Returns the case above a point, or -1 if there is none.
    int caseAt(double x, double z) const;
};

Ceiling makeCeiling(const CasesOptions& options);

// Returns the share that each case should have, largest first. They add up to 1.
std::vector<double> sharesOf(const CasesOptions& options);

// Returns by how much two hits of 32 successive rays of the list are likelier of the same case than any two
// hits: (a - r) / (1 - r), where a is that chance and r is the sum of squared shares. 0 means random order; 1
// means that all hits are alike, or that there is one case. The form is that of Cohen's kappa ("A coefficient
// of agreement for nominal scales", 1960).
//
// It is computed from the geometry, not read from a device. Rays of a mirror follow the law of reflection
// through the middle of each pixel; other rays use random numbers of this function's own. 32 rays in a row
// are a block of 8 x 4 pixels, as a subgroup of 32 appends them. In large pictures only some of the blocks
// are evaluated.
double coherentShareOf(const CasesOptions& options, std::uint32_t width, std::uint32_t height);

}  // namespace glint::synthetic
