// Damage for files, and what an import has to do with it: return, with a scene or with a diagnostic.
#pragma once

#include "unit/gltf/gltf_builder.h"

#include <cstdint>
#include <filesystem>
#include <random>
#include <set>
#include <string>

namespace glint::test {

// Runs are the same every time.
inline constexpr std::uint32_t kSeed = 20240229;
using Random = std::mt19937;

// A number below `limit`; 0 where that is 0.
std::size_t below(Random& random, std::size_t limit);

// Flips one to four bits.
void flipBytes(Random& random, std::string& text);

// Truncates, flips bits, replaces numbers, repeats pieces.
std::string mutate(Random& random, std::string text);

// A GLB whose container is sound, with damage in its values or its binary chunk: it goes deeper.
std::string mutateContents(Random& random, const GltfBuilder& builder);

struct Tally {
    int imported = 0;
    int refused = 0;
    std::set<std::string> ids;  // of the refusals
};

// Writes the bytes to `path` and imports that, images too, under limits that keep each import small.
void importMutation(const std::filesystem::path& path, const std::string& bytes, Tally& tally);

}  // namespace glint::test
