// The bytes that the passes of a frame move: their reads and writes of the frame's own images, samples and
// lists. Every other pass reads from memory the results of an earlier one, so a device with little bandwidth
// has to carry these bytes for each pixel. Vertices, textures, acceleration structures and the few bytes of
// counters and buckets are not in them, and caches and tiles on the chip may save part of them.
#pragma once

#include <glint/internal/package_format.h>
#include <glint/internal/package_modules.h>
#include <glint/layers.h>
#include <glint/renderer.h>

#include <cstdint>
#include <iterator>
#include <span>
#include <string_view>
#include <vector>

namespace glint {

// The unit for which a pass moves bytes.
enum class TrafficUnit : std::uint32_t {
    Pixel,
    Sample,          // a pixel and an effect that sends rays
    Sent,            // a sample that sends a ray, or whose light is found without the list
    Ray,             // a ray of a list
    Hit,             // a ray of a list that hits, where hits are ordered
    Miss,            // one that leaves the scene
    FurtherRay,      // a ray of a path's second bounce or a later one
    ShadowRay,       // a deferred one
    Surface,         // a pixel that sees a surface
    FirstShadowRay,  // a shadow ray of a first hit that waits in memory
    ShadowRound,     // a pixel and a round of such rays after the first
};
inline constexpr Named<TrafficUnit> kTrafficUnitNames[] = {
    {TrafficUnit::Pixel, "pixel", ""},
    {TrafficUnit::Sample, "sample", "a pixel and an effect that sends rays"},
    {TrafficUnit::Sent, "sent", "a sample that sends a ray"},
    {TrafficUnit::Ray, "ray", "a ray of a list"},
    {TrafficUnit::Hit, "hit", "a ray of a list that hits"},
    {TrafficUnit::Miss, "miss", "a ray of a list that leaves the scene"},
    {TrafficUnit::FurtherRay, "further-ray", "a ray of a path's second bounce or a later one"},
    {TrafficUnit::ShadowRay, "shadow-ray", "a deferred shadow ray"},
    {TrafficUnit::Surface, "surface", "a pixel that sees a surface"},
    {TrafficUnit::FirstShadowRay, "first-shadow-ray", "a shadow ray of a first hit that waits in memory"},
    {TrafficUnit::ShadowRound, "shadow-round", "a pixel and a round of such rays after the first"},
};
constexpr std::span<const Named<TrafficUnit>> namesOf(TrafficUnit /*type*/) {
    return kTrafficUnitNames;
}

// The properties of a frame that determine the bytes.
struct TrafficShape {
    package::Strategy strategy = package::kDefaultStrategy;
    package::HitRecordFormat hitRecord = package::HitRecordFormat::Full;
    package::SampleRecordFormat sampleRecord = package::SampleRecordFormat::Full;
    bool hitsInSamples = false;  // as Package::hitsInSamples() says
    std::uint32_t effects = 0;   // those that send rays
    std::uint32_t walks = 0;     // those of them with a pass that follows their rays first
    std::uint32_t bucketCount = 1;
    bool paths = false;  // of several bounces
    bool emissiveLights = false;
    bool skyLight = false;
    bool deferredShadows = false;
    std::uint32_t firstShadowBytes = 0;  // of a shadow ray of a first hit; 0: none waits
    bool accumulates = false;            // the frame adds its sample to a mean
    bool halfPicture = false;
    bool marchesScreen = false;
    bool binsRays = false;
    std::vector<package::LayerInfo::Entry> layers{};
    bool layerRays = false;  // they need the hits of rays
    std::uint32_t layerBounces = 0;
    bool layerWalks = false;  // they need the lights that walks find
};

// The shape of frames of a package.
TrafficShape trafficShape(const Package& package, const RendererOptions& options);

// The bytes that a pass reads and writes for one unit.
struct TrafficRow {
    std::string_view pass;  // as in docs/design.md
    TrafficUnit unit = TrafficUnit::Pixel;
    std::uint32_t read = 0;
    std::uint32_t written = 0;
};

// Pure. A pass with several units has several rows. Rows without bytes are left out.
std::vector<TrafficRow> trafficRows(const TrafficShape& shape);

// The number of each unit in a frame.
struct TrafficCounts {
    double of[std::size(kTrafficUnitNames)] = {};

    double operator[](TrafficUnit unit) const {
        return of[static_cast<std::size_t>(unit)];
    }
};
// Shadow rays of first hits are counted with RendererOptions::countsLight.
TrafficCounts trafficCounts(const Renderer::Counters& counters, const TrafficShape& shape, double pixels);

// The sum of the rows.
struct TrafficSum {
    double read = 0.0;
    double written = 0.0;
};
TrafficSum sumTraffic(std::span<const TrafficRow> rows, const TrafficCounts& counts);

}  // namespace glint
