#include "synthetic/coherence.h"

#include "synthetic/cases_scene.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

namespace glint::synthetic {

namespace {

constexpr std::uint32_t kBlockWidth = 8;
constexpr std::uint32_t kBlockHeight = 4;
constexpr std::uint32_t kMaxBlocks = 4096;

// Returns a number in [0, 1) with the 53 bits of a double.
double unit(std::mt19937_64& random) {
    return static_cast<double>(random() >> 11) * 0x1p-53;
}

double pairs(double count) {
    return count * (count - 1.0) / 2.0;
}

// Finds the cases that the rays of a picture hit.
class Rays {
public:
    Rays(const CasesOptions& options, std::uint32_t width, std::uint32_t height)
        : mirror_(options.coherence == Coherence::Coherent),
          ceiling_(makeCeiling(options)),
          floor_(viewExtent(kCameraHeight, static_cast<double>(width) / height)),
          width_(width),
          height_(height) {}

    // Returns -1 if the ray hits no tile.
    int caseOf(std::uint32_t x, std::uint32_t y) {
        const double fromX = floor_.x * (2.0 * (x + 0.5) / width_ - 1.0);
        const double fromZ = floor_.z * (2.0 * (y + 0.5) / height_ - 1.0);
        if (mirror_) {
            // The reflected ray continues with the same slope.
            const double growth = 1.0 + kCeilingHeight / kCameraHeight;
            return ceiling_.caseAt(growth * fromX, growth * fromZ);
        }
        // The direction is cosine-weighted: a point of the unit disk is lifted onto the hemisphere (Malley).
        const double squared = unit(random_);
        const double angle = 2.0 * std::numbers::pi * unit(random_);
        const double reach = kCeilingHeight * std::sqrt(squared / std::max(1.0 - squared, 1e-12));
        return ceiling_.caseAt(fromX + reach * std::cos(angle), fromZ + reach * std::sin(angle));
    }

private:
    bool mirror_;
    Ceiling ceiling_;
    Extent floor_;
    std::uint32_t width_;
    std::uint32_t height_;
    std::mt19937_64 random_{1};
};

}  // namespace

double coherentShareOf(const CasesOptions& options, std::uint32_t width, std::uint32_t height) {
    const std::uint32_t columns = std::max(1U, width / kBlockWidth);
    const std::uint32_t rows = std::max(1U, height / kBlockHeight);
    const std::uint64_t blocks = std::uint64_t{columns} * rows;
    const std::uint64_t looked = std::min<std::uint64_t>(blocks, kMaxBlocks);
    Rays rays(options, width, height);
    std::vector<double> all(static_cast<std::size_t>(options.cases), 0.0);
    double alike = 0.0;
    double compared = 0.0;
    for (std::uint64_t i = 0; i < looked; ++i) {
        const std::uint64_t block = i * blocks / looked;
        const auto left = static_cast<std::uint32_t>(block % columns) * kBlockWidth;
        const auto top = static_cast<std::uint32_t>(block / columns) * kBlockHeight;
        std::vector<double> counts(all.size(), 0.0);
        double hits = 0.0;
        for (std::uint32_t y = top; y < std::min(top + kBlockHeight, height); ++y) {
            for (std::uint32_t x = left; x < std::min(left + kBlockWidth, width); ++x) {
                const int hit = rays.caseOf(x, y);
                if (hit >= 0) {
                    counts[static_cast<std::size_t>(hit)] += 1.0;
                    hits += 1.0;
                }
            }
        }
        for (std::size_t c = 0; c < counts.size(); ++c) {
            alike += pairs(counts[c]);
            all[c] += counts[c];
        }
        compared += pairs(hits);
    }
    double sum = 0.0;
    double squares = 0.0;
    for (const double count : all) {
        sum += count;
        squares += count * count;
    }
    const double random = sum > 0.0 ? squares / (sum * sum) : 1.0;
    if (random >= 1.0 || compared <= 0.0) {
        return 1.0;
    }
    return (alike / compared - random) / (1.0 - random);
}

}  // namespace glint::synthetic
