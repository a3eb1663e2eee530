// The passes that shade a scene on the device with a package's shaders.
//
// Threads: a scene, its renderers and its editor are used by one thread at a time; different scenes may be
// used on different threads at once. Renderers may be created and destroyed on other threads meanwhile,
// unless a package waits to replace theirs. Functions do not wait for the device and submit nothing unless
// they say so. Those that submit use DeviceHandles::queue, locked by HostServices::lockQueue for the
// submission alone.
#pragma once

#include <glint/context.h>
#include <glint/image.h>
#include <glint/layers.h>
#include <glint/package.h>
#include <glint/package_shape.h>
#include <glint/renderer_options.h>
#include <glint/result.h>
#include <glint/scene.h>
#include <glint/scene_view.h>

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace glint {

// Returns the ordering that a renderer uses if RendererOptions::ordering has no value.
package::Ordering defaultOrdering(Context& context, std::uint32_t bucketCount);

// The pipelines and per-frame resources for one package, one scene and one size. Context and GpuScene must
// outlive it.
class Renderer {
public:
    // Makes all pipelines, images and buffers, which takes as long as the driver needs. The scene must have
    // been made with `package`, or have it from replacePackage(), else the error is "scene-package". Further
    // errors: "renderer-options" (not exactly one strategy, tracer or ordering), "package-strategy",
    // "package-tracer" and "package-bounces" (the package lacks it), "package-fallback" (see
    // RendererOptions::backgroundPipelines), "device-tracer" and "device-ordering" (the device lacks it),
    // "pipeline-statistics", "render-size" (no pixels, or more than the device supports), and those of memory
    // and Vulkan's calls. With a strategy that has a pipeline of its own, this is also an edit of a scene
    // with sealed parts: the next SceneEditor::record() parts their BLASes.
    static Result<std::unique_ptr<Renderer>> create(Context& context, const Package& package, GpuScene& scene,
                                                    const RendererOptions& options);
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    using Replacement = PackageReplacement;
    using ReplacementProgress = PackageProgress;

    // Switches to another package of the same scene: one that was compiled again after a material, a pack's
    // GLSL or a setting changed. Waits neither for the queue nor for frames in flight. It keeps pipelines
    // whose SPIR-V is the same and buffers of the same size. The rest is made in this call or, with
    // RendererOptions::backgroundPipelines, by threads. Until everything is ready, recordings use the old
    // package. The first recording after that switches pipelines, material records and shader IDs at once.
    // Its commands must be submitted, because those of later recordings rely on them. If it has a sampleIndex
    // above 0, its picture averages samples of both packages; see ReplacementProgress::ready.
    //
    // The options stay those of create(). A package that waits gives way to one that is given later.
    // Renderers that share a GpuScene switch together: this makes what each of them needs, and the first
    // recording of any of them after that switches all. Its commands must come before those of their later
    // recordings. If RaySteps share it, too, the package waits until they have one of the same compilation,
    // or are destroyed; ReplacementProgress::waitsFor names them. `package` must not be null; the renderers
    // keep it as long as it is needed.
    //
    // In a scene that is edited, the textures, materials, meshes, instances and lights of edits stay; see
    // docs/live.md, "Replacing a package". Edits after the recording that switches give records in the layout
    // of the new package. So do poses (GpuScene::update()) that give values of materials.
    //
    // With an error nothing changes. Errors: those of create() for package and options; "scene-package" (the
    // scene has another name, or vertices, textures or acceleration structures that do not suit the package,
    // so that it has to be uploaded anew), "position-fetch", "half-precision"; "package-frame" (its frames
    // have other images); in a scene that is edited also "texture-trusted", and those of SceneEditor for
    // materials that the package has no shader for. replacementProgress() has errors of making pipelines in
    // the background, and those of edits after the call.
    Result<Replacement> replacePackage(const std::shared_ptr<const Package>& package);
    ReplacementProgress replacementProgress() const;
    // Gives up a package that waits, for all renderers of the scene. Recordings continue with the old
    // package. Without such a package nothing changes.
    void withdrawPackage();

    // Replaced pipelines and buffers are kept until no frame uses them. recordings() returns how many
    // recordings there were: the number of the last one. finished() says that the device has completed all
    // recordings up to a number. It destroys the resources that only those used, and reads the depth of their
    // paths, so that later recordings with more than 8 bounces leave out those that few paths reach. It never
    // waits. A program that replaces packages or has many bounces should call it once for each frame;
    // render() and renderSamples() do so themselves.
    std::uint64_t recordings() const;
    void finished(std::uint64_t recording);

    // Records one sample into a command buffer of the caller's, in the recording state and outside a render
    // pass. Recordings of a renderer share its buffers, so they must run one after the other. On one queue
    // the barrier at their beginning ensures that. counters() returns those of the last recording. After the
    // commands ran, output() holds the mean over samples 0..sampleIndex. The commands of the first recording
    // prepare images and tables for all that follow, so they must be submitted. FrameOptions::environment may
    // change and the one before may be destroyed while frames are in flight; finished() frees it. With an
    // error nothing is recorded. Errors: "camera", "sky", "frame-options", "environment-missing",
    // "environment-unread", "scene-package" (the scene has sealed parts that SceneEditor::record() has to
    // part for this strategy), and those of memory and Vulkan's calls.
    Status record(VkCommandBuffer commands, const FrameOptions& frame);

    // The accumulated linear image. After the first recording its layout is GENERAL; a compute shader writes
    // it last. Its format is VK_FORMAT_R32G32B32A32_SFLOAT, or VK_FORMAT_R16G16B16A16_SFLOAT with
    // RendererOptions::PictureFormat::Half.
    VkImage output() const;
    VkFormat outputFormat() const;
    VkImageView outputView() const;

    // An image of a layer (glint/layers.h). Its usage includes storage, sampled and both kinds of transfer.
    struct LayerImage {
        std::string_view name;                     // PackageLayer::name
        const package::LayerInfo* info = nullptr;  // its row
        package::Effect effect = 0;  // of the source of light; 0 for surfaces and the direct light
        std::uint32_t bounce = 0;    // from 1, of layers of a bounce; 0 for others
        VkImage image = VK_NULL_HANDLE;
        VkImageView view = VK_NULL_HANDLE;
        VkFormat format = VK_FORMAT_UNDEFINED;
        // It is in this layout after the first recording.
        static constexpr VkImageLayout kLayout = VK_IMAGE_LAYOUT_GENERAL;
    };
    // The images of the package's layers, in the order of Package::layers(). They live as long as the
    // renderer. Shaders of a recording write them last, so commands that read them need a dependency on its
    // shader writes, and are to complete before those of the next recording, or be ordered before them on the
    // same queue. The values are those of the picture so far, as LayerInfo::mean says; a draft
    // (RendererOptions::draft) leaves them as they are. Motion leads to the previous frame: the picture that
    // this renderer began before this one.
    std::vector<LayerImage> layers() const;
    // Reads a layer of the last recording back: submits, and waits for the device. Errors: "layer-missing" if
    // the package lacks it, "frame-not-recorded".
    Result<LayerValues> readLayer(std::string_view name);

    // Records and submits samples [0, sampleCount) of the frame, waits for the device and reads the picture
    // back. This is for tools and tests. `afterSample` is called after each completed sample; counters() and
    // timings() are then those of that sample. An error that it returns ends the work. FrameOptions::timing
    // applies to the last sample; the samples before it are timed as whole frames.
    Result<LinearImage> render(const FrameOptions& frame, std::uint32_t sampleCount = 1,
                               const std::function<Status()>& afterSample = {});

    // Does the same without reading the picture back, to measure time.
    Status renderSamples(const FrameOptions& frame, std::uint32_t sampleCount,
                         const std::function<Status()>& afterSample = {});

    // The counters of one effect in one sample.
    struct EffectCounters {
        package::Effect effect = 0;
        package::EffectInfo::Kind kind = package::EffectInfo::Kind::Rays;
        std::string name;
        std::uint32_t rays = 0;  // rays traced to their end: those of the list, or to lights and occluders
        std::uint32_t hits = 0;
        std::uint32_t misses = 0;      // also rays to a light with nothing in their way
        std::uint32_t segments = 0;    // rays on their way before the one that joins the list
        std::uint32_t screenHits = 0;  // hits found in screen space, without a ray
        std::uint32_t waited = 0;  // those of `rays` that waited in memory, as shadow rays of first hits do
        // Pixels, or lights of pixels, that sent no ray. Each counter belongs to the gate that stopped them.
        std::uint32_t skippedSky = 0;
        std::uint32_t skippedUnlit = 0;
        std::uint32_t skippedRough = 0;
        std::uint32_t skippedBlack = 0;   // the sample would bring no light
        std::uint32_t skippedAbsent = 0;  // the material has no such lobe
        std::uint32_t skippedFaint = 0;   // below FrameOptions::faintWeight
        std::uint32_t skippedFacing = 0;  // the surface faces away from the light
        std::uint32_t skippedRange = 0;
        std::uint32_t skippedCone = 0;
        // Misses, then hits by shader ID. Filled if hits are ordered and effects are not batched.
        std::vector<std::uint32_t> bucketCounts;
    };

    struct Counters {
        std::vector<EffectCounters> effects;  // the package's effects, in the order of their bits
        bool draft = false;            // the frame is a draft (RendererOptions::draft), which sends no rays
        std::uint32_t rays = 0;        // rays of all effects
        std::uint32_t shadowRays = 0;  // deferred shadow rays of hits
        // The rounds in which the shadow rays of first hits were traced; 0 if they do not wait in memory.
        // Each round after the first shades the pixels again that have more shadow rays than the rounds
        // before held: PackageShape::firstShadowRays each. A frame with many lights is faster with a package
        // that chooses among them (--lights K) or whose first hits trace their rays themselves
        // (--first-shadows inline).
        std::uint32_t shadowRounds = 0;
        std::uint32_t orderErrors = 0;    // with RendererOptions::checkOrder
        std::uint32_t unknownShader = 0;  // hits whose shader ID no case has, without a fallback
        std::uint32_t alphaTests = 0;  // candidates whose alpha was tested, with RendererOptions::countsLight
        std::uint32_t nonFinite = 0;   // samples since sample 0 that were not finite; they count as black
        // Rays by bounce, from the first: those of the effects, then those that hits sent. They add up to
        // `rays`.
        std::vector<std::uint32_t> raysOfBounces;
        // Pixels that see no surface, then pixels by the shader ID of what they see. Empty for a draft.
        std::vector<std::uint32_t> pixelCounts;
        // Misses, then hits by shader ID, of all effects and bounces. Filled if hits are ordered.
        std::vector<std::uint32_t> bucketCounts;
        // The finest level that surfaces and hits have read of each texture, by PackageScene::textures, or by
        // TextureHandle::index in a scene that is edited. Levels count from the whole image, whichever are on
        // the device. Filled for packages with Package::textureLevels().
        static constexpr std::uint32_t kLevelNotRead = 0xFFFFFFFF;
        std::vector<std::uint32_t> textureLevels;

        // Returns zeros for an effect that the package lacks.
        EffectCounters of(package::Effect effect) const;
    };

    // These return the results of the last recording. The caller must have waited until the device completed
    // it. FrameOptions::timing of that recording says which times there are.
    Result<std::vector<PassTiming>> timings();
    Result<Counters> counters();
    // The source of a pixel's light from an effect.
    enum class PixelPath : std::uint8_t {
        NoSurface,
        NoRay,   // rough, unlit, or its sample would bring no light
        Screen,  // found in screen space
        Hit,     // found by a ray
        Miss,    // the ray left the scene
    };
    // Says for each pixel how it got the light of an effect that sends rays, row by row from the top.
    // Submits, and waits for the device. Errors: "effect-missing" if the package lacks the effect,
    // "frame-options" if the frame was lit in several bands.
    Result<std::vector<PixelPath>> readCoverage(package::Effect effect);
    // Says for each pixel whether it sees a surface in the last sample: 1 for a surface, 0 for the sky; row
    // by row from the top. Submits, and waits for the device.
    Result<std::vector<std::uint8_t>> readSurfaces();
    // The surface that a pixel sees.
    struct SurfacePlace {
        std::uint32_t instance = 0;  // index into SceneView::instances, or that of `handle`
        std::uint32_t mesh = 0;      // the numbers of PrimitiveView; in a scene that is edited, of MeshHandle
        std::uint32_t primitive = 0;
        std::uint32_t shaderId = 0;  // of the case that shades hits on it; their bucket is 1 + shaderId
        InstanceHandle handle;       // for SceneEditor
    };
    // Returns the surface that a pixel sees in the last sample, or no value if it sees the sky. (0, 0) is the
    // pixel at the top left. Edits since that sample count. Submits, and waits for the device. Error
    // "render-size" for a pixel outside of the picture.
    Result<std::optional<SurfacePlace>> readPlace(std::uint32_t x, std::uint32_t y);
    // Reads output() back: submits, and waits for the device.
    Result<LinearImage> readOutput();

    // Returns the tracer and the ordering that the renderer uses, also where RendererOptions left the choice
    // to it.
    package::Tracer tracer() const;
    package::Ordering ordering() const;
    // Returns the number of bands in which frames are lit, also where RendererOptions::bands is 0.
    std::uint32_t bands() const;
    // The number of pipelines, images and buffers, for tests and reports.
    struct Footprint {
        std::uint32_t pipelines = 0;
        std::uint32_t images = 0;
        std::uint32_t buffers = 0;
        std::uint64_t bytes = 0;           // size of images and buffers
        std::uint64_t allocatedBytes = 0;  // size of the memory that holds them
    };
    Footprint footprint() const;
    // Lists each image and buffer of the footprint.
    std::vector<MemoryItem> memory() const;

    // A report of how the pipelines were made.
    struct PipelineMaking {
        std::uint32_t threads = 0;
        double milliseconds = 0.0;  // wall clock, shader binding tables included
        // The number of pipelines that the driver found in the Context's cache. It has no value if the driver
        // does not report it.
        std::optional<std::uint32_t> cacheHits;
    };
    PipelineMaking pipelineMaking() const;
    // The progress of the threads that make pipelines while frames are drawn.
    struct PipelineProgress {
        std::uint32_t wanted = 0;   // pipelines that are made in the background
        std::uint32_t made = 0;     // those that were made, or have failed
        std::uint32_t adopted = 0;  // those that recordings use
        // The first error. Its passes keep the fallback, or the draft.
        std::optional<Diagnostic> error{};
        // True if the next recording may be a draft (RendererOptions::draft), and the number of drafts so
        // far.
        bool draft = false;
        std::uint64_t drafts = 0;
    };

    // With RendererOptions::backgroundPipelines, record() uses the pipelines that were made by then.
    // pipelineProgress() says how many are made. The other function waits until the last one is made,
    // also of a package that waits to replace this one. Without that option no pipeline is missing. Both
    // may be called from any thread while the renderer is not recorded.
    PipelineProgress pipelineProgress() const;
    void waitForPipelines();
    // A driver's report about a pipeline, in the terms of VK_KHR_pipeline_executable_properties.
    struct PipelineStatistics {
        // One number. The driver chooses the name and the description.
        struct Statistic {
            std::string name;
            std::string description;
            std::variant<bool, std::int64_t, std::uint64_t, double> value;
        };
        // A piece of code of a pipeline on the device. A driver may make one for each stage, or fewer, or
        // more.
        struct Executable {
            std::string name;
            std::string description;
            VkShaderStageFlags stages = 0;
            std::uint32_t subgroupSize = 0;  // 0: it may vary, or the driver gives none
            std::vector<Statistic> statistics;
        };

        std::string name;  // the role of its module in the manifest, and its case, effect or ordering
        // These have no value if the driver does not report them.
        std::optional<double> creationMs;
        std::optional<bool> cacheHit;
        std::vector<Executable> executables;
    };

    // Returns the driver's report about each pipeline. Errors: "pipeline-statistics" without
    // RendererOptions::pipelineStatistics, "vulkan-call".
    Result<std::vector<PipelineStatistics>> pipelineStatistics() const;

    struct State;  // for the runtime's own sources and their tests
    State& state();

private:
    explicit Renderer(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace glint
