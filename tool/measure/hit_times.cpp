#include <glint/measure/hit_times.h>

namespace glint::measure {

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
    for (const PassTime& pass : passes) {
        switch (pass.part) {
            case HitPart::Dispatch:
                times.dispatch += pass.milliseconds;
                break;
            case HitPart::Trace:
                times.trace += pass.milliseconds;
                break;
            case HitPart::Order:
                times.order += pass.milliseconds;
                break;
            case HitPart::Shade:
                times.shade += pass.milliseconds;
                break;
            case HitPart::Shadow:
                times.shadow += pass.milliseconds;
                break;
            case HitPart::None:
                break;
        }
    }
    return times;
}

}  // namespace glint::measure
