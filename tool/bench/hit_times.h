// Splits the time of a frame's hits by the passes in which strategies differ.
#pragma once

#include <cstdint>
#include <span>

namespace glint::bench {

// What a pass counts for.
enum class HitPart : std::uint8_t {
    None,      // of primary surfaces or of the picture, or a check
    Dispatch,  // indirect arguments of the list of rays
    Trace,     // rays to hit records, where a pass of its own does that
    Order,     // those records by bucket
    Shade,     // hits; of uber and hit-shaders with their tracing
    Shadow,    // deferred shadow rays, with their dispatch
};

struct PassTime {
    HitPart part = HitPart::None;
    double milliseconds = 0.0;
};

// Milliseconds, from the list of rays to their shaded hits; the members as HitPart says.
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

// Of all passes of a sample.
HitTimes hitTimesOf(std::span<const PassTime> passes);

}  // namespace glint::bench
