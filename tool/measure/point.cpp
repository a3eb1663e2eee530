#include "base/lists.h"

#include <glint/measure/point.h>

namespace glint::measure {

namespace {

constexpr double HitTimes::*kHitParts[] = {&HitTimes::dispatch, &HitTimes::trace, &HitTimes::order,
                                           &HitTimes::shade, &HitTimes::shadow};

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
    for (double HitTimes::*const part : kHitParts) {
        this->*part += other.*part;
    }
    return *this;
}

HitTimes& HitTimes::operator/=(double count) {
    for (double HitTimes::*const part : kHitParts) {
        this->*part /= count;
    }
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

double valueOf(ErrorMetric metric, const image::ImageErrors& errors) {
    switch (metric) {
        case ErrorMetric::RelMse:
            return errors.relMse;
        case ErrorMetric::Trimmed:
            return errors.trimmed;
        case ErrorMetric::Rmse:
            return errors.rmse;
        case ErrorMetric::Flip:
            break;
    }
    return errors.flip;
}

double additive(ErrorMetric metric, double error) {
    return metric == ErrorMetric::Rmse ? error * error : error;
}

Interval timeRatio(const BenchPoint& point) {
    return measure::intervalOf(point.ratios);
}

Interval errorOf(const BenchPoint& point, ErrorMetric metric) {
    return measure::intervalOf(base::mapped<double>(
        point.errors, [&](const image::ImageErrors& errors) { return valueOf(metric, errors); }));
}

bool isTimeTie(const BenchPoint& point) {
    return isTie(timeRatio(point));
}

bool isErrorTie(const BenchPoint& point) {
    return point.sameImage || isTie(measure::intervalOf(point.errorRatios));
}

}  // namespace glint::measure
