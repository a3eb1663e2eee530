#include "measure/measurer.h"

#include "base/clock.h"
#include "base/parallel.h"
#include "image/compare.h"
#include "measure/rounds.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <random>
#include <utility>

namespace glint::measure {

namespace {

bool sameBits(const LinearImage& a, const LinearImage& b) {
    return a.pixels == b.pixels;
}

// Returns the errors of all pictures, on at most `jobs` threads. The first picture is the default's. A
// picture that equals the default's gets its errors.
std::vector<image::ImageErrors> errorsOf(std::span<const LinearImage* const> images, const Truth& truth,
                                         int jobs) {
    std::vector<image::ImageErrors> errors(images.size());
    base::runParallel(images.size(), jobs, [&](std::size_t i) {
        if (i == 0 || !sameBits(*images[i], *images[0])) {
            errors[i] = image::measureErrors(*images[i], truth.image, truth.exposure);
        }
        return true;
    });
    for (std::size_t i = 1; i < images.size(); ++i) {
        if (sameBits(*images[i], *images[0])) {
            errors[i] = errors[0];
        }
    }
    return errors;
}

// Makes the mean of `count` - 1 pictures that of `count`.
void addToMean(LinearImage& mean, const LinearImage& image, std::uint32_t count) {
    if (count == 1) {
        mean = image;
        return;
    }
    const auto share = 1.0F / static_cast<float>(count);
    for (std::size_t i = 0; i < mean.pixels.size(); ++i) {
        for (std::size_t c = 0; c < mean.pixels[i].size(); ++c) {
            mean.pixels[i][c] += (image.pixels[i][c] - mean.pixels[i][c]) * share;
        }
    }
}

// Returns x / y. If both are 0, the ratio is 1, which means no change.
double ratio(double x, double y) {
    return x == y ? 1.0 : x / std::max(y, 1e-300);
}

}  // namespace

Result<Measurer> Measurer::create(const Observer& observer, BenchBed& bed, const MeasureOptions& options,
                                  const Truth& truth, BenchPoint& base) {
    Measurer measurer(observer, bed, options, truth, base);
    GLINT_TRY(auto entry, measurer.mount(base));
    measurer.baseEntry_.push_back(std::move(entry));
    return measurer;
}

Result<Measurer::Entry> Measurer::mount(BenchPoint& point) const {
    GLINT_TRY(auto mount, point.filteredFrames > 0
                              ? bed_.mountFiltered(*options_.filter, point.filteredFrames)
                              : bed_.mount(point.configuration, point.package));
    // Drivers may compile a pipeline when it first runs.
    GLINT_TRY([[maybe_unused]] const auto first, mount.exposeSamples(0, 1));
    point.footprint = mount.renderer().footprint();
    point.cases = mount.cases();
    point.tracer = std::string(package::nameOf(mount.renderer().tracer()));
    if (mount.ordersHits()) {
        point.ordering = std::string(package::nameOf(mount.renderer().ordering()));
    }
    return Entry{&point, std::move(mount), {}, {}};
}

Status Measurer::measure(std::span<BenchPoint> points) {
    // The loop runs at least once, for the default.
    for (std::size_t begin = 0; begin < std::max<std::size_t>(points.size(), 1); begin += options_.batch) {
        std::vector<Entry> entries;
        const std::size_t end = std::min(begin + options_.batch, points.size());
        for (std::size_t i = begin; i < end; ++i) {
            observer_.progress(fmt::format("compiling {} of {}: {}", i + 1, points.size(), points[i].name));
            Result<Entry> entry = mount(points[i]);
            if (entry) {
                entries.push_back(std::move(*entry));
            } else {
                observer_.report(makeWarning("bench-point", points[i].name,
                                             fmt::format("was left out: {}", entry.error().message),
                                             entry.error().hint));
            }
        }
        observer_.progress(fmt::format("measuring {} to {} of {}", begin + 1, end, points.size()));
        GLINT_TRY_DO(measureBatch(entries, ++batches_));
    }
    return okStatus();
}

Status Measurer::measureBatch(std::span<Entry> entries, std::uint64_t seed) {
    std::vector<Entry*> all{&baseEntry_.front()};
    for (Entry& entry : entries) {
        all.push_back(&entry);
    }
    constexpr std::uint64_t kOdd = 0x9E3779B97F4A7C15ULL;  // spreads small seeds over 64 bits
    std::mt19937_64 random(options_.seed + kOdd * seed);
    for (std::uint32_t round = 0; round < options_.rounds; ++round) {
        GLINT_TRY_DO(warmUp(baseEntry_.front(), kRoundWarmUp));
        for (const std::size_t i : shuffled(all.size(), random)) {
            GLINT_TRY_DO(expose(*all[i], options_.seed + round));
        }
        keep(all, round);
    }
    std::vector<const LinearImage*> means;
    means.reserve(all.size());
    for (const Entry* const entry : all) {
        means.push_back(&entry->mean);
    }
    const std::vector<image::ImageErrors> errors = errorsOf(means, truth_, bed_.base().compile.jobs);
    for (std::size_t i = baseIsKnown_ ? 1 : 0; i < all.size(); ++i) {
        all[i]->point->errorOfMean = errors[i];
    }
    baseIsKnown_ = true;
    return okStatus();
}

Status Measurer::warmUp(const Entry& entry, std::chrono::milliseconds time) const {
    const base::Clock::time_point start = base::Clock::now();
    while (!bed_.onCpu() && base::Clock::now() - start < time) {
        GLINT_TRY([[maybe_unused]] const auto image, entry.mount.exposeSamples(0, 16));
    }
    return okStatus();
}

Status Measurer::expose(Entry& entry, std::uint32_t seed) const {
    GLINT_TRY_DO(warmUp(entry, kWarmUp));
    GLINT_TRY(entry.exposure, entry.mount.expose(seed));
    return okStatus();
}

void Measurer::keep(std::span<Entry*> entries, std::uint32_t round) {
    std::vector<const LinearImage*> images;
    for (const Entry* const entry : entries) {
        images.push_back(&entry->exposure.image);
    }
    const std::vector<image::ImageErrors> errors = errorsOf(images, truth_, bed_.base().compile.jobs);
    const double baseMs = entries[0]->exposure.milliseconds;
    const double baseHitMs = entries[0]->exposure.hitMs;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        BenchPoint& point = *entries[i]->point;
        const Exposure& exposure = entries[i]->exposure;
        point.times.push_back(exposure.milliseconds);
        point.ratios.push_back(ratio(exposure.milliseconds, baseMs));
        for (const auto& [name, milliseconds] : exposure.passes) {
            point.passes[name].push_back(milliseconds);
        }
        point.hits.push_back(exposure.hits);
        point.hitMs.push_back(exposure.hitMs);
        point.hitRatios.push_back(ratio(exposure.hitMs, baseHitMs));
        if (i == 0 && baseIsKnown_) {
            continue;  // the same seeds give the same pictures
        }
        addToMean(entries[i]->mean, exposure.image, round + 1);
        point.errors.push_back(errors[i]);
        point.errorRatios.push_back(
            ratio(valueOf(options_.metric, errors[i]), valueOf(options_.metric, errors[0])));
        point.sameImage = point.sameImage && sameBits(*images[i], *images[0]);
        if (round == 0) {
            point.counters = exposure.counters;
            point.image = exposure.image;
        }
    }
}

}  // namespace glint::measure
