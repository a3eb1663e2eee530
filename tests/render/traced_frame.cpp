#include "render/traced_frame.h"

#include "context/commands.h"
#include "context/resources.h"
#include "renderer/renderer_state.h"
#include "support/effect_bits.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

namespace glint::testing {
namespace {

Result<std::vector<gpu::RayRecord>> readRays(Renderer::State& state, std::uint32_t count) {
    std::vector<gpu::RayRecord> rays(count);
    if (count == 0) {
        return rays;
    }
    const VkDeviceSize bytes = count * sizeof(gpu::RayRecord);
    MemoryPool pool(state.context);
    Result<Buffer> buffer =
        createBuffer(state.context, pool, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryUse::Readback);
    if (!buffer) {
        return buffer.error();
    }
    Result<CommandRunner> runner = CommandRunner::create(state.context);
    if (!runner) {
        return runner.error();
    }
    const Result<VkCommandBuffer> commands = runner->begin();
    if (!commands) {
        return commands.error();
    }
    const VkBufferCopy region{0, 0, bytes};
    state.context.vk.CmdCopyBuffer(*commands, state.frame.rays.handle.get(), buffer->handle.get(), 1,
                                   &region);
    recordDependency(state.context, *commands,
                     {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
                      VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
    if (Status status = runner->submitAndWait(); !status) {
        return status.error();
    }
    std::memcpy(rays.data(), buffer->mapped, bytes);
    return rays;
}

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
    Result<std::vector<gpu::RayRecord>> rays = readRays(renderer.state(), frame.counters.rays);
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
