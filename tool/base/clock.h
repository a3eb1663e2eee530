// The clock by which the host's work is measured.
#pragma once

#include <chrono>

namespace glint::base {

using Clock = std::chrono::steady_clock;

inline double millisecondsBetween(Clock::time_point start, Clock::time_point end) {
    return std::chrono::duration<double, std::milli>(end - start).count();
}

inline double millisecondsSince(Clock::time_point start) {
    return millisecondsBetween(start, Clock::now());
}

}  // namespace glint::base
