#include "base/clock.h"
#include "base/files.h"
#include "base/lists.h"
#include "base/parallel.h"
#include "cache/action.h"
#include "cache/store.h"
#include "gltf/codecs/codecs.h"
#include "image/compare.h"
#include "image/tone.h"
#include "measure/calibration_measure.h"
#include "settings/descriptor.h"

#include <glint/measure/bench.h>
#include <glint/measure/sweep.h>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <optional>
#include <random>
#include <span>
#include <utility>

namespace glint::measure {

namespace {

// --- The reference ---

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
void judge(const image::MeanImage& sum, std::span<const std::uint8_t> surfaces, Reference& reference) {
    reference.image = sum.mean();
    reference.samples = sum.blocks() * kBlock;
    reference.exposure = image::automaticExposure(reference.image, surfaces);
    reference.noise = image::noiseOf(reference.image, sum.standardError(), reference.exposure);
    reference.relativeError = std::sqrt(reference.noise.trimmed);
    reference.reached = reference.relativeError <= reference.target;
}

// Renders blocks of samples with independent random numbers; their spread gives the uncertainty of their
// mean. If `store` has the samples of an earlier run of the same program with the same scene, view and
// device, it continues from them. With a null `store` nothing is kept.
Result<Reference> makeReference(const Observer& observer, BenchBed& bed, const compiler::BenchFacts& facts,
                                const BenchSettings& settings, compiler::CacheStore* store) {
    const base::Clock::time_point start = base::Clock::now();
    Reference reference;
    reference.isFull = facts.fullTransport;
    reference.target = settings.referenceError;
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
            judge(sum, surfaces, reference);
            observer.progress(fmt::format("reference: {} samples, within {:.2g} % (target {:.2g} %)",
                                          reference.samples, 100.0 * reference.relativeError,
                                          100.0 * reference.target));
            if (reference.reached || reference.samples >= settings.referenceSamples) {
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

// --- The measurements of points, in rounds ---

bool sameBits(const LinearImage& a, const LinearImage& b) {
    return a.pixels == b.pixels;
}

// Returns the errors of all pictures, on at most `jobs` threads. The first picture is the default's. A
// picture that equals the default's gets its errors.
std::vector<image::ImageErrors> errorsOf(std::span<const LinearImage* const> images, const Reference& truth,
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

// Measures in batches, each of which has the default in every round. Ratios are relative to the default in
// the same round, so a machine that slows down or a clock that drifts does not distort them. Before its
// rounds a configuration renders once, so that its pipelines are ready. On a GPU it also renders for a few
// milliseconds before each picture, so that clocks are up.
class Measurer {
public:
    // `base` is the default. Every batch adds times to it, and the first batch adds its errors. `filter` is
    // for points with filteredFrames. Of `report` the reference counts, and the members that the caller of
    // runBench() has set. All arguments must outlive the result. Has the errors of BenchBed::mount().
    static Result<Measurer> create(const Observer& observer, BenchBed& bed, const FilterMaker* filter,
                                   const BenchReport& report, BenchPoint& base) {
        Measurer measurer(observer, bed, filter, report);
        GLINT_TRY(auto entry, measurer.mount(base));
        measurer.baseEntry_.push_back(std::move(entry));
        return measurer;
    }

    // Fills in the measurements of `points`. A point that can't be mounted is reported as the warning
    // "bench-point" and has no measurements.
    Status measure(std::span<BenchPoint> points) {
        // The loop runs at least once, for the default.
        for (std::size_t begin = 0; begin < std::max<std::size_t>(points.size(), 1); begin += report_.batch) {
            std::vector<Entry> entries;
            const std::size_t end = std::min(begin + report_.batch, points.size());
            for (std::size_t i = begin; i < end; ++i) {
                observer_.progress(
                    fmt::format("compiling {} of {}: {}", i + 1, points.size(), points[i].name));
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

private:
    // A configuration on the device, and its picture of the current round.
    struct Entry {
        BenchPoint* point = nullptr;
        Mount mount;
        Exposure exposure;
        LinearImage mean;  // of its pictures so far
    };

    Measurer(const Observer& observer, BenchBed& bed, const FilterMaker* filter, const BenchReport& report)
        : observer_(observer), bed_(bed), filter_(filter), report_(report) {}

    Result<Entry> mount(BenchPoint& point) const {
        GLINT_TRY(auto mount, point.filteredFrames > 0 ? bed_.mountFiltered(*filter_, point.filteredFrames)
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

    Status measureBatch(std::span<Entry> entries, std::uint64_t seed) {
        std::vector<Entry*> all{&baseEntry_.front()};
        for (Entry& entry : entries) {
            all.push_back(&entry);
        }
        constexpr std::uint64_t kOdd = 0x9E3779B97F4A7C15ULL;  // spreads small seeds over 64 bits
        std::mt19937_64 random(report_.seed + kOdd * seed);
        for (std::uint32_t round = 0; round < report_.rounds; ++round) {
            GLINT_TRY_DO(warmUp(baseEntry_.front(), kRoundWarmUp));
            for (const std::size_t i : shuffled(all.size(), random)) {
                GLINT_TRY_DO(expose(*all[i], report_.seed + round));
            }
            keep(all, round);
        }
        const auto means =
            base::mapped<const LinearImage*>(all, [](const Entry* entry) { return &entry->mean; });
        const std::vector<image::ImageErrors> errors =
            errorsOf(means, report_.reference, bed_.base().compile.jobs);
        for (std::size_t i = baseIsKnown_ ? 1 : 0; i < all.size(); ++i) {
            all[i]->point->errorOfMean = errors[i];
        }
        baseIsKnown_ = true;
        return okStatus();
    }

    Status warmUp(const Entry& entry, std::chrono::milliseconds time) const {
        const base::Clock::time_point start = base::Clock::now();
        while (!bed_.facts().onCpu && base::Clock::now() - start < time) {
            GLINT_TRY([[maybe_unused]] const auto image, entry.mount.exposeSamples(0, 16));
        }
        return okStatus();
    }

    Status expose(Entry& entry, std::uint32_t seed) const {
        GLINT_TRY_DO(warmUp(entry, kWarmUp));
        GLINT_TRY(entry.exposure, entry.mount.expose(seed));
        return okStatus();
    }

    void keep(std::span<Entry*> entries, std::uint32_t round) {
        const auto images = base::mapped<const LinearImage*>(
            entries, [](const Entry* entry) { return &entry->exposure.image; });
        const std::vector<image::ImageErrors> errors =
            errorsOf(images, report_.reference, bed_.base().compile.jobs);
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
                ratio(valueOf(report_.metric, errors[i]), valueOf(report_.metric, errors[0])));
            point.sameImage = point.sameImage && sameBits(*images[i], *images[0]);
            if (round == 0) {
                point.counters = exposure.counters;
                point.image = exposure.image;
            }
        }
    }

    const Observer& observer_;
    BenchBed& bed_;
    const FilterMaker* filter_;
    const BenchReport& report_;
    std::vector<Entry> baseEntry_;  // the one of the default
    bool baseIsKnown_ = false;      // its errors
    std::uint64_t batches_ = 0;
};

// --- The bench ---

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr Interval kNoOffer{kNever, kNever, kNever, kNever, kNever};

BenchPoint makePoint(PointKind kind, compiler::Configuration configuration) {
    BenchPoint point;
    point.kind = kind;
    point.name = nameOf(configuration);
    point.configuration = std::move(configuration);
    return point;
}

// Does all the work between reading the scene and writing the files.
class Bench {
public:
    Bench(const Observer& observer, const BenchSettings& settings, BenchBed& bed, compiler::CacheStore* store,
          BenchReport& report)
        : observer_(observer), settings_(settings), bed_(bed), store_(store), report_(report) {}

    Status run() {
        GLINT_TRY_DO(makeTruth());
        base_ = makePoint(PointKind::Default, {});
        observer_.progress("compiling the default");
        GLINT_TRY(auto measurer, Measurer::create(observer_, bed_, settings_.filter, report_, base_));
        std::vector<BenchPoint> points;
        for (const Candidate& candidate : settings_.candidates) {
            BenchPoint point = makePoint(PointKind::Package, {});
            point.name = candidate.name;
            point.package = candidate.folder;
            points.push_back(std::move(point));
        }
        add(points, PointKind::Single, singles(report_.settings, report_.base));
        if (settings_.filter != nullptr) {
            addFiltered(points);
        }
        if (settings_.depth != "singles") {
            add(points, PointKind::Pair, pairs(report_.settings, report_.base, settings_.quick));
        }
        // Measures all exact values together, beside each one alone.
        if (compiler::Configuration exact = exactTogether(report_.settings, report_.base); exact.size() > 1) {
            add(points, PointKind::Exact, {std::move(exact)});
        }
        Status measured = measure(measurer, std::move(points));
        for (std::size_t i = 0; measured && i < searches(); ++i) {
            std::vector<BenchPoint> found;
            const std::size_t count = settings_.quick ? kQuickProposals : kProposals;
            add(found, PointKind::Search, proposals(report_.settings, report_.base, rated(), count));
            if (found.empty()) {
                break;
            }
            measured = measure(measurer, std::move(found));
        }
        if (!measured) {
            return measured;
        }
        finish();
        return okStatus();
    }

private:
    static constexpr std::uint32_t kFilteredFrames = 16;
    static constexpr std::size_t kProposals = 12;
    static constexpr std::size_t kQuickProposals = 4;

    std::size_t searches() const {
        constexpr std::size_t kSearches = 3;
        return settings_.depth != "search" ? 0 : settings_.quick ? 1 : kSearches;
    }

    // Makes the reference, learns about the scene's light from it, and then decides which settings there are.
    Status makeTruth() {
        compiler::BenchFacts facts = factsOf(bed_.build());
        const std::uint32_t tracers = bed_.context().handles().tracers;
        facts.rayPipeline = (tracers & package::kTracerRayPipeline) != 0;
        facts.positionFetch = bed_.facts().positionFetch;
        facts.float16 = bed_.facts().float16;
        facts.packsTextures = gltf::hasBasisu() && bed_.context().texelFormats().has(TexelFormat::Bc7, true);
        facts.fullTransport = settings_.reference == "full";
        GLINT_TRY(report_.reference, makeReference(observer_, bed_, facts, settings_, store_));
        if (!report_.reference.reached) {
            observer_.report(makeWarning(
                "bench-reference", report_.scene.file,
                fmt::format("the reference is within {:.2g} % after {} samples, not {:.2g} %",
                            100.0 * report_.reference.relativeError, report_.reference.samples,
                            100.0 * report_.reference.target),
                "give more --reference-spp, or ask for less with --reference-error: smaller errors can't "
                "be told apart"));
        }
        facts.white = std::exp2(-report_.reference.exposure);
        report_.settings = settingsFor(facts, report_.base, settings_.quick);
        if (!settings_.only.empty()) {
            std::erase_if(report_.settings, [this](const Setting& setting) {
                return std::ranges::find(settings_.only, setting.name) == settings_.only.end();
            });
        }
        return okStatus();
    }

    static void add(std::vector<BenchPoint>& points, PointKind kind,
                    std::vector<compiler::Configuration> configurations) {
        for (compiler::Configuration& configuration : configurations) {
            points.push_back(makePoint(kind, std::move(configuration)));
        }
    }

    // The filter's pictures, and one of many samples for comparison.
    void addFiltered(std::vector<BenchPoint>& points) const {
        for (const std::uint32_t frames : {1U, kFilteredFrames}) {
            BenchPoint point = makePoint(PointKind::Filtered, {});
            point.name = frames == 1 ? std::string("denoised") : fmt::format("denoised, frame {}", frames);
            point.filteredFrames = frames;
            points.push_back(std::move(point));
        }
        const compiler::Configuration many = simplified({{"spp", "64"}}, report_.base);
        if (!many.empty() && std::ranges::find(points, many, &BenchPoint::configuration) == points.end()) {
            add(points, PointKind::Single, {many});
        }
    }

    Status measure(Measurer& measurer, std::vector<BenchPoint> points) {
        GLINT_TRY_DO(measurer.measure(points));
        for (BenchPoint& point : points) {
            if (!point.times.empty()) {
                report_.points.push_back(std::move(point));
            }
        }
        return checkValidation(observer_, bed_.context());
    }

    // Rates the points that the tool makes itself; errors are of a kind that adds up.
    std::vector<Rated> rated() const {
        std::vector<Rated> all;
        const auto add = [&](const BenchPoint& point) {
            if (isOfSettings(point.kind)) {
                const double error = errorOf(point, report_.metric).median;
                all.push_back({point.configuration, timeRatio(point).median, additive(report_.metric, error),
                               isTimeTie(point), isErrorTie(point)});
            }
        };
        add(base_);
        std::ranges::for_each(report_.points, add);
        return all;
    }

    void finish() {
        report_.points.insert(report_.points.begin(), std::move(base_));
        std::vector<Rated> points;
        for (const BenchPoint& point : report_.points) {
            points.push_back({point.configuration, timeRatio(point).median,
                              errorOf(point, report_.metric).median, isTimeTie(point), isErrorTie(point)});
        }
        report_.front = paretoFront(withTiesSettled(points));
        report_.errorParts = partsOfError(report_.points, report_.settings, report_.metric);
        report_.strategies = compareStrategies(report_.points, report_.base.find("strategy")->second);
        if (settings_.budgetMs > 0.0 || settings_.maxError > 0.0) {
            report_.advice = advise();
        }
    }

    BenchAdvice advise() const {
        BenchAdvice advice;
        Demand demand;
        if (settings_.budgetMs > 0.0) {
            advice.budgetMs = demand.time = settings_.budgetMs;
        }
        if (settings_.maxError > 0.0) {
            advice.maxError = demand.error = settings_.maxError;
        }
        std::vector<Offer> offers;
        std::size_t fastest = 0;
        std::size_t best = 0;
        for (std::size_t i = 0; i < report_.points.size(); ++i) {
            const BenchPoint& point = report_.points[i];
            offers.push_back({timeOf(report_, i), errorOf(point, report_.metric)});
            if (point.kind == PointKind::Filtered) {
                offers.back().error = kNoOffer;  // settings alone don't make its picture
                offers.back().time = kNoOffer;
            }
            fastest = offers[i].time.median < offers[fastest].time.median ? i : fastest;
            best = offers[i].error.median < offers[best].error.median ? i : best;
        }
        advice.point = measure::advise(offers, demand);
        advice.file = (std::filesystem::path(settings_.output) / kSettingsFile).string();
        const auto describe = [&](std::size_t i) {
            return fmt::format("{}: {:.3g} ms ({:.3g} to {:.3g}), {} {:.3g} ({:.3g} to {:.3g})",
                               report_.points[i].name, offers[i].time.median, offers[i].time.low,
                               offers[i].time.high, nameOf(report_.metric), offers[i].error.median,
                               offers[i].error.low, offers[i].error.high);
        };
        if (advice.point) {
            advice.why = fmt::format(
                "{}. Of {} measured configurations it has the {} of those whose intervals are within what is "
                "asked for; ties go to the {} one.",
                describe(*advice.point), report_.points.size(),
                advice.budgetMs ? "least error" : "least time", advice.budgetMs ? "faster" : "more exact");
        } else {
            advice.why = fmt::format(
                "no measured configuration is surely within what is asked for; the "
                "fastest is {}; the most exact is {}",
                describe(fastest), describe(best));
        }
        return advice;
    }

    const Observer& observer_;
    const BenchSettings& settings_;
    BenchBed& bed_;
    compiler::CacheStore* store_;
    BenchReport& report_;
    BenchPoint base_;  // joins the report's points at the end
};

void describeScene(BenchBed& bed, BenchReport& report) {
    const compiler::Settings& render = bed.base();
    BenchScene& scene = report.scene;
    scene.triangles = bed.facts().triangles;
    scene.instances = bed.facts().instances;
    scene.materials = bed.scene().materials.size();
    scene.lights = bed.facts().lights;
    scene.inFile = gltf::sceneInFile(bed.scene());
    scene.camera = bed.facts().cameraName;
    scene.environment = render.environment;
    scene.width = render.renderer.width;
    scene.height = render.renderer.height;
    report.machine = machineOf(bed.context());
}

}  // namespace

Status runBench(const Observer& observer, const BenchSettings& settings, BenchBed& bed,
                compiler::CacheStore* store, BenchReport& report) {
    describeScene(bed, report);
    report.base = configurationOf(bed.base());
    return Bench(observer, settings, bed, store, report).run();
}

}  // namespace glint::measure
