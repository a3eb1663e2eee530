// Noise that repeats over the unit square, the same on every machine.
#pragma once

#include <glm/vec2.hpp>

#include <cstdint>

namespace gallery {

// Uniform within [0, 1).
float hashUnit(int x, int y, std::uint32_t seed);

// Gradient noise on a lattice of `period` x `period` cells over the unit square; about [-0.7, 0.7].
float gradientNoise(const glm::vec2& uv, const glm::ivec2& period, std::uint32_t seed);

// Octaves of gradientNoise(), each twice as fine and half as strong; about [-1, 1].
float fractalNoise(const glm::vec2& uv, const glm::ivec2& period, int octaves, std::uint32_t seed);

// Distance to the nearest of one random point in each of `period` x `period` cells, in cells: [0, about 1.2].
float cellDistance(const glm::vec2& uv, int period, std::uint32_t seed);

}  // namespace gallery
