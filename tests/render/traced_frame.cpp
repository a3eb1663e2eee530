#include "render/traced_frame.h"

#include "renderer/renderer.h"
#include "support/effect_bits.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

namespace glint::testing {
namespace {

template <typename Value>
Status statusOf(const Result<Value>& result) {
    return result ? okStatus() : Status(result.error());
}

template <typename Record>
Result<std::vector<Record>> readRecords(Renderer::State& state, CommandRunner& runner, const Buffer& buffer) {
    const Result<std::vector<std::uint8_t>> bytes = readFrameBuffer(state, runner, buffer);
    if (!bytes) {
        return bytes.error();
    }
    std::vector<Record> records(bytes->size() / sizeof(Record));
    std::memcpy(records.data(), bytes->data(), records.size() * sizeof(Record));
    return records;
}

}  // namespace

Result<std::vector<gpu::RayRecord>> readRays(Renderer& renderer, std::uint32_t count) {
    Renderer::State& state = renderer.state();
    Result<CommandRunner> runner = CommandRunner::create(state.context);
    if (!runner) {
        return runner.error();
    }
    const FrameResources& frame = state.frame;
    const auto listed = readRecords<std::uint32_t>(state, *runner, frame.listed);
    const auto starts = readRecords<gpu::SampleStart>(state, *runner, frame.sampleStarts);
    const auto aims = readRecords<gpu::SampleAim>(state, *runner, frame.sampleAims);
    const auto weights = readRecords<gpu::SampleWeight>(state, *runner, frame.sampleWeights);
    for (const Status& status : {statusOf(listed), statusOf(starts), statusOf(aims), statusOf(weights)}) {
        if (!status) {
            return status.error();
        }
    }
    std::vector<gpu::RayRecord> rays;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t target = (*listed)[i];
        rays.push_back({(*starts)[target].origin_orRadiance, target, (*aims)[target].direction,
                        (*aims)[target].coneWidth, (*weights)[target].coneSpread});
    }
    return rays;
}

namespace {

// Renders and reads back. The image has no size if that fails.
Status fill(Renderer& renderer, const RenderSetup& setup, TracedFrame& frame) {
    Result<LinearImage> image = renderer.render(setup.frame, setup.samples);
    if (!image) {
        return image.error();
    }
    const Result<FrameCounters> counters = renderer.counters();
    if (!counters) {
        return counters.error();
    }
    frame.counters = *counters;
    Result<std::vector<PixelPath>> paths = renderer.readCoverage(package::kEffectReflection);
    if (!paths) {
        return paths.error();
    }
    frame.paths = std::move(*paths);
    Result<std::vector<gpu::RayRecord>> rays = readRays(renderer, frame.counters.rays);
    if (!rays) {
        return rays.error();
    }
    frame.rays = std::move(*rays);
    frame.image = std::move(*image);
    return okStatus();
}

void expectOnePathEach(const TracedFrame& frame, const RenderSetup& setup) {
    const auto count = [&](PixelPath path) {
        return static_cast<std::uint32_t>(std::ranges::count(frame.paths, path));
    };
    const FrameCounters& counters = frame.counters;
    const EffectCounters reflection = counters.of(package::kEffectReflection);
    const std::uint32_t skipped = reflection.skippedRough + reflection.skippedUnlit + reflection.skippedBlack;
    EXPECT_EQ(frame.paths.size(), std::size_t{setup.width} * setup.height);
    EXPECT_EQ(counters.rays + reflection.screenHits + skipped + reflection.skippedSky,
              setup.width * setup.height);
    EXPECT_EQ(count(PixelPath::Screen), reflection.screenHits);
    EXPECT_EQ(count(PixelPath::Hit) + count(PixelPath::Miss), counters.rays);
    EXPECT_EQ(count(PixelPath::NoRay), skipped);
    EXPECT_EQ(count(PixelPath::NoSurface), reflection.skippedSky);
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
    const Result<std::unique_ptr<Renderer>> renderer =
        Renderer::create(sharedContext(), scene.package(), scene.gpuScene(), options);
    TracedFrame frame;
    const Status filled = renderer ? fill(**renderer, setup, frame) : Status(renderer.error());
    if (!filled) {
        ADD_FAILURE() << toString(filled.error());
        return frame;
    }
    expectOnePathEach(frame, setup);
    expectNoValidationMessages();
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
