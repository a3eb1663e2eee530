#include "frame/bounce_levels.h"

#include <algorithm>

namespace glint {

namespace {

constexpr std::uint32_t kDraws = 4;

// Returns how many bounces beyond the certain ones are recorded after `passed` successful draws. After the
// last draw all bounces are.
constexpr std::uint32_t bouncesBehind(std::uint32_t passed) {
    return (2U << passed) - 2U;  // 0, 2, 6, 14
}

}  // namespace

RecordedBounces drawBounces(std::uint32_t certain, std::uint32_t bounces, std::uint32_t random) {
    std::uint32_t passed = 0;
    while (passed < kDraws && ((random >> passed) & 1U) != 0) {
        ++passed;
    }
    const std::uint32_t count = passed == kDraws ? bounces : certain + bouncesBehind(passed);
    return {certain, std::min(count, bounces)};
}

float weightBehind(std::uint32_t bounce, std::uint32_t certain) {
    for (std::uint32_t draw = 0; draw < kDraws; ++draw) {
        if (bounce == certain + bouncesBehind(draw)) {
            return 2.0F;
        }
    }
    return 1.0F;
}

// The hash of shaders/hit/random.glsl. Paths have other dimensions.
std::uint32_t bounceBits(std::uint32_t sampleIndex, std::uint32_t seed) {
    constexpr std::uint32_t kDimension = 0xB0C0DE5U;
    const auto hash = [](std::uint32_t value) {
        const std::uint32_t state = value * 747796405U + 2891336453U;
        const std::uint32_t word = ((state >> ((state >> 28U) + 4U)) ^ state) * 277803737U;
        return (word >> 22U) ^ word;
    };
    return hash(sampleIndex + hash(kDimension + hash(seed)));
}

std::uint32_t BounceLevels::certainBounces(std::uint32_t bounces) const {
    if (bounces <= kFewBounces || depths_.empty()) {
        return bounces;
    }
    std::uint32_t certain = 1;
    for (const Depth& depth : depths_) {
        const bool mayGoOn = depth.reached >= depth.recorded;
        certain = std::max(certain, mayGoOn ? 2 * depth.recorded : depth.reached + 1);
    }
    return std::min(certain, bounces);
}

void BounceLevels::recorded(std::uint64_t recording, std::uint32_t count) {
    counts_[slotOf(recording)] = count;
    last_ = recording;
}

void BounceLevels::completed(std::uint64_t recording, std::span<const std::uint32_t, kSlots> depths) {
    const std::uint64_t kept = last_ < kSlots ? 0 : last_ - kSlots;
    for (std::uint64_t done = std::max(read_, kept) + 1; done <= std::min(recording, last_); ++done) {
        depths_.push_back({counts_[slotOf(done)], depths[slotOf(done)]});
    }
    read_ = std::max(read_, std::min(recording, last_));
    while (depths_.size() > kRemembered) {
        depths_.pop_front();
    }
}

void BounceLevels::skipped(std::uint64_t recording) {
    last_ = recording;
    read_ = recording;
}

void BounceLevels::reset() {
    depths_.clear();
    read_ = last_;
}

}  // namespace glint
