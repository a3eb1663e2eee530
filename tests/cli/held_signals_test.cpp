#include "cli/compile/compile.h"

#include <gtest/gtest.h>

#include <csignal>

namespace glint {
namespace {

volatile std::sig_atomic_t handled = 0;

void count(int /*signal*/) {
    handled = handled + 1;
}

TEST(HeldSignals, ActAfterwardsAsTheyWouldHave) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction action {};
        action.sa_handler = count;
        struct sigaction before {};
        ASSERT_EQ(sigaction(signal, &action, &before), 0);
        handled = 0;
        {
            const cli::HeldSignals held;
            std::raise(signal);
            EXPECT_EQ(handled, 0) << signal;
        }
        EXPECT_EQ(handled, 1) << signal;
        std::raise(signal);
        EXPECT_EQ(handled, 2) << signal;
        sigaction(signal, &before, nullptr);
    }
}

TEST(HeldSignals, StayIgnoredWhereTheyWere) {
    struct sigaction action {};
    action.sa_handler = SIG_IGN;
    struct sigaction before {};
    ASSERT_EQ(sigaction(SIGHUP, &action, &before), 0);
    {
        const cli::HeldSignals held;
        std::raise(SIGHUP);
    }
    struct sigaction after {};
    ASSERT_EQ(sigaction(SIGHUP, &before, &after), 0);
    EXPECT_EQ(after.sa_handler, SIG_IGN);
}

TEST(HeldSignalsDeathTest, EndTheProgramByDefault) {
    const auto interrupted = [] {
        const cli::HeldSignals held;
        std::raise(SIGTERM);
    };
    EXPECT_EXIT(interrupted(), ::testing::KilledBySignal(SIGTERM), "");
}

}  // namespace
}  // namespace glint
