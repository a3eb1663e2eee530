// Whole pictures of the path tracer, their errors, and how far a picture of the device is from them.
#pragma once

#include "oracle/scene/picture.h"
#include "oracle/transport/path_tracer.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace glint::oracle {

// What the samples of a pixel met, and how uneven they are.
struct PathPixel {
    double glass = 0.0;          // share of the samples whose path met clear glass
    double blended = 0.0;        // share whose path met a surface of BLEND
    double largestSample = 0.0;  // share that the brightest sample has in the pixel's light
    int material = -1;           // of the first surface of the first sample; -1: the sky
};

struct PathPicture {
    Picture picture;  // with the standard error of each pixel's mean, and the variance of one sample
    std::vector<PathPixel> notes;
};

struct PathSampling {
    std::uint32_t samples = 64;  // a pixel
    std::uint64_t seed = 0;
    std::uint32_t threads = 0;  // 0: one for each core
};

// Renders samples at random places of each pixel. The picture is the same for any number of threads.
PathPicture pathPicture(const PathTracer& tracer, const View& view, const PathSampling& sampling);

// Returns the mean of that many samples along one ray.
Estimate pathLight(const PathTracer& tracer, const Ray& ray, std::uint32_t samples, std::uint64_t seed);

// Why a pixel differs from the truth by more than kDiffers. The first cause that applies counts.
enum class PathCause : std::uint8_t {
    Noise,    // by less than four standard errors of truth and device together
    Uneven,   // one sample of the truth has a tenth of the pixel's light, so its standard error says little
    Glass,    // paths from here meet clear glass
    Blended,  // paths from here meet surfaces of BLEND
    Below,    // the truth that reflects directions below a surface once more, as the device does, is within
              // noise
    Sky,      // the pixel shows the sky
    Other,
    Count
};
std::string_view nameOf(PathCause cause);

struct PathDifferentPixel {
    std::uint32_t x = 0;
    std::uint32_t y = 0;
    double relative = 0.0;    // of the worst channel, over at least kDark
    double deviations = 0.0;  // of the worst channel, in standard errors
    Vec3 device{0.0};
    Vec3 truth{0.0};
    Vec3 reflecting{0.0};  // the truth that reflects below surfaces, if there is one
    PathCause cause = PathCause::Other;
    std::string material;
};

struct PathDifference {
    std::size_t pixels = 0;
    std::size_t notFinite = 0;  // of the device; left out of all else
    double mean = 0.0;          // of the truth
    double deviceMean = 0.0;
    double rootMeanSquare = 0.0;
    double expected = 0.0;  // root mean square of the standard errors
    double relMse = 0.0;    // mean of (device - truth)² / (truth² + 0.01)
    // Mean of (device - truth) over the mean of the truth, and its standard error from those of the pixels.
    double bias = 0.0;
    double biasError = 0.0;
    // The same against the truth that reflects below surfaces, if there is one.
    double reflectingBias = 0.0;
    std::vector<PathDifferentPixel> different;  // worst first
};

// Compares with a picture of the device that has that many samples, whose variance is taken to be that of the
// truth's samples. `reflecting` is the truth with PathSettings::reflectsBelow; it explains PathCause::Below,
// and may be null. All must have the same size.
PathDifference pathDifference(const LinearImage& device, const PathPicture& truth,
                              const PathPicture* reflecting, const gltf::Scene& scene, std::uint32_t samples);

// Returns lines of text, including the `list` worst pixels.
std::string toText(const PathDifference& difference, std::uint32_t list);
// `difference` may be null.
std::string toJson(const PathPicture& truth, const PathSampling& sampling, const PathDifference* difference,
                   std::uint32_t deviceSamples);

}  // namespace glint::oracle
