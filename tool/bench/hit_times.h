// Where the time of a frame's hits goes: the passes in which strategies differ.
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
    double dispatch = 0.0;  // indirect arguments of the list
    double trace = 0.0;     // to hit records, where a pass of its own does that
    double order = 0.0;     // of those records by bucket: whatever is neither of the others
    double shade = 0.0;     // of uber and hit-shaders with their tracing
    double shadow = 0.0;    // deferred shadow rays, with their dispatch

    double sum() const {
        return dispatch + trace + order + shade + shadow;
    }
    HitTimes& operator+=(const HitTimes& other);
    HitTimes& operator/=(double count);
};

// Of all passes of a sample in their order, each round of effects from its "ray dispatch" on. The check of
// the order is left out, which no one asks for who measures.
HitTimes hitTimesOf(std::span<const PassTime> passes);

}  // namespace glint::bench
