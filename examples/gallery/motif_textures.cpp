// Pictures: vase, globe, screen, lantern, lamp, sign, painting.
#include "noise.h"
#include "textures.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace gallery {

namespace {

// Returns 1 inside a shape and 0 outside, from its signed distance (negative inside) over an edge that is
// `blur` wide.
float coverage(float distance, float blur) {
    return glm::clamp(0.5F - distance / blur, 0.0F, 1.0F);
}

float segmentDistance(const glm::vec2& point, const glm::vec2& a, const glm::vec2& b) {
    const glm::vec2 along = b - a;
    const float t = glm::clamp(glm::dot(point - a, along) / glm::dot(along, along), 0.0F, 1.0F);
    return glm::length(point - a - along * t);
}

struct Stroke {
    glm::vec2 from;
    glm::vec2 to;
};

// The word GLINT and an arrow to the right. Letters are one unit high, and y points up.
constexpr std::array<Stroke, 21> kSignStrokes{{
    {{0.70F, 0.82F}, {0.54F, 1.00F}},   {{0.54F, 1.00F}, {0.16F, 1.00F}},
    {{0.16F, 1.00F}, {0.00F, 0.82F}},   {{0.00F, 0.82F}, {0.00F, 0.18F}},
    {{0.00F, 0.18F}, {0.16F, 0.00F}},   {{0.16F, 0.00F}, {0.54F, 0.00F}},
    {{0.54F, 0.00F}, {0.70F, 0.18F}},   {{0.70F, 0.18F}, {0.70F, 0.46F}},
    {{0.70F, 0.46F}, {0.42F, 0.46F}},   {{1.10F, 1.00F}, {1.10F, 0.00F}},
    {{1.10F, 0.00F}, {1.65F, 0.00F}},  // L
    {{2.02F, 1.00F}, {2.02F, 0.00F}},  // I
    {{2.42F, 0.00F}, {2.42F, 1.00F}},   {{2.42F, 1.00F}, {3.06F, 0.00F}},
    {{3.06F, 0.00F}, {3.06F, 1.00F}},   {{3.44F, 1.00F}, {4.14F, 1.00F}},
    {{3.79F, 1.00F}, {3.79F, 0.00F}},    // T
    {{0.05F, -0.62F}, {4.05F, -0.62F}},  // arrow
    {{4.05F, -0.62F}, {3.72F, -0.40F}}, {{4.05F, -0.62F}, {3.72F, -0.84F}},
    {{0.05F, -0.48F}, {0.05F, -0.76F}},
}};

float signDistance(const glm::vec2& uv) {
    // The letters span 4.14 x 1.84 units; the image is 2 : 1.
    const glm::vec2 point((uv.x - 0.5F) * 5.2F + 2.07F, (0.5F - uv.y) * 2.6F + 0.08F);
    float distance = 10.0F;
    for (const Stroke& stroke : kSignStrokes) {
        distance = std::min(distance, segmentDistance(point, stroke.from, stroke.to));
    }
    return distance - 0.085F;
}

// Returns the signed distance to a leaf whose axis is along v, in units of its cell.
float leafDistance(const glm::vec2& inside) {
    const glm::vec2 p = glm::abs(inside - 0.5F);
    // Two circles of radius r with centres 2 d apart form a pointed oval.
    constexpr float kRadius = 0.55F;
    constexpr float kOffset = 0.33F;
    return glm::length(p + glm::vec2(kOffset, 0.0F)) - kRadius;
}

float screenDistance(const glm::vec2& uv) {
    const glm::vec2 cells(6.0F, 10.0F);
    glm::vec2 scaled = uv * cells;
    const float row = std::floor(scaled.y);
    scaled.x += static_cast<int>(row) % 2 == 0 ? 0.0F : 0.5F;
    return leafDistance(scaled - glm::floor(scaled));
}

float lanternDistance(const glm::vec2& uv) {
    const glm::vec2 scaled = uv * glm::vec2(20.0F, 10.0F);
    const float row = std::floor(scaled.y);
    const float along = scaled.x + (static_cast<int>(row) % 2 == 0 ? 0.0F : 0.5F);
    const glm::vec2 inside(along - std::floor(along) - 0.5F, scaled.y - row - 0.5F);
    // Holes shrink towards the poles together with the width of the cells.
    const float width = std::max(0.15F, std::sin(glm::pi<float>() * (row + 0.5F) / 10.0F));
    return glm::length(inside * glm::vec2(width, 1.0F)) - 0.30F * width;
}

float landHeight(const glm::vec2& uv) {
    return fractalNoise(uv, {4, 2}, 6, 301) - 0.05F;
}

}  // namespace

Image vaseColor() {
    return paint(512, 512, 3, [](const glm::vec2& uv) {
        const glm::vec3 cream(0.93F, 0.90F, 0.82F);
        const glm::vec3 cobalt(0.10F, 0.22F, 0.52F);
        const glm::vec3 clay(0.66F, 0.40F, 0.28F);
        if (uv.y > 0.9F) {
            return glm::vec4(clay + 0.06F * fractalNoise(uv, glm::ivec2(16), 3, 201), 1.0F);
        }
        // There are bands above and below, and waves between them.
        const float wave = 0.42F + 0.05F * std::sin(uv.x * 8.0F * glm::two_pi<float>());
        float ink = coverage(std::abs(uv.y - wave) - 0.014F, 0.004F);
        ink = std::max(ink, coverage(std::abs(uv.y - wave - 0.09F) - 0.026F, 0.004F));
        for (const float band : {0.12F, 0.15F, 0.28F, 0.66F, 0.70F, 0.88F}) {
            ink = std::max(ink, coverage(std::abs(uv.y - band) - 0.008F, 0.004F));
        }
        const glm::vec2 dots(uv.x * 16.0F - std::floor(uv.x * 16.0F) - 0.5F, (uv.y - 0.21F) * 16.0F);
        ink = std::max(ink, coverage(glm::length(dots) - 0.26F, 0.06F));
        return glm::vec4(glm::mix(cream, cobalt, ink), 1.0F);
    });
}

Image vaseMetallicRoughness() {
    return paint(256, 256, 3,
                 [](const glm::vec2& uv) { return rgb(1.0F, uv.y > 0.9F ? 0.85F : 0.10F, 0.0F); });
}

Image globeColor() {
    return paint(512, 256, 3, [](const glm::vec2& uv) {
        const float land = landHeight(uv);
        const glm::vec3 sea = glm::mix(glm::vec3(0.10F, 0.28F, 0.46F), glm::vec3(0.16F, 0.42F, 0.55F),
                                       glm::smoothstep(-0.5F, 0.0F, land));
        const glm::vec3 ground = glm::mix(glm::vec3(0.42F, 0.52F, 0.26F), glm::vec3(0.72F, 0.62F, 0.42F),
                                          glm::smoothstep(0.05F, 0.4F, land));
        const float ice = glm::smoothstep(0.40F, 0.44F, std::abs(uv.y - 0.5F) + 0.04F * land);
        const glm::vec3 color = glm::mix(sea, ground, glm::smoothstep(-0.005F, 0.005F, land));
        return glm::vec4(glm::mix(color, glm::vec3(0.92F), ice), 1.0F);
    });
}

Image globeMetallicRoughness() {
    return paint(512, 256, 3,
                 [](const glm::vec2& uv) { return rgb(1.0F, landHeight(uv) > 0.0F ? 0.8F : 0.12F, 0.0F); });
}

Image globeEmissive() {
    return paint(512, 256, 3, [](const glm::vec2& uv) {
        const float town = landHeight(uv) > 0.03F ? 1.0F - cellDistance(uv, 48, 311) * 3.0F : 0.0F;
        return glm::vec4(glm::vec3(1.0F, 0.75F, 0.4F) * glm::clamp(town, 0.0F, 1.0F), 1.0F);
    });
}

Image screenColor() {
    return paint(512, 512, 4, [](const glm::vec2& uv) {
        const float hole = coverage(screenDistance(uv), 0.06F);
        const float grain = 0.06F * fractalNoise(uv, {48, 4}, 3, 221);
        const glm::vec3 wood = glm::vec3(0.44F, 0.26F, 0.17F) + grain;
        // The cut-out parts are also dark, so that the motif shows where alpha is not tested.
        return glm::vec4(glm::mix(wood, glm::vec3(0.13F, 0.10F, 0.09F), hole), 1.0F - hole);
    });
}

Image lanternColor() {
    return paint(512, 256, 4, [](const glm::vec2& uv) {
        const float hole = coverage(lanternDistance(uv), 0.08F);
        return glm::vec4(glm::mix(glm::vec3(0.80F, 0.62F, 0.34F), glm::vec3(0.2F, 0.12F, 0.05F), hole),
                         1.0F - hole);
    });
}

Image lanternEmissive() {
    return paint(512, 256, 3, [](const glm::vec2& uv) {
        const float hole = coverage(lanternDistance(uv), 0.08F);
        return glm::vec4(glm::vec3(1.0F, 0.80F, 0.48F) * hole, 1.0F);
    });
}

Image lampColor() {
    return paint(256, 256, 3, [](const glm::vec2& uv) {
        const glm::vec2 grid = glm::abs(uv * glm::vec2(3.0F, 4.0F) - glm::round(uv * glm::vec2(3.0F, 4.0F)));
        if (std::min(grid.x, grid.y * 0.75F) < 0.035F) {
            return rgb(0.16F, 0.10F, 0.06F);
        }
        const float glow = 1.0F - 0.35F * glm::length(uv - 0.5F);
        const float fibres = 0.05F * fractalNoise(uv, {8, 24}, 3, 231);
        return rgb(glow + fibres, glow * 0.90F + fibres, glow * 0.68F + fibres);
    });
}

Image signColor() {
    return paint(512, 256, 3, [](const glm::vec2& uv) {
        const float ink = coverage(signDistance(uv), 0.02F);
        return glm::vec4(glm::mix(glm::vec3(0.10F, 0.12F, 0.16F), glm::vec3(0.95F, 0.93F, 0.85F), ink), 1.0F);
    });
}

Image signEmissive() {
    return paint(512, 256, 3, [](const glm::vec2& uv) {
        const float distance = signDistance(uv);
        const float glow = std::exp(-14.0F * std::max(0.0F, distance)) * 0.28F;
        const float ink = std::max(coverage(distance, 0.02F), glow);
        return glm::vec4(glm::vec3(1.0F, 0.86F, 0.55F) * ink, 1.0F);
    });
}

Image paintingColor() {
    constexpr int kSize = 512;
    constexpr std::array<glm::vec3, 4> kHills{
        {{0.62F, 0.40F, 0.42F}, {0.42F, 0.30F, 0.40F}, {0.22F, 0.28F, 0.34F}, {0.10F, 0.18F, 0.20F}}};
    // Computes the outline of each hill, column by column.
    std::array<std::array<float, kSize>, kHills.size()> ridges{};
    for (std::size_t hill = 0; hill < kHills.size(); ++hill) {
        const auto depth = static_cast<float>(hill);
        for (std::size_t x = 0; x < kSize; ++x) {
            const glm::vec2 line((static_cast<float>(x) + 0.5F) / kSize, 0.1F + 0.2F * depth);
            const float relief = fractalNoise(line, glm::ivec2(3), 4, 251 + static_cast<std::uint32_t>(hill));
            ridges[hill][x] = 0.50F + 0.12F * depth + (0.16F - 0.02F * depth) * relief;
        }
    }
    return paint(kSize, kSize, 3, [&](const glm::vec2& uv) {
        // A low sun stands on the left over folded hills.
        const float haze = uv.y + 0.05F * fractalNoise(uv, {3, 6}, 4, 241);
        glm::vec3 color = glm::mix(glm::vec3(0.16F, 0.24F, 0.42F), glm::vec3(0.96F, 0.66F, 0.40F),
                                   glm::smoothstep(0.0F, 0.55F, haze));
        const float sun = glm::length((uv - glm::vec2(0.30F, 0.40F)) * glm::vec2(1.3F, 1.0F));
        color = glm::mix(color, glm::vec3(1.0F, 0.90F, 0.62F), coverage(sun - 0.10F, 0.01F));
        const auto column = static_cast<std::size_t>(uv.x * kSize);
        for (std::size_t hill = 0; hill < kHills.size(); ++hill) {
            color = glm::mix(color, kHills[hill], coverage(ridges[hill][column] - uv.y, 0.006F));
        }
        const float brush = 0.06F * fractalNoise(uv, {40, 12}, 3, 261);
        return glm::vec4(color + brush, 1.0F);
    });
}

Image footOcclusion() {
    return paint(128, 128, 3, [](const glm::vec2& uv) {
        const float foot = glm::smoothstep(0.0F, 0.35F, 1.0F - uv.y);
        const float edge = glm::smoothstep(0.0F, 0.12F, std::min(uv.x, 1.0F - uv.x));
        const float open = 0.35F + 0.65F * foot * (0.7F + 0.3F * edge);
        return rgb(open, open, open);
    });
}

}  // namespace gallery
