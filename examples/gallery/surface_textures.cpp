// Stone, brick, plaster, wood, water, metal, cloth.
#include "noise.h"
#include "textures.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace gallery {

namespace {

// Returns 1 along thin wandering lines and 0 elsewhere.
float veins(const glm::vec2& uv, int period, std::uint32_t seed) {
    const float wander = fractalNoise(uv, glm::ivec2(period * 2), 4, seed + 10);
    const float field = fractalNoise(uv, glm::ivec2(period), 3, seed) + 0.35F * wander;
    return std::pow(1.0F - std::min(1.0F, std::abs(field) * 2.2F), 8.0F);
}

struct Tile {
    glm::ivec2 cell;
    glm::vec2 inside;  // within the tile, [0, 1)²
    bool dark;
    bool joint;
};

Tile floorTile(const glm::vec2& uv) {
    constexpr float kTiles = 4.0F;
    const glm::vec2 scaled = uv * kTiles;
    const glm::ivec2 cell(glm::floor(scaled));
    const glm::vec2 inside = scaled - glm::vec2(cell);
    const glm::vec2 fromEdge = glm::min(inside, 1.0F - inside);
    return {cell, inside, ((cell.x + cell.y) & 1) == 0, std::min(fromEdge.x, fromEdge.y) < 0.008F};
}

// Each tile is cut from a different place of the stone.
float floorVeins(const Tile& tile) {
    const auto seed = static_cast<std::uint32_t>(100 + tile.cell.x * 7 + tile.cell.y * 31);
    return veins(tile.inside, 2, seed);
}

struct Brick {
    glm::ivec2 cell;
    float profile;  // 0 in the mortar, 1 on the brick
};

Brick brickAt(const glm::vec2& uv) {
    const glm::vec2 wobble(fractalNoise(uv, glm::ivec2(16), 3, 41), fractalNoise(uv, glm::ivec2(16), 3, 47));
    constexpr float kColumns = 4.0F;
    constexpr float kRows = 10.0F;
    const glm::vec2 moved = uv + wobble * 0.0035F;
    const float row = std::floor(moved.y * kRows);
    const float shift = static_cast<int>(row) % 2 == 0 ? 0.0F : 0.5F;
    const float along = moved.x * kColumns + shift;
    const float column = std::floor(along);
    const glm::vec2 inside(along - column, moved.y * kRows - row);
    // The distance to the brick's edge, in units of the image.
    const glm::vec2 fromEdge =
        glm::min(inside, 1.0F - inside) / glm::vec2(kColumns, kRows) - glm::vec2(0.006F);
    const float profile = glm::smoothstep(-0.001F, 0.007F, std::min(fromEdge.x, fromEdge.y));
    return {{static_cast<int>(column) & 3, (static_cast<int>(row) + 10) % 10}, profile};
}

float woodRings(const glm::vec2& uv) {
    const float bend = fractalNoise(uv, {2, 6}, 3, 61);
    const float fibres = fractalNoise(uv, {8, 96}, 3, 67);
    const float rings = uv.y * 9.0F + bend * 1.6F;
    const float ring = rings - std::floor(rings);
    return glm::clamp(0.25F + 0.6F * ring * ring + 0.3F * fibres, 0.0F, 1.0F);
}

float brushedStroke(const glm::vec2& uv) {
    return fractalNoise(uv, {2, 64}, 3, 83);
}

}  // namespace

Image floorColor() {
    return paint(1024, 1024, 3, [](const glm::vec2& uv) {
        const Tile tile = floorTile(uv);
        if (tile.joint) {
            return rgb(0.22F, 0.21F, 0.20F);
        }
        const float vein = floorVeins(tile);
        const float tint = hashUnit(tile.cell.x, tile.cell.y, 5) * 0.06F;
        const glm::vec3 dark = glm::vec3(0.40F, 0.42F, 0.46F) + tint + 0.16F * vein;
        const glm::vec3 light =
            glm::vec3(0.54F, 0.515F, 0.48F) + tint - glm::vec3(0.10F, 0.11F, 0.12F) * vein;
        return glm::vec4(tile.dark ? dark : light, 1.0F);
    });
}

Image floorMetallicRoughness() {
    return paint(512, 512, 3, [](const glm::vec2& uv) {
        const Tile tile = floorTile(uv);
        if (tile.joint) {
            return rgb(0.7F, 0.05F, 0.0F);
        }
        const float vein = floorVeins(tile);
        // Dark tiles are black glass on a metal back, so they reflect more than stone can.
        return rgb(1.0F, 0.012F + 0.03F * vein, tile.dark ? 0.85F : 0.0F);
    });
}

Image brickColor() {
    return paint(512, 512, 3, [](const glm::vec2& uv) {
        const Brick brick = brickAt(uv);
        const float pick = hashUnit(brick.cell.x, brick.cell.y, 9);
        const glm::vec3 fired =
            glm::mix(glm::vec3(0.58F, 0.36F, 0.28F), glm::vec3(0.74F, 0.53F, 0.42F), pick);
        const glm::vec3 mortar(0.70F, 0.66F, 0.60F);
        const float grain = 0.07F * fractalNoise(uv, glm::ivec2(24), 4, 13);
        return glm::vec4(glm::mix(mortar, fired, brick.profile) + grain, 1.0F);
    });
}

Image brickOcclusionRoughnessMetallic() {
    return paint(256, 256, 3, [](const glm::vec2& uv) {
        const Brick brick = brickAt(uv);
        return rgb(0.45F + 0.55F * brick.profile, 0.95F - 0.12F * brick.profile, 0.0F);
    });
}

Image brickNormal() {
    return normalMap(sculpt(512, [](const glm::vec2& uv) {
        const Brick brick = brickAt(uv);
        const float tilt = 0.001F * hashUnit(brick.cell.x, brick.cell.y, 17);
        return brick.profile * (0.007F + tilt) + 0.0014F * fractalNoise(uv, glm::ivec2(20), 4, 13);
    }));
}

Image plasterColor() {
    return paint(256, 256, 3, [](const glm::vec2& uv) {
        const float cloud = 0.05F * fractalNoise(uv, glm::ivec2(3), 4, 23);
        return rgb(0.88F + cloud, 0.86F + cloud, 0.82F + cloud);
    });
}

Image plasterNormal() {
    return normalMap(sculpt(512, [](const glm::vec2& uv) {
        const float swirl = fractalNoise(uv, glm::ivec2(3), 3, 29);
        return 0.004F * fractalNoise(uv + 0.06F * swirl, {5, 16}, 4, 31);
    }));
}

Image woodColor() {
    return paint(512, 512, 3, [](const glm::vec2& uv) {
        const glm::vec3 early(0.72F, 0.51F, 0.32F);
        const glm::vec3 late(0.40F, 0.25F, 0.14F);
        return glm::vec4(glm::mix(early, late, woodRings(uv)), 1.0F);
    });
}

Image woodMetallicRoughness() {
    return paint(256, 256, 3,
                 [](const glm::vec2& uv) { return rgb(1.0F, 0.45F + 0.25F * woodRings(uv), 0.0F); });
}

Image marbleColor() {
    return paint(512, 512, 3, [](const glm::vec2& uv) {
        const float cloud = 0.04F * fractalNoise(uv, glm::ivec2(2), 4, 71);
        const float vein = veins(uv, 2, 73) + 0.4F * veins(uv, 4, 77);
        return rgb(0.86F + cloud - 0.22F * vein, 0.85F + cloud - 0.21F * vein, 0.83F + cloud - 0.18F * vein);
    });
}

Image waterNormal() {
    return normalMap(sculpt(256, [](const glm::vec2& uv) {
        return 0.012F * fractalNoise(uv, {3, 7}, 4, 53);
    }));
}

Image brushedMetallicRoughness() {
    return paint(256, 256, 3,
                 [](const glm::vec2& uv) { return rgb(1.0F, 0.36F + 0.08F * brushedStroke(uv), 1.0F); });
}

Image brushedNormal() {
    return normalMap(sculpt(256, [](const glm::vec2& uv) { return 0.0007F * brushedStroke(uv); }));
}

Image hammeredNormal() {
    return normalMap(sculpt(512, [](const glm::vec2& uv) {
        const float distance = cellDistance(uv, 14, 91);
        return 0.012F * distance * distance;
    }));
}

Image canvasNormal() {
    return normalMap(sculpt(128, [](const glm::vec2& uv) {
        const glm::vec2 wave = glm::vec2(std::sin(uv.x * 16.0F * glm::two_pi<float>()),
                                         std::sin(uv.y * 16.0F * glm::two_pi<float>()));
        return 0.004F * std::max(wave.x * wave.y, -wave.x * wave.y) + 0.002F * wave.x * wave.y;
    }));
}

}  // namespace gallery
