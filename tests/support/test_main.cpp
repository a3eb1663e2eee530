// The main function of the test programs. With GLINT_TEST_TIMES=FILE it appends a line to the file for each
// case: user and system time in seconds, with that of the processes that the case waited for, then program
// and case.
#include "support/nightly.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <sys/resource.h>

namespace {

double processorSeconds() {
    double seconds = 0;
    for (const int whose : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
        rusage usage{};
        getrusage(whose, &usage);
        for (const timeval& time : {usage.ru_utime, usage.ru_stime}) {
            seconds += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
        }
    }
    return seconds;
}

class CaseTimes : public testing::EmptyTestEventListener {
public:
    explicit CaseTimes(const char* path) : path_(path) {}

private:
    void OnTestStart(const testing::TestInfo&) override {
        start_ = processorSeconds();
    }
    void OnTestEnd(const testing::TestInfo& test) override {
        append(processorSeconds() - start_, test.test_suite_name(), test.name());
    }
    // What the cases share, and what the program does before and after them.
    void OnTestProgramEnd(const testing::UnitTest&) override {
        append(processorSeconds(), "*", "*");
    }
    void append(double seconds, const char* suite, const char* name) const {
        if (std::FILE* const file = std::fopen(path_, "a")) {
            std::fprintf(file, "%.3f %s %s.%s\n", seconds, program_invocation_short_name, suite, name);
            std::fclose(file);
        }
    }

    const char* path_;
    double start_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    // Lavapipe's LLVM passes take longer than what they save in pictures of a few thousand pixels, and its
    // threads wait for each other while the tests beside this one keep all cores busy. Neither changes a
    // result, and the nightly run has both. Commands that a test runs inherit this.
    if (!glint::test::nightly()) {
        setenv("GALLIVM_PERF", "nopt", 0);
        setenv("LP_NUM_THREADS", "0", 0);
    }
    if (const char* const path = std::getenv("GLINT_TEST_TIMES")) {
        testing::UnitTest::GetInstance()->listeners().Append(new CaseTimes(path));
    }
    return RUN_ALL_TESTS();
}
