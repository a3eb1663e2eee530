#include "frame/frame_resources.h"
#include "interop/frame.h"
#include "renderer/pipelines.h"

#include <glint/internal/frame_traffic.h>
#include <glint/internal/package_modules.h>
#include <glint/package.h>
#include <glint/renderer.h>

#include <algorithm>
#include <bit>

namespace glint {
namespace {

using Unit = TrafficUnit;

constexpr std::uint32_t kWord = sizeof(std::uint32_t);
constexpr std::uint32_t kVector = sizeof(gpu::vec3);
constexpr std::uint32_t kPixel = sizeof(gpu::vec4);  // of an image with light, and of the light of a path
constexpr std::uint32_t kIdentity = 2 * kWord;       // of the surface that a pixel sees
constexpr std::uint32_t kStart = sizeof(gpu::SampleStart);
constexpr std::uint32_t kPath = sizeof(gpu::PathState);
constexpr std::uint32_t kRayHit = sizeof(gpu::RayHit);
constexpr std::uint32_t kBounce = sizeof(gpu::BounceLight);

bool packsSamples(const TrafficShape& shape) {
    return shape.sampleRecord == package::SampleRecordFormat::Packed;
}

// The record of a sample behind its start: direction and weight, which a packed record has in one array.
std::uint32_t aimBytes(const TrafficShape& shape) {
    return packsSamples(shape) ? sizeof(gpu::uvec2) : sizeof(gpu::SampleAim);
}

std::uint32_t weightBytes(const TrafficShape& shape) {
    return packsSamples(shape) ? 0 : sizeof(gpu::SampleWeight);
}

// A ray as listedRay() reads it: its number, the origin, the aim, and how its cone grows.
std::uint32_t rayBytes(const TrafficShape& shape) {
    return kWord + (packsSamples(shape) ? kStart : kVector + kWord) + aimBytes(shape);
}

// The data that a pass writes when it shades a hit: light, and the next ray of the path or that there is
// none.
std::uint32_t answerBytes(const TrafficShape& shape) {
    const std::uint32_t spread = packsSamples(shape) ? 0 : kWord;
    return shape.paths ? kPixel + kStart + aimBytes(shape) + spread + kPath + (shape.skyLight ? kWord : 0)
                       : kStart;
}

// The data that such a pass reads of the ray. A record that also holds the hit has the rest of the direction
// in it.
std::uint32_t arrivalBytes(const TrafficShape& shape) {
    const std::uint32_t apart = packsSamples(shape) ? aimBytes(shape) + kWord : kVector;
    const std::uint32_t direction = kWord + (shape.hitsInSamples ? aimBytes(shape) : apart);
    return direction + (shape.paths ? kVector + kWord + kPath : 0) +
           (shape.emissiveLights
                ? (shape.paths ? 0 : kVector) + static_cast<std::uint32_t>(sizeof(gpu::LobeRay))
                : 0);
}

void addSamples(const TrafficShape& shape, std::vector<TrafficRow>& rows) {
    const std::uint32_t lobe = shape.emissiveLights ? sizeof(gpu::LobeRay) : 0;
    const std::uint32_t share = shape.skyLight ? kWord : 0;
    const std::uint32_t aim = aimBytes(shape);
    const std::uint32_t weight = packsSamples(shape) ? aim : weightBytes(shape);
    // A packed sample without a ray has only the word that says so.
    const std::uint32_t always = packsSamples(shape) ? kWord : kStart;
    rows.push_back({"first hits", Unit::Sample, 0, always + lobe + (shape.marchesScreen ? weight : 0)});
    rows.push_back({"first hits", Unit::Sent, 0,
                    kStart - always + aim + weightBytes(shape) - (shape.marchesScreen ? weight : 0) + share +
                        (shape.paths ? kPath : 0)});
    if (shape.walks > 0) {
        // The counts do not split effects further, so all samples that are sent count as walked.
        rows.push_back({"effect walk", Unit::Sample, kWord, 0});
        rows.push_back({"effect walk", Unit::Sent, kIdentity + (packsSamples(shape) ? kVector : kWord),
                        kStart + aim + weightBytes(shape)});
    }
    if (shape.layerWalks) {
        rows.push_back({"effect walk", Unit::Sample, 0, kVector});
    }
    rows.push_back(
        {"first hits", Unit::Sent, 0, (shape.layerRays ? kWord : 0) + shape.layerBounces * kBounce});
    rows.push_back({"effect rays", Unit::Sample, kWord, 0});
    rows.push_back({"effect rays", Unit::Sent,
                    (shape.binsRays || shape.marchesScreen ? aim : 0) + (shape.marchesScreen ? kVector : 0),
                    0});
    rows.push_back({"effect rays", Unit::Ray, 0, kWord});
}

// The counts do not tell which surfaces are lit and send a shadow ray, so all of them count as such. Those
// that further rounds shade again are not counted.
void addFirstShadows(const TrafficShape& shape, std::uint32_t picture, std::vector<TrafficRow>& rows) {
    rows.push_back({"first hits", Unit::Surface, 0, kWord});
    rows.push_back({"first hits", Unit::FirstShadowRay, 0, shape.firstShadowBytes});
    rows.push_back({"first hits", Unit::ShadowRound, kWord + kWord, 0});
    rows.push_back({"first shadows", Unit::Pixel, kWord, 0});
    rows.push_back({"first shadows", Unit::Surface, kIdentity + picture, picture});
    rows.push_back({"first shadows", Unit::FirstShadowRay, shape.firstShadowBytes, 0});
    rows.push_back({"first shadows", Unit::ShadowRound, kWord, 0});
}

// The bytes that a pass reads and writes of its layers. Light is divided by an albedo, which is read.
TrafficRow layersOf(const TrafficShape& shape, package::LayerInfo::Pass pass, std::string_view name) {
    TrafficRow row{name, Unit::Pixel, 0, 0};
    for (const package::LayerInfo::Entry& entry : shape.layers) {
        if (package::passOf(entry) != pass) {
            continue;
        }
        const package::LayerInfo& info = *package::findLayer(entry.layer);
        const std::uint32_t bytes = package::infoOf(info.format).bytes;
        row.written += bytes;
        row.read += shape.accumulates && info.continues ? bytes : 0;
        row.read +=
            info.name.ends_with("demodulated") ? package::infoOf(package::LayerInfo::Format::Half4).bytes : 0;
    }
    return row;
}

void addShading(const TrafficShape& shape, std::vector<TrafficRow>& rows) {
    const std::uint32_t hit = shape.hitsInSamples ? kStart
                              : shape.hitRecord == package::HitRecordFormat::Packed
                                  ? sizeof(gpu::PackedHitRecord)
                                  : sizeof(gpu::HitRecord);
    const std::uint32_t key = keyBytesOf(shape.bucketCount);
    const std::uint32_t answer = answerBytes(shape);
    const package::StrategyInfo& strategy = package::infoOf(shape.strategy);
    if (strategy.ordersHits) {
        rows.push_back({"trace", Unit::Ray, rayBytes(shape) + (shape.paths ? kWord : 0), hit + key});
        rows.push_back({"count", Unit::Ray, key, 0});
        rows.push_back({"copy", Unit::Ray, key, kWord});
    }
    const std::uint32_t direction = packsSamples(shape) ? aimBytes(shape) + kWord : kVector;
    // A miss reads of its record only that it is a miss.
    const TrafficRow miss{"", Unit::Miss,
                          (shape.skyLight ? 4 : 3) * kWord + direction + (shape.paths ? kVector : 0),
                          shape.paths ? kPixel + kWord : kStart};
    const TrafficRow shaded{"", Unit::Hit, kWord + hit + arrivalBytes(shape), answer};
    const TrafficRow traced{
        "", Unit::Ray, rayBytes(shape) + (shape.paths ? kPath : 0) + (shape.emissiveLights ? kIdentity : 0),
        answer};
    // The pass that finds hits stores the data that layers need of them. Each bounce adds its light.
    const std::uint32_t bounce = shape.layerBounces > 0 ? kBounce : 0;
    rows.push_back({strategy.ordersHits ? std::string_view("trace") : strategy.modules.front().pass,
                    Unit::Ray, (shape.layerRays ? kWord : 0) + bounce,
                    (shape.layerRays ? kRayHit : 0) + bounce});
    const bool missesApart = std::ranges::any_of(strategy.modules, [](const package::StrategyModule& module) {
        return module.over == package::Over::Misses;
    });
    const auto add = [&](std::string_view pass, TrafficRow row) {
        row.pass = pass;
        rows.push_back(row);
    };
    for (const package::StrategyModule& module : strategy.modules) {
        switch (module.over) {
            case package::Over::Nothing:
                break;
            case package::Over::Rays:
                add(module.pass, traced);
                break;
            case package::Over::OrderedHits:
                if (!missesApart) {
                    add(module.pass, miss);
                }
                add(module.pass, shaded);
                break;
            case package::Over::Misses:
                add(module.pass, miss);
                break;
            case package::Over::Buckets:
                add(module.pass, shaded);
                break;
        }
    }
}

}  // namespace

TrafficShape trafficShape(const Package& package, const RendererOptions& options) {
    const package::EffectSet& effects = package.shape().effects;
    TrafficShape shape;
    shape.strategy = options.strategy;
    shape.hitRecord = package.hitRecord();
    shape.sampleRecord = package.sampleRecord();
    shape.hitsInSamples = package.hitsInSamples();
    shape.effects = package::effectSlots(effects);
    shape.walks = static_cast<std::uint32_t>(std::popcount(effects.walks));
    shape.bucketCount = package.bucketCount();
    shape.paths = package::hasPaths(package.shape());
    shape.emissiveLights = package.emission() != nullptr;
    shape.skyLight = package.skyLight();
    shape.deferredShadows =
        effects.lights != 0 && package.shape().shadows == package::ShadowPlacement::Deferred;
    shape.firstShadowBytes = firstShadowBytes(package);
    shape.accumulates = options.accumulate;
    shape.halfPicture = hasHalfPicture(package, options);
    shape.marchesScreen = options.screenMarch && effects.screenStarts != 0;
    for (const package::PackageLayer& layer : package.layers()) {
        shape.layers.push_back({layer.info->number, layer.effect, layer.bounce});
    }
    shape.layerRays = (package::demandsOf(package.layers()) & package::LayerInfo::kRays) != 0;
    shape.layerBounces = package::layerBounces(package.layers());
    shape.layerWalks = package.sizedLights() && package::showWalkedLight(package.layers(), effects.walks);
    return shape;
}

std::vector<TrafficRow> trafficRows(const TrafficShape& shape) {
    std::vector<TrafficRow> rows;
    rows.push_back({"gbuffer", Unit::Pixel, 0, kIdentity + kWord});  // and the depth
    const std::uint32_t picture = shape.halfPicture ? kPixel / 2 : kPixel;
    const std::uint32_t key = keyBytesOf(shape.bucketCount);
    rows.push_back({"first count", Unit::Pixel, kWord, key});
    rows.push_back({"first copy", Unit::Pixel, key, kWord});
    rows.push_back(
        {"first hits", Unit::Pixel, kWord + kIdentity, picture + (shape.marchesScreen ? kPixel : 0)});
    rows.push_back(layersOf(shape, package::LayerInfo::Pass::FirstHits, "first hits"));
    if (shape.firstShadowBytes > 0) {
        addFirstShadows(shape, picture, rows);
    }
    if (shape.effects > 0) {
        addSamples(shape, rows);
        addShading(shape, rows);
        if (shape.deferredShadows) {
            rows.push_back({"shadow", Unit::ShadowRay, sizeof(gpu::ShadowRecord) + kPixel,
                            sizeof(gpu::ShadowRecord) + kPixel});
        }
        if (shape.paths) {
            rows.push_back({"path rays", Unit::Ray, kWord + kWord, 0});
            rows.push_back({"path rays", Unit::FurtherRay, 0, kWord});
        }
        rows.push_back({"compose", Unit::Sample, shape.paths ? kWord : kStart, 0});
        const std::uint32_t weight = packsSamples(shape) ? aimBytes(shape) : kVector;
        rows.push_back({"compose", Unit::Sent, weight + (shape.paths ? kPixel : 0), 0});
        rows.push_back(layersOf(shape, package::LayerInfo::Pass::Compose, "compose"));
        rows.push_back(
            {"compose", Unit::Sent, (shape.layerRays ? kRayHit : 0) + shape.layerBounces * kBounce, 0});
        rows.push_back({"compose", Unit::Sample, shape.layerWalks ? kVector : 0, 0});
    }
    const std::uint32_t mean = shape.accumulates ? 2 * kPixel : 0;
    rows.push_back({"compose", Unit::Pixel, picture + mean, shape.accumulates ? mean : picture});
    std::erase_if(rows, [](const TrafficRow& row) { return row.read + row.written == 0; });
    return rows;
}

TrafficCounts trafficCounts(const Renderer::Counters& counters, const TrafficShape& shape, double pixels) {
    TrafficCounts counts;
    const auto at = [&](Unit unit) -> double& { return counts.of[static_cast<std::size_t>(unit)]; };
    at(Unit::Pixel) = pixels;
    at(Unit::Sample) = pixels * shape.effects;
    for (const Renderer::EffectCounters& effect : counters.effects) {
        at(Unit::FirstShadowRay) += effect.waited;
        if (effect.kind == package::EffectInfo::Kind::Rays) {
            at(Unit::Sent) += static_cast<double>(effect.rays) + effect.screenHits;
        }
    }
    at(Unit::Ray) = counters.rays;
    at(Unit::ShadowRay) = counters.shadowRays;
    if (!counters.pixelCounts.empty()) {
        at(Unit::Surface) = pixels - counters.pixelCounts.front();
    }
    at(Unit::ShadowRound) = pixels * (std::max(counters.shadowRounds, 1U) - 1U);
    for (std::size_t i = 1; i < counters.raysOfBounces.size(); ++i) {
        at(Unit::FurtherRay) += counters.raysOfBounces[i];
    }
    if (!counters.bucketCounts.empty()) {
        at(Unit::Miss) = counters.bucketCounts.front();
        at(Unit::Hit) = at(Unit::Ray) - at(Unit::Miss);
    }
    return counts;
}

TrafficSum sumTraffic(std::span<const TrafficRow> rows, const TrafficCounts& counts) {
    TrafficSum sum;
    for (const TrafficRow& row : rows) {
        sum.read += row.read * counts[row.unit];
        sum.written += row.written * counts[row.unit];
    }
    return sum;
}

}  // namespace glint
