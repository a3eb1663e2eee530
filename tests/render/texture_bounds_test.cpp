// Bounds of what textures hold (gltf/texels/texel_bounds.h) against the device's own lookups.
#include "gltf/texels/texel_bounds.h"
#include "render/harness.h"
#include "render/hit_kernel.h"
#include "render/scene_builder.h"
#include "support/must.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace glint::testing {
namespace {

constexpr std::size_t kLookups = 120;  // of each texture

double srgbOf(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

// A material for each pair of wrap modes, each filter, with levels and without.
gltf::Scene texturedScene(std::mt19937& random) {
    gltf::Scene scene = sceneWithCamera();
    constexpr gltf::Wrap kWraps[] = {gltf::Wrap::Repeat, gltf::Wrap::ClampToEdge, gltf::Wrap::MirroredRepeat};
    constexpr int kSizes[][2] = {{7, 5}, {16, 8}, {32, 32}, {1, 6}};
    for (std::size_t i = 0; i < 9 * 2 * 3; ++i) {
        const auto [width, height] = kSizes[i % 4];
        std::vector<std::uint8_t> texels(4 * static_cast<std::size_t>(width * height));
        // Few codes far apart: a texel too many or too few shows.
        std::ranges::generate(
            texels, [&] { return static_cast<std::uint8_t>(random() % 5 == 0 ? 250 : random() % 60); });
        const int texture = addTexture(scene, width, height, std::move(texels));
        gltf::Sampler& sampler = scene.samplers.back();
        sampler.wrapU = kWraps[i % 3];
        sampler.wrapV = kWraps[i / 3 % 3];
        sampler.magnification = i / 9 % 2 == 0 ? gltf::Filter::Linear : gltf::Filter::Nearest;
        sampler.minification = sampler.magnification;
        sampler.mipmapped = i / 18 > 0;
        sampler.mip = i / 18 == 2 ? gltf::Filter::Linear : gltf::Filter::Nearest;
        materials::Material material = unlitMaterial({1, 1, 1});
        material.texture("baseColorTexture").texture = texture;
        const float x = 0.1F * static_cast<float>(i);
        addQuad(scene, material, {x, 0, -3}, {0.1F, 0, 0}, {0, 0.1F, 0});
    }
    return scene;
}

gpu::RayRecord randomLookup(std::uint32_t material, const gltf::Image& image, std::mt19937& random) {
    std::uniform_real_distribution<float> anywhere(-2.5F, 2.5F);
    std::uniform_real_distribution<float> level(0.0F, 6.0F);
    gpu::RayRecord ray{};
    ray.target = material;
    for (int axis = 0; axis < 2; ++axis) {
        float& place = axis == 0 ? ray.origin.x : ray.origin.y;
        place = anywhere(random);
        // Often on the border or in the middle of a texel.
        const auto size = static_cast<float>(axis == 0 ? image.width : image.height);
        place = random() % 2 == 0 ? std::round(place * 2.0F * size) / (2.0F * size) : place;
    }
    ray.origin.z = random() % 3 == 0 ? 0.0F : level(random);
    if (random() % 3 == 0) {
        const float width = std::exp2(-level(random));
        ray.direction = {width, 0.3F * width, -0.02F * width};
        ray.coneWidth = 0.1F * width;
    }
    return ray;
}

TEST(TexelBoundsOfDevice, EncloseEveryLookup) {
    std::mt19937 random(11);
    const gltf::Scene scene = texturedScene(random);
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyUber;  // the less to compile: the kernel reads textures only
    // Devices make levels where sides are powers of two; the importer makes the others (gltf/texels/fit.h).
    std::vector<gltf::Texels> made(scene.images.size());
    const LoadedScene loaded(scene, settings, [&](session::SceneViewData& data) {
        for (std::size_t i = 0; i < made.size(); ++i) {
            const gltf::Image& image = scene.images[i];
            if (std::has_single_bit(static_cast<unsigned>(image.width)) &&
                std::has_single_bit(static_cast<unsigned>(image.height))) {
                continue;
            }
            made[i] = {{image.width, image.height}, gltf::PixelFormat::Rgba8, image.pixels};
            gltf::completeLevels(made[i], gltf::filtersOf(gltf::LevelFilter::Color));
            data.images[i].pixels = made[i].bytes;
            data.images[i].levels = static_cast<std::uint32_t>(made[i].levels);
        }
    });
    const std::unique_ptr<HitKernel> kernel = must(HitKernel::create(scene, loaded, "texture_lookups.comp"));
    std::vector<gpu::RayRecord> rays;
    for (std::uint32_t material = 0; material < scene.materials.size(); ++material) {
        for (std::size_t k = 0; k < kLookups; ++k) {
            rays.push_back(randomLookup(material, scene.images[material], random));
        }
    }
    const auto count = static_cast<std::uint32_t>(rays.size());
    const std::vector<std::uint32_t> words = must(kernel->run({}, rays, count, 4 * rays.size()));

    std::size_t tight = 0;
    for (std::size_t material = 0; material < scene.materials.size(); ++material) {
        const gltf::Image& image = scene.images[material];
        const gltf::TexelBounds bounds({{image.width, image.height}, gltf::PixelFormat::Rgba8, image.pixels},
                                       gltf::levelRulesOf(image, {.isColor = true}));
        for (std::size_t k = material * kLookups; k < (material + 1) * kLookups; ++k) {
            const gpu::RayRecord& ray = rays[k];
            gltf::LookupKind kind{scene.samplers[material]};
            kind.anisotropic = ray.coneWidth > 0.0F;
            const gltf::TexCoordBox box{{ray.origin.x, ray.origin.y}, {ray.origin.x, ray.origin.y}};
            gltf::TexelRange range;
            bounds.joinOver(box, kind, range);
            tight += range.encloses(bounds.whole()) ? 0 : 1;
            for (std::size_t channel = 0; channel < 4; ++channel) {
                const auto value = static_cast<double>(std::bit_cast<float>(words[4 * k + channel]));
                const double code = 255.0 * (channel < 3 ? srgbOf(value) : value);
                // Devices decode sRGB within half a code, and filter with 8 bits.
                EXPECT_GE(code, range.least[channel] - 0.6) << "lookup " << k << ", channel " << channel;
                EXPECT_LE(code, range.greatest[channel] + 0.6) << "lookup " << k << ", channel " << channel;
            }
        }
    }
    EXPECT_GT(tight, rays.size() / 4) << "the bounds say nothing";
}

}  // namespace
}  // namespace glint::testing
