// The options of a renderer and of each of its frames, and what it reports of them.
#pragma once

#include <glint/package_shape.h>
#include <glint/result.h>
#include <glint/scene_view.h>

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glint {

struct RendererOptions {
    // The precision of a picture's channels.
    enum class PictureFormat : std::uint32_t { Full = 0, Half = 1 };

    package::Strategy strategy = package::kDefaultStrategy;
    std::uint32_t width = 1280;  // pixels
    std::uint32_t height = 720;
    // No value chooses ray queries if package and device support them, else the ray tracing pipeline.
    std::optional<package::Tracer> tracer{};
    // No value chooses by the number of buckets and the device, as defaultOrdering() does.
    std::optional<package::Ordering> ordering{};
    // Makes the device check that each hit is in its bucket exactly once, and count the errors in
    // Renderer::Counters::orderErrors. This is slow.
    bool checkOrder = false;
    // Also counts rays to lights and rays of ambient occlusion. This costs time, most with ray tracing
    // pipelines; without it, pipelines have no code for it.
    bool countsLight = false;
    // Puts the rays of all effects into one list, so that their hits are ordered and shaded together. This
    // makes fewer, larger dispatches and takes more memory.
    bool batchEffects = false;
    // Lets frames add their sample to the mean of earlier ones (FrameOptions::sampleIndex). It takes two
    // images more, 32 bytes a pixel. A program whose frames are all samples of their own does without.
    bool accumulate = true;
    // With Half, the picture takes 8 bytes a pixel instead of 16: the values have 11 significant bits and are
    // at most 65504. Frames that accumulate, that march in screen space, or that have layers of 32-bit
    // vectors keep 32 bits. Renderer::outputFormat() says which one it is.
    PictureFormat picture = PictureFormat::Full;
    // Lets frames look for the ends of rays in screen space (FrameOptions::screenSteps). It takes an image
    // more of 16 bytes a pixel in packages with such effects, and keeps frames in one band.
    bool screenMarch = false;
    // Lights the frame in that many bands of rows, one after the other. Samples, rays and hits then take
    // memory for one band only. The picture is the same; each band takes passes of its own. 0 chooses the
    // number: one band on discrete GPUs, where bands cost time; elsewhere bands of at most kPixelsOfBand
    // pixels, and so many that their buffers take at most 40 bytes for each pixel of the frame, and 16 more
    // for each effect with rays beyond the first, as long as bands have 2^18 pixels and a frame's passes stay
    // few. Renderer::bands() says how many there are.
    std::uint32_t bands = 0;
    // The most bounces of a path in this renderer's frames, from 1 to the number that the package was
    // compiled for (PackageShape::maxBounces). With 1, the hits of the effects' rays send no further rays.
    std::uint32_t bounces = 1;
    // The number of threads that make pipelines, the calling one included. 0 means as many as the machine
    // runs at once.
    std::uint32_t pipelineThreads = 0;
    // Makes the pipelines with shaders of single cases while frames are already drawn. Until a pipeline is
    // made, the package's fallback shades its hits; apart from drafts, the pictures are the same. Requires a
    // package with PackageShape::fallback, which must outlive the Renderer. Error "package-fallback".
    bool backgroundPipelines = false;
    // With backgroundPipelines, lets frames begin as soon as the raster pass, a draft of first hits
    // and the last pass are made. A draft shows the base of materials under the sky and the lights, without
    // shadows, and no ray is traced. The first recording with all fixed passes starts the picture anew.
    // Renderer::PipelineProgress and Renderer::Counters say whether a frame is a draft. Without it,
    // Renderer::create() waits for the fixed passes and the fallback, and no frame is a draft.
    bool draft = true;
    // Makes the driver keep the statistics that pipelineStatistics() returns. Error "pipeline-statistics"
    // without DeviceHandles::pipelineStatistics.
    bool pipelineStatistics = false;

    friend bool operator==(const RendererOptions&, const RendererOptions&) = default;
};
inline constexpr Named<RendererOptions::PictureFormat> kPictureFormatNames[] = {
    {RendererOptions::PictureFormat::Full, "full", "32-bit floats"},
    {RendererOptions::PictureFormat::Half, "half", "16-bit floats, where a picture has one sample"},
};
constexpr std::span<const Named<RendererOptions::PictureFormat>> namesOf(
    RendererOptions::PictureFormat /*type*/) {
    return kPictureFormatNames;
}

// The most pixels of a band if RendererOptions::bands is 0. Discrete GPUs have no such limit.
inline constexpr std::uint32_t kPixelsOfBand = 1U << 19;

class Environment;

struct FrameOptions {
    // The key by which a workgroup sorts its rays before they join the list: nothing, the signs of the
    // direction, or cells of the direction's octahedral map.
    enum class Binning : std::uint32_t { None = 0, Sign = 1, Octahedral = 2 };

    CameraView camera;
    SkyView sky;
    // The environment that replaces the gradient. Packages that read one (Package::environmentMap()) require
    // it, and others refuse it. A Renderer keeps the map of its last recording alive.
    const Environment* environment = nullptr;
    float environmentRotation = 0.0F;   // about +Y, counter-clockwise as seen from above, radians
    float environmentIntensity = 1.0F;  // factor of its radiance
    // Surfaces with less roughness reflect as mirrors.
    float mirrorRoughness = 0.05F;
    // Surfaces with more roughness send no reflection ray.
    float maxReflectionRoughness = 0.3F;
    // A ray of an effect is not sent if the luminance of its sample's weight is below this. Its light is
    // lost. 0 sends every ray.
    float faintWeight = 0.0F;
    // The number of rays that a primary surface sends, in each sample, to each area light: 1 to 4096.
    std::uint32_t shadowSamples = 1;
    // Ambient occlusion: the number of rays a sample (1 to 4096), their length in metres (infinite means no
    // limit), and whether an occluder counts less the farther it is. That weight falls linearly to 0 at the
    // radius, which then has to be finite.
    std::uint32_t occlusionSamples = 4;
    float occlusionRadius = std::numeric_limits<float>::infinity();
    bool occlusionFalloff = false;
    // The largest number of surfaces that a refracted ray meets: 1 to 64.
    std::uint32_t maxInterfaces = 8;
    // The largest luminance that a ray of an effect adds in one sample. Infinity means no limit, which is
    // exact.
    float maxSampleRadiance = std::numeric_limits<float>::infinity();
    Binning binning = Binning::None;
    // The bounces of a path, up to RendererOptions::bounces. 0 means that maximum.
    std::uint32_t bounces = 0;
    // Records every bounce of a frame with more than 8. Without it a frame records those that many paths of
    // the frames before have reached, and further ones by chance, with a weight that keeps the mean. The
    // light of rare long paths then depends on those frames. Renderer::finished() says which frames the
    // device has completed.
    bool recordAllBounces = false;
    // The number of steps of the march in screen space that precedes a ray. 0 means no march. Others need
    // RendererOptions::screenMarch.
    std::uint32_t screenSteps = 0;
    // The thickness that the march assumes behind the depth of a surface, as a share of the surface's
    // distance.
    float screenThickness = 0.02F;
    // Effect bits that switch effects on. They apply to the package's effects with rays and to ambient
    // occlusion.
    std::uint32_t effects = package::kAllEffects;
    // 0 restarts the accumulation. Others need RendererOptions::accumulate.
    std::uint32_t sampleIndex = 0;
    // The number of samples of a pixel that the picture will average. Each sample stands for that share of
    // the pixel's area, so the cones by which textures are filtered are 1 / sqrt(averagedSamples) as wide. A
    // program that accumulates until something moves should give the number that it usually reaches. With 0,
    // render() and renderSamples() use their count of samples, and record() uses 1.
    std::uint32_t averagedSamples = 0;
    std::uint32_t seed = 0;
    // Seconds that materials of packs may follow, which read them as frameTime(). Floats have a step of
    // 1/1000 s after some two hours; wrap the time before that.
    float time = 0.0F;
    Timing timing = Timing::Frame;
};
inline constexpr Named<FrameOptions::Binning> kBinningNames[] = {
    {FrameOptions::Binning::None, "none", "not at all"},
    {FrameOptions::Binning::Sign, "sign", "into 8 bins"},
    {FrameOptions::Binning::Octahedral, "octahedral", "into 64 bins"},
};
constexpr std::span<const Named<FrameOptions::Binning>> namesOf(FrameOptions::Binning /*type*/) {
    return kBinningNames;
}

}  // namespace glint
