// Holding back interruptions while files are half-way.
#pragma once

#include <array>
#include <csignal>

namespace glint {

// While it lives, SIGINT, SIGTERM and SIGHUP wait; the last that came acts afterwards, as it would have. For
// short stretches, and one at a time: the command acts on one thread.
class HeldSignals {
public:
    HeldSignals();
    HeldSignals(const HeldSignals&) = delete;
    HeldSignals& operator=(const HeldSignals&) = delete;
    ~HeldSignals();

private:
    static constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};
    std::array<struct sigaction, kSignals.size()> earlier_{};
};

}  // namespace glint
