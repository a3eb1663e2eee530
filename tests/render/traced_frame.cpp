#include "render/traced_frame.h"

#include "renderer/renderer.h"
#include "support/effect_bits.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

namespace glint::testing {
namespace {

template <typename Record>
Result<std::vector<Record>> readRecords(Renderer::State& state, CommandRunner& runner, const Buffer& buffer) {
    GLINT_TRY(const auto bytes, readFrameBuffer(state, runner, buffer));
    std::vector<Record> records(bytes.size() / sizeof(Record));
    std::memcpy(records.data(), bytes.data(), records.size() * sizeof(Record));
    return records;
}

}  // namespace

Result<std::vector<gpu::RayRecord>> readRays(Renderer& renderer, std::uint32_t count) {
    Renderer::State& state = renderer.state();
    GLINT_TRY(auto runner, CommandRunner::create(state.context));
    const FrameResources& frame = state.frame;
    GLINT_TRY(const auto listed, readRecords<std::uint32_t>(state, runner, frame.listed));
    GLINT_TRY(const auto starts, readRecords<gpu::SampleStart>(state, runner, frame.sampleStarts));
    GLINT_TRY(const auto aims, readRecords<gpu::SampleAim>(state, runner, frame.sampleAims));
    GLINT_TRY(const auto weights, readRecords<gpu::SampleWeight>(state, runner, frame.sampleWeights));
    std::vector<gpu::RayRecord> rays;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t target = listed[i];
        rays.push_back({starts[target].origin_orRadiance, target, aims[target].direction,
                        aims[target].coneWidth, weights[target].coneSpread});
    }
    return rays;
}

namespace {

// Renders and reads back. The image has no size if that fails.
Status fill(Renderer& renderer, const RenderSetup& setup, TracedFrame& frame) {
    GLINT_TRY(frame.image, renderer.render(setup.frame, setup.samples));
    GLINT_TRY(frame.counters, renderer.counters());
    GLINT_TRY(frame.paths, renderer.readCoverage(package::kEffectReflection));
    GLINT_TRY(frame.rays, readRays(renderer, frame.counters.rays));
    return okStatus();
}

void expectOnePathEach(const TracedFrame& frame, const RenderSetup& setup) {
    const auto count = [&](Renderer::PixelPath path) {
        return static_cast<std::uint32_t>(std::ranges::count(frame.paths, path));
    };
    const Renderer::Counters& counters = frame.counters;
    const Renderer::EffectCounters reflection = counters.of(package::kEffectReflection);
    const std::uint32_t skipped = reflection.skippedRough + reflection.skippedUnlit + reflection.skippedBlack;
    EXPECT_EQ(frame.paths.size(), std::size_t{setup.width} * setup.height);
    EXPECT_EQ(counters.rays + reflection.screenHits + skipped + reflection.skippedSky,
              setup.width * setup.height);
    EXPECT_EQ(count(Renderer::PixelPath::Screen), reflection.screenHits);
    EXPECT_EQ(count(Renderer::PixelPath::Hit) + count(Renderer::PixelPath::Miss), counters.rays);
    EXPECT_EQ(count(Renderer::PixelPath::NoRay), skipped);
    EXPECT_EQ(count(Renderer::PixelPath::NoSurface), reflection.skippedSky);
    EXPECT_EQ(counters.nonFinite, 0U);
    EXPECT_EQ(counters.unknownShader, 0U);
}

}  // namespace

TracedFrame traceFrame(const LoadedScene& scene, package::Strategy strategy, const RenderSetup& setup) {
    RendererOptions options;
    options.strategy = strategy;
    options.width = setup.width;
    options.height = setup.height;
    options.screenMarch = setup.frame.screenSteps > 0;
    TracedFrame frame;
    const auto renderer = scene.makeRenderer(options);
    const Status filled = renderer ? fill(*renderer, setup, frame) : okStatus();
    if (!renderer || !filled) {
        ADD_FAILURE() << (filled ? "there is no renderer" : toString(filled.error()));
        return frame;
    }
    expectOnePathEach(frame, setup);
    return frame;
}

gltf::Primitive makeSphere(int material, gltf::Float3 centre, float radius, int rows) {
    gltf::Primitive sphere;
    sphere.pointer = "/meshes/0/primitives/0";
    sphere.material = material;
    const int columns = 2 * rows;
    for (int row = 0; row <= rows; ++row) {
        const float polar = std::numbers::pi_v<float> * static_cast<float>(row) / static_cast<float>(rows);
        for (int column = 0; column <= columns; ++column) {
            const float around =
                2.0F * std::numbers::pi_v<float> * static_cast<float>(column) / static_cast<float>(columns);
            const gltf::Float3 normal{std::sin(polar) * std::cos(around), std::cos(polar),
                                      std::sin(polar) * std::sin(around)};
            sphere.normals.push_back(normal);
            sphere.positions.push_back({centre[0] + radius * normal[0], centre[1] + radius * normal[1],
                                        centre[2] + radius * normal[2]});
        }
    }
    const auto stride = static_cast<std::uint32_t>(columns) + 1;
    for (std::uint32_t row = 0; row < static_cast<std::uint32_t>(rows); ++row) {
        for (std::uint32_t column = 0; column + 1 < stride; ++column) {
            const std::uint32_t corner = row * stride + column;
            // Triangles at the poles without an area are left out.
            if (row > 0) {
                sphere.indices.insert(sphere.indices.end(), {corner, corner + 1, corner + stride});
            }
            if (row + 1 < static_cast<std::uint32_t>(rows)) {
                sphere.indices.insert(sphere.indices.end(),
                                      {corner + 1, corner + stride + 1, corner + stride});
            }
        }
    }
    return sphere;
}

}  // namespace glint::testing
