#include "measure/measurer.h"

#include "base/clock.h"
#include "base/files.h"
#include "base/lists.h"
#include "base/parallel.h"
#include "cache/action.h"
#include "cache/store.h"
#include "image/compare.h"
#include "image/tone.h"
#include "settings/descriptor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>

namespace glint::measure {

namespace {

constexpr std::string_view kKind = "reference";
// The samples of a block: enough for their sequence to cover a pixel, and few enough to have many blocks.
constexpr std::uint32_t kBlock = 32;
constexpr std::uint32_t kFewestBlocks = 4;
// The seeds of blocks are far from those of rounds.
constexpr std::uint32_t kFirstSeed = 0x51EED000U;

// Returns everything that the picture depends on.
Result<std::string> keyOf(BenchBed& bed, const compiler::Configuration& configuration) {
    const compiler::Settings& base = bed.base();
    compiler::Packer packer;
    packer.add(compiler::programIdentity()).add(std::uint64_t{kBlock});
    for (const gltf::SourceFile& file : bed.scene().files) {
        packer.add(file.bytes).add(file.hash);
    }
    const compiler::Settings settings = withSettings(base, configuration);
    for (const compiler::Descriptor& row : compiler::settingsTable()) {
        if (row.bench.use != compiler::BenchUse::None) {
            packer.add(row.name).add(std::string_view(row.values.text(settings)));
        }
    }
    packer.add(static_cast<std::uint64_t>(bed.scene().sceneInFile))
        .add(std::string_view(bed.scene().variant))
        .add(std::string_view(bed.facts().cameraName))
        .add(std::string_view(bed.context().deviceName()))
        .add(std::string_view(bed.context().driverName()));
    if (!base.environment.empty()) {
        GLINT_TRY(const auto digest, base::digestFile(base.environment));
        packer.add(digest.bytes).add(digest.hash);
    }
    return packer.take();
}

std::string pack(const LinearImage& image) {
    std::string bytes(image.pixels.size() * sizeof(image.pixels[0]), '\0');
    std::memcpy(bytes.data(), image.pixels.data(), bytes.size());
    return bytes;
}

std::optional<LinearImage> unpack(std::optional<std::string_view> bytes, std::uint32_t width,
                                  std::uint32_t height) {
    LinearImage image{width, height, {}};
    image.pixels.resize(std::size_t{width} * height);
    if (!bytes || bytes->size() != image.pixels.size() * sizeof(image.pixels[0])) {
        return std::nullopt;
    }
    std::memcpy(image.pixels.data(), bytes->data(), bytes->size());
    return image;
}

// The cached part of a reference.
struct Kept {
    image::MeanImage mean;
    std::vector<std::uint8_t> surfaces;
};

std::optional<Kept> findKept(compiler::CacheStore* store, const std::string& key, std::uint32_t width,
                             std::uint32_t height) {
    const std::optional<std::string> bytes = store == nullptr ? std::nullopt : store->find(kKind, key);
    if (!bytes) {
        return std::nullopt;
    }
    compiler::Unpacker unpacker(*bytes);
    const std::optional<std::uint64_t> blocks = unpacker.number();
    const std::optional<LinearImage> mean = unpack(unpacker.text(), width, height);
    const std::optional<LinearImage> error = unpack(unpacker.text(), width, height);
    const std::optional<std::string_view> surfaces = unpacker.text();
    if (!blocks || !mean || !error || !surfaces || surfaces->size() != mean->pixels.size() ||
        !unpacker.atEnd() || *blocks < 2 || *blocks > 0xFFFFFFU) {
        return std::nullopt;
    }
    return Kept{image::MeanImage::restore(*mean, *error, static_cast<std::uint32_t>(*blocks)),
                {surfaces->begin(), surfaces->end()}};
}

// Fills in the picture and its uncertainty.
void judge(const image::MeanImage& sum, std::span<const std::uint8_t> surfaces,
           const ReferenceOptions& options, Reference& reference) {
    reference.image = sum.mean();
    reference.samples = sum.blocks() * kBlock;
    reference.exposure = image::automaticExposure(reference.image, surfaces);
    reference.noise = image::noiseOf(reference.image, sum.standardError(), reference.exposure);
    reference.relativeError = std::sqrt(reference.noise.trimmed);
    reference.target = options.target;
    reference.reached = reference.relativeError <= options.target;
}

}  // namespace

Result<Reference> makeReference(const Observer& observer, BenchBed& bed, const compiler::BenchFacts& facts,
                                const ReferenceOptions& options, compiler::CacheStore* store) {
    const base::Clock::time_point start = base::Clock::now();
    Reference reference;
    reference.isFull = facts.fullTransport;
    reference.configuration = simplified(exactValues(facts), configurationOf(bed.base()));
    const std::uint32_t width = bed.base().renderer.width;
    const std::uint32_t height = bed.base().renderer.height;
    GLINT_TRY(const auto key, keyOf(bed, reference.configuration));
    std::optional<Kept> kept = findKept(store, key, width, height);
    reference.cached = kept.has_value();
    image::MeanImage sum = kept ? std::move(kept->mean) : image::MeanImage(width, height);
    std::vector<std::uint8_t> surfaces = kept ? std::move(kept->surfaces) : std::vector<std::uint8_t>();
    const std::uint32_t before = sum.blocks();
    std::optional<Mount> mount;
    while (true) {
        if (sum.blocks() > 0 && sum.blocks() % kFewestBlocks == 0) {
            judge(sum, surfaces, options, reference);
            observer.progress(fmt::format("reference: {} samples, within {:.2g} % (target {:.2g} %)",
                                          reference.samples, 100.0 * reference.relativeError,
                                          100.0 * options.target));
            if (reference.reached || reference.samples >= options.maxSamples) {
                break;
            }
        }
        if (!mount) {
            observer.progress("compiling the reference");
            GLINT_TRY(mount, bed.mount(reference.configuration));
        }
        GLINT_TRY(const auto block, mount->exposeSamples(kFirstSeed + sum.blocks(), kBlock));
        sum.add(block);
        if (surfaces.empty()) {
            GLINT_TRY(surfaces, mount->surfaces());
        }
    }
    if (store != nullptr && sum.blocks() > before) {
        compiler::Packer packer;
        packer.add(std::uint64_t{sum.blocks()})
            .add(std::string_view(pack(sum.mean())))
            .add(std::string_view(pack(sum.standardError())))
            .add(std::string_view(std::string(surfaces.begin(), surfaces.end())));
        store->put(kKind, key, packer.take());
    }
    reference.seconds = std::chrono::duration<double>(base::Clock::now() - start).count();
    return reference;
}

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
    Measurer measurer(observer, bed, options, truth);
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
    const auto means = base::mapped<const LinearImage*>(all, [](const Entry* entry) { return &entry->mean; });
    const std::vector<image::ImageErrors> errors = errorsOf(means, truth_, bed_.base().compile.jobs);
    for (std::size_t i = baseIsKnown_ ? 1 : 0; i < all.size(); ++i) {
        all[i]->point->errorOfMean = errors[i];
    }
    baseIsKnown_ = true;
    return okStatus();
}

Status Measurer::warmUp(const Entry& entry, std::chrono::milliseconds time) const {
    const base::Clock::time_point start = base::Clock::now();
    while (!bed_.facts().onCpu && base::Clock::now() - start < time) {
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
    const auto images =
        base::mapped<const LinearImage*>(entries, [](const Entry* entry) { return &entry->exposure.image; });
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
