// Chooses how many bounces of a frame's paths are recorded. In a frame of many bounces, most passes work on
// lists that are empty or nearly so, because Russian roulette ends most paths early. The device says how deep
// the paths of earlier frames were. Later frames record the bounces that many paths reach, and further ones
// at random. Light that is found beyond a draw counts twice as much, so the mean is unbiased.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <span>

namespace glint {

// The bounces of one recording.
struct RecordedBounces {
    std::uint32_t certain = 1;  // are recorded whatever was drawn
    std::uint32_t count = 1;    // are recorded; at least `certain`
};

// Draws how many of `bounces` are recorded if `certain` of them are in any case. Behind those follow 2, then
// 4, then 8, then all others, each with the probability 1/2 if those before it are recorded. `random` has 32
// random bits. Requires 1 <= certain <= bounces.
RecordedBounces drawBounces(std::uint32_t certain, std::uint32_t bounces, std::uint32_t random);

// Returns the factor of the light that paths find after the bounce, besides those of the bounces before: 2
// where a draw decides about the next one, else 1. The product of the factors up to any bounce is one over
// the probability that it is recorded.
float weightBehind(std::uint32_t bounce, std::uint32_t certain);

// Returns bits for drawBounces(), which are independent of the random numbers of the sample's paths.
std::uint32_t bounceBits(std::uint32_t sampleIndex, std::uint32_t seed);

class BounceLevels {
public:
    // Frames of up to this number of bounces are recorded whole.
    static constexpr std::uint32_t kFewBounces = 8;
    // The device keeps the depths of so many recordings until the host reads them.
    static constexpr std::uint32_t kSlots = 8;
    // The number of completed recordings, counted back from the last, that decide.
    static constexpr std::size_t kRemembered = 16;

    static std::uint32_t slotOf(std::uint64_t recording) {
        return static_cast<std::uint32_t>(recording % kSlots);
    }

    // Returns how many bounces the next recording has in any case: one more than the number that many paths
    // of the last completed recordings reached. If many reached the last bounce of their recording, more may
    // have gone on, so then it is twice as many. Without completed recordings it is all of `bounces`.
    std::uint32_t certainBounces(std::uint32_t bounces) const;

    // Notes a recording, numbered from 1.
    void recorded(std::uint64_t recording, std::uint32_t count);

    // The device has completed all recordings up to a number. `depths` has kCounterDeepest of a recording in
    // its slot. Recordings whose slot a later one has taken are left out.
    void completed(std::uint64_t recording, std::span<const std::uint32_t, kSlots> depths);

    // Forgets everything, for other buffers on the device. Recordings before do not count.
    void reset();
    // Says that a recording followed no paths, so that it and earlier ones give no depths.
    void skipped(std::uint64_t recording);

private:
    struct Depth {
        std::uint32_t recorded = 1;
        std::uint32_t reached = 0;
    };

    std::array<std::uint32_t, kSlots> counts_{};
    std::uint64_t last_ = 0;  // recording
    std::uint64_t read_ = 0;  // recordings up to this one are in depths_, or left out
    std::deque<Depth> depths_;
};

}  // namespace glint
