// Splits the time of a frame's hits by the passes in which strategies differ.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace glint::bench {

struct PassTime {
    std::string name;  // as in architecture.md, "Passes of a frame"
    double milliseconds = 0.0;
};

// Milliseconds, from the list of rays to their shaded hits.
struct HitTimes {
    double dispatch = 0.0;  // for the indirect arguments of the list
    double trace = 0.0;     // to hit records, if that is a pass of its own
    double order = 0.0;     // to order those records by bucket: all passes that are none of the others
    double shade = 0.0;     // for uber and hit-shaders this includes their tracing
    double shadow = 0.0;    // for deferred shadow rays, including their dispatch

    double sum() const {
        return dispatch + trace + order + shade + shadow;
    }
    HitTimes& operator+=(const HitTimes& other);
    HitTimes& operator/=(double count);
};

// Adds up the passes of a sample, given in their order; each round of effects starts with its "ray dispatch".
// The check of the order is not counted, because nobody who measures asks for it.
HitTimes hitTimesOf(std::span<const PassTime> passes);

}  // namespace glint::bench
