#include <glint/measure/hit_times.h>

namespace glint::measure {

namespace {

// Returns null for passes of primary surfaces or of the picture, and for checks.
double HitTimes::*partOf(Pass pass) {
    switch (pass) {
        case Pass::RayDispatch:
            return &HitTimes::dispatch;
        case Pass::Trace:
            return &HitTimes::trace;
        case Pass::Count:
        case Pass::Offset:
        case Pass::Copy:
            return &HitTimes::order;
        case Pass::Shade:
        case Pass::ShadeCase:
            return &HitTimes::shade;
        case Pass::ShadowDispatch:
        case Pass::Shadow:
            return &HitTimes::shadow;
        default:
            return nullptr;
    }
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

HitTimes hitTimesOf(std::span<const PassTiming> passes) {
    HitTimes times;
    for (const PassTiming& pass : passes) {
        if (double HitTimes::*const part = partOf(pass.pass)) {
            times.*part += pass.milliseconds;
        }
    }
    return times;
}

}  // namespace glint::measure
