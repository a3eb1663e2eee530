#include "cli/compile/held_signals.h"

#include <cstddef>

namespace glint::cli {

namespace {

// A signal handler can only reach global data.
volatile std::sig_atomic_t heldSignal = 0;

void hold(int signal) {
    heldSignal = signal;
}

}  // namespace

HeldSignals::HeldSignals() {
    heldSignal = 0;
    struct sigaction action {};
    action.sa_handler = hold;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
        sigaction(kSignals[i], &action, &earlier_[i]);
    }
}

HeldSignals::~HeldSignals() {
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
        sigaction(kSignals[i], &earlier_[i], nullptr);
    }
    if (heldSignal != 0) {
        std::raise(heldSignal);
    }
}

}  // namespace glint::cli
