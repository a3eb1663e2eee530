// Delays interruptions while files are being replaced.
#pragma once

#include <array>
#include <csignal>

namespace glint::cli {

// While it lives, SIGINT, SIGTERM and SIGHUP wait. Afterwards the last one that came has its usual effect.
// Use it for short stretches, and only one at a time: the command acts on one thread.
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

}  // namespace glint::cli
