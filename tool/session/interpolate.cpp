#include "session/interpolate.h"

#include <algorithm>
#include <cmath>

namespace glint::session {

namespace {

// Two neighbouring keyframes, and the place of a time between them.
struct Segment {
    std::size_t from = 0;
    std::size_t to = 0;    // equal to `from` at a keyframe and outside all of them
    double amount = 0.0;   // [0, 1)
    double seconds = 0.0;  // from one keyframe to the other
};

Segment findSegment(const std::vector<float>& times, double time) {
    const auto after = std::ranges::upper_bound(times, time, {}, [](float t) { return double{t}; });
    const auto next = static_cast<std::size_t>(after - times.begin());
    if (next == 0 || next == times.size()) {
        const std::size_t end = next == 0 ? 0 : next - 1;
        return {end, end, 0.0, 0.0};
    }
    const double begin = times[next - 1];
    const double seconds = times[next] - begin;
    return {next - 1, next, (time - begin) / seconds, seconds};
}

// The three parts of a keyframe of CubicSpline.
enum Part : std::size_t { kInTangent = 0, kValue = 1, kOutTangent = 2 };

double valueAt(const gltf::AnimationSampler& sampler, std::size_t keyframe, std::size_t number,
               Part part = kValue) {
    if (sampler.interpolation == gltf::Interpolation::CubicSpline) {
        return sampler.values[(3 * keyframe + part) * sampler.width + number];
    }
    return sampler.values[keyframe * sampler.width + number];
}

// The formula is in glTF 2.0, appendix C.5.
double cubic(const gltf::AnimationSampler& sampler, const Segment& at, std::size_t number) {
    const double t = at.amount;
    const double t2 = t * t;
    const double t3 = t2 * t;
    return (2.0 * t3 - 3.0 * t2 + 1.0) * valueAt(sampler, at.from, number) +
           at.seconds * (t3 - 2.0 * t2 + t) * valueAt(sampler, at.from, number, kOutTangent) +
           (-2.0 * t3 + 3.0 * t2) * valueAt(sampler, at.to, number) +
           at.seconds * (t3 - t2) * valueAt(sampler, at.to, number, kInTangent);
}

double interpolate(const gltf::AnimationSampler& sampler, const Segment& at, std::size_t number) {
    const double from = valueAt(sampler, at.from, number);
    if (at.from == at.to || sampler.interpolation == gltf::Interpolation::Step) {
        return from;
    }
    if (sampler.interpolation == gltf::Interpolation::CubicSpline) {
        return cubic(sampler, at, number);
    }
    return (1.0 - at.amount) * from + at.amount * valueAt(sampler, at.to, number);
}

// Quaternions of glm have w first, those of glTF have it last.
template <typename NumberAt>
Quaternion quaternionOf(const NumberAt& numberAt) {
    return glm::normalize(Quaternion(numberAt(3), numberAt(0), numberAt(1), numberAt(2)));
}

}  // namespace

// glm::slerp() takes the angle from its cosine, and the arc cosine of a number near 1 has half the digits. So
// this takes it from the chord.
Quaternion slerp(const Quaternion& from, const Quaternion& to, double amount) {
    const Quaternion end = glm::dot(from, to) < 0.0 ? -to : to;
    const double angle = 2.0 * std::asin(std::min(1.0, 0.5 * glm::length(end - from)));
    const double sine = std::sin(angle);
    // Below this, the arc and its chord are equal to the last digit of a double.
    constexpr double kStraight = 1e-8;
    if (sine < kStraight) {
        return glm::normalize(from * (1.0 - amount) + end * amount);
    }
    return glm::normalize(from * (std::sin((1.0 - amount) * angle) / sine) +
                          end * (std::sin(amount * angle) / sine));
}

std::vector<double> sampleNumbers(const gltf::AnimationSampler& sampler, double time) {
    const Segment at = findSegment(sampler.times, time);
    std::vector<double> numbers(sampler.width);
    for (std::size_t i = 0; i < sampler.width; ++i) {
        numbers[i] = interpolate(sampler, at, i);
    }
    return numbers;
}

Quaternion sampleRotation(const gltf::AnimationSampler& sampler, double time) {
    const Segment at = findSegment(sampler.times, time);
    const auto rotationAt = [&](std::size_t keyframe) {
        return quaternionOf([&](std::size_t number) { return valueAt(sampler, keyframe, number); });
    };
    if (at.from == at.to || sampler.interpolation == gltf::Interpolation::Step) {
        return rotationAt(at.from);
    }
    if (sampler.interpolation == gltf::Interpolation::Linear) {
        return slerp(rotationAt(at.from), rotationAt(at.to), at.amount);
    }
    return quaternionOf([&](std::size_t number) { return cubic(sampler, at, number); });
}

}  // namespace glint::session
