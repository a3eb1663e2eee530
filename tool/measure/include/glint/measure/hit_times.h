// Splits the time of a frame's hits by the passes in which strategies differ.
#pragma once

#include <cstdint>
#include <span>

namespace glint::measure {

// The part of the work on hits to which a pass belongs.
enum class HitPart : std::uint8_t {
    None,      // passes of primary surfaces or of the picture, and checks
    Dispatch,  // makes the indirect arguments of the list of rays
    Trace,     // traces rays and writes hit records, in strategies with a pass of its own for that
    Order,     // sorts those records by bucket
    Shade,     // shades hits; uber and hit-shaders also trace here
    Shadow,    // traces deferred shadow rays, and dispatches them
};

struct PassTime {
    HitPart part = HitPart::None;
    double milliseconds = 0.0;
};

// Milliseconds from the list of rays to their shaded hits, split by HitPart.
struct HitTimes {
    double dispatch = 0.0;
    double trace = 0.0;
    double order = 0.0;
    double shade = 0.0;
    double shadow = 0.0;

    double sum() const {
        return dispatch + trace + order + shade + shadow;
    }
    HitTimes& operator+=(const HitTimes& other);
    HitTimes& operator/=(double count);
};

// Adds up all passes of a sample.
HitTimes hitTimesOf(std::span<const PassTime> passes);

}  // namespace glint::measure
