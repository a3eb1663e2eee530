// Damages files, and states what an import must do with them: return a scene or a diagnostic.
#pragma once

#include "unit/gltf/gltf_builder.h"

#include <cstdint>
#include <filesystem>
#include <random>
#include <set>
#include <string>

namespace glint::test {

// The seed is fixed, so that all runs are the same.
inline constexpr std::uint32_t kSeed = 20240229;
using Random = std::mt19937;

// Returns a number below `limit`, or 0 if `limit` is 0.
std::size_t below(Random& random, std::size_t limit);

// Flips one to four bits.
void flipBytes(Random& random, std::string& text);

// Truncates, flips bits, replaces numbers or repeats pieces.
std::string mutate(Random& random, std::string text);

// Returns a GLB with a valid container and damage in its values or its binary chunk, which reaches deeper
// code.
std::string mutateContents(Random& random, const GltfBuilder& builder);

struct Tally {
    int imported = 0;
    int refused = 0;
    std::set<std::string> ids;  // of the refusals
};

// Writes the bytes to `path` and imports them, including images, under limits that keep each import small.
void importMutation(const std::filesystem::path& path, const std::string& bytes, Tally& tally);

}  // namespace glint::test
