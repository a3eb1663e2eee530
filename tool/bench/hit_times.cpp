#include "bench/hit_times.h"

#include <string_view>

namespace glint::bench {

namespace {

constexpr std::string_view kFirst = "ray dispatch";

// Returns whether a pass belongs to the primary surfaces or to the whole picture, so that it ends a round.
bool endsRound(std::string_view name) {
    return name == "compose" || name.ends_with(" rays") || name.ends_with(" walk");
}

double& placeOf(std::string_view name, HitTimes& times) {
    if (name == kFirst) {
        return times.dispatch;
    }
    if (name == "trace") {
        return times.trace;
    }
    if (name == "shadow dispatch" || name == "shadow") {
        return times.shadow;
    }
    const bool shades =
        name == "uber" || name == "sorted uber" || name == "hit shaders" || name.starts_with("shade ");
    return shades ? times.shade : times.order;
}

}  // namespace

HitTimes& HitTimes::operator+=(const HitTimes& other) {
    dispatch += other.dispatch;
    trace += other.trace;
    order += other.order;
    shade += other.shade;
    shadow += other.shadow;
    return *this;
}

HitTimes& HitTimes::operator/=(double count) {
    dispatch /= count;
    trace /= count;
    order /= count;
    shade /= count;
    shadow /= count;
    return *this;
}

HitTimes hitTimesOf(std::span<const PassTime> passes) {
    HitTimes times;
    bool inside = false;
    for (const PassTime& pass : passes) {
        inside = pass.name == kFirst || (inside && !endsRound(pass.name));
        if (inside && pass.name != "check order") {
            placeOf(pass.name, times) += pass.milliseconds;
        }
    }
    return times;
}

}  // namespace glint::bench
