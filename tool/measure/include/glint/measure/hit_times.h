// Splits the time of a frame's hits by the passes in which strategies differ.
#pragma once

#include <glint/renderer.h>

#include <span>

namespace glint::measure {

// Milliseconds from the list of rays to their shaded hits.
struct HitTimes {
    double dispatch = 0.0;  // makes the indirect arguments of the list of rays
    double trace = 0.0;   // traces rays and writes hit records, in strategies with a pass of its own for that
    double order = 0.0;   // sorts those records by bucket
    double shade = 0.0;   // shades hits; strategies that order none also trace here
    double shadow = 0.0;  // traces deferred shadow rays, and dispatches them

    double sum() const {
        return dispatch + trace + order + shade + shadow;
    }
    HitTimes& operator+=(const HitTimes& other);
    HitTimes& operator/=(double count);
};

// Adds up all passes of a sample (Timing::Passes).
HitTimes hitTimesOf(std::span<const PassTiming> passes);

}  // namespace glint::measure
