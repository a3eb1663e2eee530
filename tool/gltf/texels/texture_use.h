// The channels that the materials of a scene read of its images, and the meaning of the numbers that an image
// stores.
#pragma once

#include "gltf/scene.h"
#include "gltf/texels/levels.h"
#include "materials/interval.h"

#include <array>
#include <cstdint>
#include <vector>

namespace glint::gltf {

struct ImageUse {
    bool isColor = false;        // some texture reads it as colour, in sRGB
    bool isData = false;         // some texture reads it as linear data
    bool isNormals = false;      // all of them read vectors
    bool isEmission = false;     // some material emits what it shows
    std::uint32_t channels = 0;  // that are read: bit 0 for red, to bit 3 for alpha
    // Those of them that all textures read as the roughness of a lobe, and as 1 - roughness.
    std::uint32_t roughness = 0;
    std::uint32_t glossiness = 0;

    bool operator==(const ImageUse&) const = default;
};

// Returns how the levels of such an image are made.
LevelFilters levelFiltersOf(const ImageUse& use);

// Returns whether a device's blits would make those levels, for sides that are powers of two.
bool blitsSuit(const ImageUse& use);

// Returns the use of each of Scene::images. Materials that no primitive has count.
std::vector<ImageUse> imageUses(const Scene& scene);

// Returns what a shader reads of such an image. `isColor` says that red, green and blue are in sRGB. The
// bounds are wider by what drivers round, but 0 and 1 stay exact: a channel that is 0 everywhere is read as
// 0.
std::array<materials::ValueInterval, 4> contentAsRead(const std::array<materials::ValueInterval, 4>& stored,
                                                      bool isColor);

// Returns the number that a code stands for, where it is colour in sRGB or not.
double numberAsRead(double stored, bool isColor);

}  // namespace glint::gltf
