#include "noise.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace gallery {

namespace {

// There are eight directions: the diagonals and the axes.
constexpr float kDiagonal = 0.70710678F;
constexpr std::array<glm::vec2, 8> kGradients{{{1, 0},
                                               {kDiagonal, kDiagonal},
                                               {0, 1},
                                               {-kDiagonal, kDiagonal},
                                               {-1, 0},
                                               {-kDiagonal, -kDiagonal},
                                               {0, -1},
                                               {kDiagonal, -kDiagonal}}};

int wrap(int value, int period) {
    const int rest = value % period;
    return rest < 0 ? rest + period : rest;
}

}  // namespace

float hashUnit(int x, int y, std::uint32_t seed) {
    // Multiply and xor-shift rounds in the manner of Wellons' lowbias32.
    std::uint32_t h = static_cast<std::uint32_t>(x) * 0x9E3779B1U ^
                      static_cast<std::uint32_t>(y) * 0x85EBCA77U ^ seed * 0xC2B2AE3DU;
    h ^= h >> 16;
    h *= 0x7FEB352DU;
    h ^= h >> 15;
    h *= 0x846CA68BU;
    h ^= h >> 16;
    return static_cast<float>(h >> 8) * (1.0F / 16777216.0F);
}

float gradientNoise(const glm::vec2& uv, const glm::ivec2& period, std::uint32_t seed) {
    const glm::vec2 scaled = uv * glm::vec2(period);
    const glm::vec2 floor = glm::floor(scaled);
    const glm::vec2 f = scaled - floor;
    const glm::ivec2 cell(floor);
    const auto corner = [&](int dx, int dy) {
        const float pick = hashUnit(wrap(cell.x + dx, period.x), wrap(cell.y + dy, period.y), seed);
        const glm::vec2& gradient = kGradients[static_cast<std::size_t>(pick * 8.0F)];
        return gradient.x * (f.x - static_cast<float>(dx)) + gradient.y * (f.y - static_cast<float>(dy));
    };
    const glm::vec2 s = f * f * f * (f * (f * 6.0F - 15.0F) + 10.0F);
    return glm::mix(glm::mix(corner(0, 0), corner(1, 0), s.x), glm::mix(corner(0, 1), corner(1, 1), s.x),
                    s.y);
}

float fractalNoise(const glm::vec2& uv, const glm::ivec2& period, int octaves, std::uint32_t seed) {
    float sum = 0.0F;
    float amplitude = 1.0F;
    glm::ivec2 cells = period;
    for (int octave = 0; octave < octaves; ++octave) {
        sum += amplitude * gradientNoise(uv, cells, seed + static_cast<std::uint32_t>(octave));
        amplitude *= 0.5F;
        cells *= 2;
    }
    return sum;
}

float cellDistance(const glm::vec2& uv, int period, std::uint32_t seed) {
    const glm::vec2 scaled = uv * static_cast<float>(period);
    const glm::ivec2 cell(glm::floor(scaled));
    float nearest = 4.0F;
    for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
            const glm::ivec2 other = cell + glm::ivec2(dx, dy);
            const int x = wrap(other.x, period);
            const int y = wrap(other.y, period);
            const glm::vec2 point =
                glm::vec2(other) + glm::vec2(hashUnit(x, y, seed), hashUnit(x, y, seed + 1));
            nearest = std::min(nearest, glm::length(point - scaled));
        }
    }
    return nearest;
}

}  // namespace gallery
