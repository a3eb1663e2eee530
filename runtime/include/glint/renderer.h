// Scenes on the device, and the passes that shade them with a package.
#pragma once

#include <glint/context.h>
#include <glint/effects.h>
#include <glint/memory_report.h>
#include <glint/package.h>
#include <glint/pipeline_statistics.h>
#include <glint/result.h>
#include <glint/scene_view.h>

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace glint {

// What GpuScene::update() did last. Device times are 0 where the queue has no timestamps.
struct MotionStatistics {
    enum class TopLevel : std::uint32_t { Kept, Updated, Rebuilt };
    std::uint32_t deformed = 0;  // instances whose vertices were computed anew
    std::uint32_t refits = 0;    // bottom levels
    std::uint32_t rebuilds = 0;  // likewise
    TopLevel topLevel = TopLevel::Kept;
    double deformMs = 0.0;
    double blasMs = 0.0;
    double tlasMs = 0.0;
};

// Geometry, acceleration structures, materials, textures and lights on the device.
// The Context must outlive it.
class GpuScene {
public:
    // Uploads and builds: BLASes (fast trace, compacted), then the TLAS; waits for the queue. Errors:
    // attributes that disagree with the package, more than 2^24 geometry records, a mesh or structure above a
    // limit of the device.
    static Result<std::unique_ptr<GpuScene>> upload(Context& context, const Package& package,
                                                    const SceneView& scene);
    ~GpuScene();
    GpuScene(const GpuScene&) = delete;
    GpuScene& operator=(const GpuScene&) = delete;

    struct Statistics {
        std::uint64_t triangles = 0;  // of all instances
        std::uint32_t geometries = 0;
        std::uint32_t instances = 0;
        std::uint32_t blasCount = 0;
        std::uint64_t blasBytes = 0;  // after compaction
        std::uint64_t blasUncompactedBytes = 0;
        // 16-bit images that are 8-bit on this device, as it can't filter or blit R16G16B16A16_UNORM.
        std::uint32_t narrowedTextures = 0;
        double orderMs = 0.0;      // wall clock of SceneView::traversalOrder; 0: as the scene has them
        double blasBuildMs = 0.0;  // device time
        double tlasBuildMs = 0.0;
    };
    const Statistics& statistics() const;
    // Buffers and images by what they hold, and the memory that they were allocated with.
    std::vector<MemoryItem> memory() const;
    std::uint64_t allocatedBytes() const;

    // Records into a command buffer of the caller's, in the recording state, outside a render pass, what
    // brings a scene with SceneView::moves to another pose: vertices that follow joints and morph weights are
    // computed, their BLASes refitted, the TLAS updated, instance and light records replaced. BLASes of
    // meshes that keep their shape stay as they are; what has not changed since the last call is not touched.
    // Renderer::record() may follow in the same command buffer; its accumulation should start anew.
    //
    // A BLAS is built anew instead of refitted after 32 refits, or where the box around the mesh has twice
    // the surface that it had at the last build; the TLAS after 32 updates, or where an instance has gone
    // farther than its own box was long (docs/movement.md says why). A flattened instance is hidden until it
    // is whole again.
    //
    // The spans are read here and not kept. One update may be in flight at a time: poses are written to
    // host-visible memory here. What is recorded must be submitted before the next call, which builds upon
    // it. Errors, with which nothing is recorded: "scene-still" (it was uploaded without `moves`),
    // "scene-motion" (another number of instances, lights, joints or weights than at upload, another mesh, or
    // a number that is not finite).
    Status update(VkCommandBuffer commands, const MotionView& motion);

    // Records, submits and waits; for tools and tests.
    Status updateAndWait(const MotionView& motion);

    // Of the last update that has completed on the device; the caller has waited for it.
    Result<MotionStatistics> motion() const;

    struct State;
    State& state();

private:
    explicit GpuScene(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

struct RendererOptions {
    package::Strategy strategy = package::kStrategyVisibility;
    std::uint32_t width = 1280;
    std::uint32_t height = 720;
    // No value: ray queries if package and device have them, else the ray tracing pipeline.
    std::optional<package::Tracer> tracer{};
    // No value: by the number of buckets and the device.
    std::optional<package::Ordering> ordering{};
    // Checks on the device that each hit is in its bucket, once: FrameCounters::orderErrors. Slow.
    bool checkOrder = false;
    // Rays of all effects join one list, and their hits are ordered and shaded together: fewer, larger
    // dispatches, and more memory.
    bool batchEffects = false;
    // Threads that make pipelines, the caller's included; 0: as many as the machine runs at once.
    std::uint32_t pipelineThreads = 0;
    // Has the driver keep what pipelineStatistics() tells. Error "pipeline-statistics" without
    // DeviceHandles::pipelineStatistics.
    bool pipelineStatistics = false;
};

// The ordering that a renderer uses where none is asked for.
package::Ordering defaultOrdering(Context& context, std::uint32_t bucketCount);

// What the rays of a workgroup are sorted by before they join the list.
enum class Binning : std::uint32_t { None = 0, Sign = 1, Octahedral = 2 };

// A linear gradient: zenith above, ground below, horizon between. Radiance in the units of the lights.
struct SkyView {
    std::array<float, 3> zenith{0.25F, 0.45F, 0.85F};
    std::array<float, 3> horizon{0.75F, 0.80F, 0.85F};
    std::array<float, 3> ground{0.20F, 0.18F, 0.16F};
};

class Environment;

// What Renderer::timings() has of a frame.
enum class Timing : std::uint32_t {
    // "frame", all of it; and for each round of rays "hits": from the list of rays on, what finds and shades
    // hits.
    Frame,
    // Every pass. What measures it waits for what runs before, so that passes do not overlap: the sum is
    // more than the frame takes otherwise.
    Passes,
};

struct FrameOptions {
    CameraView camera;
    SkyView sky;
    // Instead of the gradient, for packages that read one (Package::environmentMap()); those need it, the
    // others refuse it. A Renderer keeps the map of its last recording alive.
    const Environment* environment = nullptr;
    float environmentRotation = 0.0F;   // about +Y, counter-clockwise as seen from above, radians
    float environmentIntensity = 1.0F;  // times its radiance
    // Smoother surfaces reflect as mirrors.
    float mirrorRoughness = 0.05F;
    // Surfaces with a greater roughness send no reflection ray.
    float maxReflectionRoughness = 0.3F;
    // Rays an effect and sample with a lesser luminance of their weight are not sent: their light is lost. 0:
    // none.
    float faintWeight = 0.0F;
    // Rays a sample to each light that has a size, from primary surfaces.
    std::uint32_t shadowSamples = 1;
    // Ambient occlusion: rays a sample; how far they reach, metres, infinite for no limit; and whether an
    // occluder counts less the farther it is, linearly to 0 at the radius, which then has to be finite.
    std::uint32_t occlusionSamples = 4;
    float occlusionRadius = std::numeric_limits<float>::infinity();
    bool occlusionFalloff = false;
    // Surfaces that a refracted ray meets at most.
    std::uint32_t maxInterfaces = 8;
    // Counts rays to lights and of ambient occlusion, too; costs time, most with ray tracing pipelines.
    bool countsLight = false;
    // Luminance that a ray of an effect brings at most in one sample; infinite: no limit, which is exact.
    float maxSampleRadiance = std::numeric_limits<float>::infinity();
    Binning binning = Binning::None;
    // Steps of the march in screen space that comes before a ray; 0: none.
    std::uint32_t screenSteps = 0;
    // How far behind its depth a surface is taken to reach in that march, as a share of its distance.
    float screenThickness = 0.02F;
    // Effect bits: of the package's effects with rays, and of ambient occlusion, those that are on.
    std::uint32_t effects = package::kAllEffects;
    std::uint32_t sampleIndex = 0;  // 0 restarts the accumulation
    // Samples of a pixel that the picture will average. Each stands for that share of the pixel's area, so
    // that the cones by which textures are filtered are 1 / sqrt(averagedSamples) as wide. A program that
    // accumulates until something moves gives the number that it usually reaches. 0: render() and
    // renderSamples() take their count of samples, record() takes 1.
    std::uint32_t averagedSamples = 0;
    std::uint32_t seed = 0;
    Timing timing = Timing::Frame;
};

// What a stretch of a frame's time is spent on; docs/architecture.md, "Passes of a frame".
enum class Pass : std::uint32_t {
    Frame,  // everything, with Timing::Frame
    Hits,   // a round of rays, from their list to their shaded hits, with Timing::Frame
    Gbuffer,
    Lighting,
    RefractionWalk,
    EffectRays,
    RayDispatch,
    Uber,
    Trace,
    Count,
    Offset,
    Copy,
    CheckOrder,
    ShadeMiss,
    ShadeCase,
    SortedUber,
    HitShaders,
    ShadowDispatch,
    Shadow,
    Compose,
};

struct PassTiming {
    std::string name;  // for people: also the debug label of the pass
    double milliseconds = 0.0;
    Pass pass = Pass::Frame;
    std::uint32_t shaderId = 0;  // of Pass::ShadeCase
};

// Of one effect in one sample.
struct EffectCounters {
    package::Effect effect{};
    std::uint32_t rays = 0;  // traced to their end: of the list, or to lights and occluders
    std::uint32_t hits = 0;
    std::uint32_t misses = 0;      // also: nothing in the way of a light
    std::uint32_t segments = 0;    // refraction: rays traced from one interface to the next
    std::uint32_t screenHits = 0;  // found in screen space, without a ray
    // Pixels, or lights of pixels, that sent no ray, by the gate that kept them.
    std::uint32_t skippedSky = 0;
    std::uint32_t skippedUnlit = 0;
    std::uint32_t skippedRough = 0;
    std::uint32_t skippedBlack = 0;   // the sample would bring no light
    std::uint32_t skippedAbsent = 0;  // the material has no such lobe
    std::uint32_t skippedFaint = 0;   // FrameOptions::faintWeight
    std::uint32_t skippedFacing = 0;  // shadow: the surface turns from the light
    std::uint32_t skippedRange = 0;
    std::uint32_t skippedCone = 0;
    // Where hits are ordered, and effects are not batched: misses, then hits by shader ID.
    std::vector<std::uint32_t> bucketCounts;
};

struct FrameCounters {
    std::vector<EffectCounters> effects;  // those of the package, in order of their bits
    std::uint32_t rays = 0;               // of all effects
    std::uint32_t shadowRays = 0;         // of hits, deferred ones
    std::uint32_t orderErrors = 0;        // with RendererOptions::checkOrder
    std::uint32_t unknownShader = 0;
    std::uint32_t nonFinite = 0;  // samples since sample 0 that were no number: they count as black
    // Where hits are ordered, of all effects: misses, then hits by shader ID.
    std::vector<std::uint32_t> bucketCounts;

    // Zeros for an effect that the package lacks.
    EffectCounters of(package::Effect effect) const;
};

// How a pixel came to what an effect brings it.
enum class PixelPath : std::uint8_t {
    NoSurface,
    NoRay,   // rough, unlit, or its sample would bring no light
    Screen,  // found in screen space
    Hit,     // by a ray
    Miss,    // by a ray that left the scene
};

// RGBA, 32-bit float, linear, first row on top.
struct LinearImage {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::array<float, 4>> pixels;
};

// Pipelines and per-frame resources for one package, one scene, one size. Context and GpuScene must outlive
// it.
class Renderer {
public:
    static Result<std::unique_ptr<Renderer>> create(Context& context, const Package& package, GpuScene& scene,
                                                    const RendererOptions& options);
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    // Records one sample into a command buffer of the caller's, in the recording state, outside a render
    // pass. Recordings of a renderer share its buffers: they run one after the other, which the barrier at
    // their begin sees to on one queue, and counters() are those of the last. Afterwards output() holds the
    // mean over samples 0..sampleIndex.
    Status record(VkCommandBuffer commands, const FrameOptions& frame);

    // The accumulated linear image: VK_FORMAT_R32G32B32A32_SFLOAT, layout GENERAL, last written by a compute
    // shader.
    VkImage output() const;
    VkImageView outputView() const;

    // Records, submits and waits: samples [0, sampleCount) of the frame; then reads back. For tools and
    // tests.
    // `afterSample` is called when a sample has completed, and counters() and timings() are its own; its
    // error ends the work. FrameOptions::timing is of the last sample, those before are timed as a frame.
    Result<LinearImage> render(const FrameOptions& frame, std::uint32_t sampleCount = 1,
                               const std::function<Status()>& afterSample = {});

    // The same without reading the picture back: to measure time.
    Status renderSamples(const FrameOptions& frame, std::uint32_t sampleCount,
                         const std::function<Status()>& afterSample = {});

    // Of the last recording that has completed on the device; the caller has waited for it. As its
    // FrameOptions::timing says.
    Result<std::vector<PassTiming>> timings();
    Result<FrameCounters> counters();
    // Of each pixel and an effect that sends rays, row by row from the top. Waits for the device. Error
    // "effect-missing" where the package lacks it.
    Result<std::vector<PixelPath>> readCoverage(package::Effect effect = package::kEffectReflection);
    // Which pixels see a surface in the last sample: 1, or 0 for the sky; row by row from the top. Waits for
    // the device.
    Result<std::vector<std::uint8_t>> readSurfaces();

    // What it runs, where RendererOptions left the choice.
    package::Tracer tracer() const;
    package::Ordering ordering() const;
    // Pipelines, images and buffers that there are, for tests and reports.
    struct Footprint {
        std::uint32_t pipelines = 0;
        std::uint32_t images = 0;
        std::uint32_t buffers = 0;
        std::uint64_t bytes = 0;           // of images and buffers
        std::uint64_t allocatedBytes = 0;  // of the memory that holds them
    };
    Footprint footprint() const;
    // Each image and buffer of the footprint.
    std::vector<MemoryItem> memory() const;

    // How the pipelines were made.
    struct PipelineMaking {
        std::uint32_t threads = 0;
        double milliseconds = 0.0;  // wall clock, with their tables
        // Of the pipelines, how many the driver found in the cache of the Context; absent where it does not
        // say.
        std::optional<std::uint32_t> cacheHits;
    };
    PipelineMaking pipelineMaking() const;
    // Of each pipeline, what the driver says of it. Errors: "pipeline-statistics" without
    // RendererOptions::pipelineStatistics, "vulkan-call".
    Result<std::vector<PipelineStatistics>> pipelineStatistics() const;

    struct State;  // for the runtime's own sources and their tests
    State& state();

private:
    explicit Renderer(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace glint
