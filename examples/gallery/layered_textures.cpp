// Textures of the material extensions.
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

float fraction(float value) {
    return value - std::floor(value);
}

// Returns 1 within `half` of 0, and 0 beyond, over an edge that is `blur` wide.
float stripe(float distance, float half, float blur) {
    return glm::clamp(0.5F - (std::abs(distance) - half) / blur, 0.0F, 1.0F);
}

// Returns the distance to the nearest of the diagonals that cut the square into `count` x `count` lozenges,
// in lozenges.
float lozengeEdge(const glm::vec2& uv, float count) {
    const glm::vec2 diagonal = glm::vec2(uv.x + uv.y, uv.x - uv.y) * count;
    const glm::vec2 edge = glm::abs(diagonal - glm::round(diagonal));
    return std::min(edge.x, edge.y);
}

// The place of a point in a rosette of petals about the middle of the image.
struct Petal {
    int number;
    float across;  // 0 on the petal's axis, 1 on its edge
    float radius;  // 1 at the middle of the image's edges
};

Petal petalAt(const glm::vec2& uv, int count) {
    const glm::vec2 p = uv * 2.0F - 1.0F;
    const float turns = std::atan2(p.y, p.x) / glm::two_pi<float>() + 0.5F;
    const float along = turns * static_cast<float>(count);
    return {static_cast<int>(along) % count, std::abs(fraction(along) - 0.5F) * 2.0F, glm::length(p)};
}

// Returns 1 on the lead between the panes of the roundel.
float roundelLead(const glm::vec2& uv) {
    const Petal outer = petalAt(uv, 8);
    const float arc = outer.radius * glm::pi<float>() / 8.0F;
    float lead = stripe(outer.radius - 0.32F, 0.02F, 0.015F);
    lead = std::max(lead, stripe(outer.radius - 0.72F, 0.02F, 0.015F));
    lead = std::max(lead, stripe(outer.radius - 1.0F, 0.06F, 0.015F));
    const float spoke = stripe((1.0F - outer.across) * arc, 0.018F, 0.015F);
    return outer.radius > 0.32F ? std::max(lead, spoke) : lead;
}

}  // namespace

Image carbonNormal() {
    // This is a twill: each thread passes over two and under two.
    return normalMap(sculpt(256, [](const glm::vec2& uv) {
        const glm::vec2 scaled = uv * 16.0F;
        const glm::ivec2 cell(glm::floor(scaled));
        const glm::vec2 inside = scaled - glm::vec2(cell) - 0.5F;
        const bool warp = ((cell.x + cell.y) & 3) < 2;
        const float across = warp ? inside.x : inside.y;
        return 0.045F * std::sqrt(std::max(0.0F, 0.30F - across * across));
    }));
}

Image lacquerCoat() {
    return paint(256, 256, 3, [](const glm::vec2& uv) {
        const float worn = glm::smoothstep(0.10F, 0.22F, fractalNoise(uv, glm::ivec2(4), 4, 401));
        const float smudge = glm::smoothstep(-0.1F, 0.5F, fractalNoise(uv, glm::ivec2(6), 4, 409));
        return rgb(1.0F - worn, 0.1F + 0.6F * smudge, 0.0F);
    });
}

Image peelNormal() {
    return normalMap(
        sculpt(128, [](const glm::vec2& uv) { return 0.006F * fractalNoise(uv, glm::ivec2(10), 2, 419); }));
}

Image velvetSheen() {
    return paint(256, 256, 4, [](const glm::vec2& uv) {
        const float seam = stripe(lozengeEdge(uv, 6.0F), 0.06F, 0.05F);
        const float nap = 0.10F * fractalNoise(uv, glm::ivec2(16), 3, 421);
        return glm::vec4(glm::vec3(0.90F + nap - 0.80F * seam), 0.75F + 0.25F * seam);
    });
}

Image amberThickness() {
    return paint(256, 256, 3, [](const glm::vec2& uv) {
        const float swirl = fractalNoise(uv + 0.1F * fractalNoise(uv, glm::ivec2(2), 2, 431), {3, 6}, 3, 433);
        return rgb(0.0F, glm::clamp(0.62F + 0.7F * swirl, 0.2F, 1.0F), 0.0F);
    });
}

Image roundelColor() {
    constexpr std::array<glm::vec3, 4> kGlass{
        {{0.93F, 0.36F, 0.28F}, {0.98F, 0.78F, 0.36F}, {0.36F, 0.72F, 0.52F}, {0.34F, 0.52F, 0.90F}}};
    return paint(256, 256, 3, [&](const glm::vec2& uv) {
        const Petal petal = petalAt(uv, 8);
        const int ring = petal.radius < 0.32F ? 0 : petal.radius < 0.72F ? 1 : 2;
        const auto pane = static_cast<std::size_t>(ring == 0 ? 1 : petal.number + 2 * ring) % kGlass.size();
        const float streak = 0.05F * fractalNoise(uv, {4, 12}, 3, 441);
        return glm::vec4(glm::mix(kGlass[pane] + streak, glm::vec3(0.16F), roundelLead(uv)), 1.0F);
    });
}

Image roundelTransmission() {
    return paint(256, 256, 3, [](const glm::vec2& uv) { return rgb(1.0F - roundelLead(uv), 0.0F, 0.0F); });
}

Image oilFilm() {
    return paint(256, 256, 3, [](const glm::vec2& uv) {
        const float flow = fractalNoise(uv, {3, 5}, 3, 451);
        const float thickness = 0.5F + 0.55F * fractalNoise(uv + 0.12F * flow, {2, 3}, 4, 457);
        const float dry = glm::smoothstep(0.34F, 0.40F, fractalNoise(uv, glm::ivec2(5), 3, 461));
        return rgb(1.0F - dry, glm::clamp(thickness, 0.0F, 1.0F), 0.0F);
    });
}

Image porcelainSpecular() {
    // Bands that reflect in colour alternate with bands of bare clay that do not reflect.
    return paint(256, 256, 4, [](const glm::vec2& uv) {
        const float row = fraction(uv.y * 6.0F) - 0.5F;
        const float bare = stripe(row, 0.16F, 0.02F);
        const bool warm = (static_cast<int>(uv.y * 6.0F) & 1) == 0;
        const glm::vec3 color = warm ? glm::vec3(1.0F, 0.80F, 0.45F) : glm::vec3(0.60F, 0.85F, 1.0F);
        return glm::vec4(color, 1.0F - bare);
    });
}

Image turnedAnisotropy() {
    // The strokes swing about the direction of the factor.
    return paint(256, 64, 3, [](const glm::vec2& uv) {
        const float angle = 0.6F * std::sin(uv.x * 12.0F * glm::two_pi<float>());
        const glm::vec2 direction = 0.5F + 0.5F * glm::vec2(std::cos(angle), std::sin(angle));
        return rgb(direction.x, direction.y, uv.y < 0.08F ? 0.0F : 1.0F);
    });
}

Image paperTransmission() {
    return paint(256, 256, 4, [](const glm::vec2& uv) {
        const float rib = stripe(fraction(uv.x * 16.0F) - 0.5F, 0.03F, 0.02F);
        const float fibre = 0.10F * fractalNoise(uv, {12, 24}, 4, 471);
        const glm::vec3 warm(0.98F + fibre, 0.88F + fibre, 0.68F + fibre);
        return glm::vec4(glm::mix(warm, glm::vec3(0.35F, 0.2F, 0.1F), rib), 1.0F - 0.8F * rib);
    });
}

Image celadonColor() {
    return paint(256, 256, 3, [](const glm::vec2& uv) {
        const float crackle = stripe(cellDistance(uv, 12, 481) - 0.62F, 0.02F, 0.03F);
        const float gilt = stripe(uv.y - 0.12F, 0.03F, 0.004F);
        const glm::vec3 glaze = glm::vec3(0.55F, 0.72F, 0.62F) - 0.14F * crackle;
        return glm::vec4(glm::mix(glaze, glm::vec3(0.05F), gilt), 1.0F);
    });
}

Image celadonSpecularGlossiness() {
    return paint(256, 256, 4, [](const glm::vec2& uv) {
        const float gilt = stripe(uv.y - 0.12F, 0.03F, 0.004F);
        // 0.22 in sRGB is the 4 % of glass.
        return glm::vec4(glm::mix(glm::vec3(0.22F), glm::vec3(0.95F, 0.80F, 0.45F), gilt),
                         glm::mix(0.92F, 0.75F, gilt));
    });
}

}  // namespace gallery
