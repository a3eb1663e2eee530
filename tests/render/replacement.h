// What tests share in which a renderer takes over another package while it draws.
#pragma once

#include "render/harness.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

namespace glint::testing {

// Settings with a case for each key, whose rays are reflections.
compiler::CompileSettings roomSettings(std::uint32_t strategies, bool fallback = false);

inline constexpr std::size_t kGlossy = 1;  // the material of the room that is edited

void giveCoat(materials::Material& material);
void giveSheen(materials::Material& material);
// Returns a mirror below walls with a material each.
gltf::Scene roomScene();
// Returns the room with another value of one of its materials.
gltf::Scene repaintedRoom();

// Expects the same bits.
void expectEqualImage(const LinearImage& image, const LinearImage& reference, const std::string& what);
inline bool differ(const LinearImage& first, const LinearImage& second) {
    return first.pixels != second.pixels;
}

// Throws as must() does.
std::shared_ptr<const Package> packageOf(const gltf::Scene& scene, const compiler::CompileSettings& settings);

// Makes small pictures of `setup_`.
class ReplacementTest : public ::testing::Test {
protected:
    RendererOptions optionsOf(package::Strategy strategy,
                              std::optional<package::Tracer> tracer = std::nullopt) const;
    LinearImage draw(Renderer& renderer) const;
    // Returns the picture of an upload and a renderer of its own.
    LinearImage fresh(const gltf::Scene& scene, const Package& package, const RendererOptions& options) const;

    RenderSetup setup_;
};

}  // namespace glint::testing
