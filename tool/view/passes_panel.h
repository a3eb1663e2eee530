// The time of each pass of the last frames, as a running chart.
#pragma once

#include "view/controls.h"

#include <glint/renderer.h>

#include <array>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

namespace glint::view {

// Device times of the last frames.
class PassHistory {
public:
    static constexpr std::size_t kFrames = 160;

    void add(const std::vector<PassTiming>& passes);
    void clear();
    // Names of passes in the order in which they first ran.
    const std::vector<std::string>& names() const {
        return names_;
    }
    // Milliseconds by pass, for each frame, the oldest first. Later frames may have more passes.
    const std::deque<std::vector<double>>& frames() const {
        return frames_;
    }
    // The median of the frames that have the pass.
    double median(std::size_t pass) const;
    double medianFrame() const;

private:
    std::vector<std::string> names_;
    std::deque<std::vector<double>> frames_;
};

// Draws chart and table. `counters` are those of the last frame.
void drawPasses(Controls& controls, const PassHistory& history, const FrameCounters& counters);

}  // namespace glint::view
