#include "measure/reference.h"

#include "base/clock.h"
#include "base/files.h"
#include "cache/action.h"
#include "cache/store.h"
#include "image/tone.h"
#include "settings/descriptor.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

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
        .add(std::string_view(bed.cameraName()))
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

}  // namespace glint::measure
