// Compares the shaders' functions on the device and as C++ in single precision with the same functions in
// double precision.
#include "evaluate.h"
#include "measure.h"
#include "report.h"
#include "support/must.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

namespace glint::numerics {
namespace {

class Precision : public testing::TestWithParam<Probe> {};

std::string describe(const ProbeResult& result, const ErrorStatistics& statistics) {
    return "worst " + std::to_string(statistics.worst()) + " in output " +
           std::to_string(statistics.worstOutput()) + " of " + formatInputs(statistics.worstInputs()) + ", " +
           std::to_string(result.inputs) + " inputs, seed " + std::to_string(result.seed);
}

TEST_P(Precision, IsWithinItsBounds) {
    const Probe& probe = GetParam();
    Result<std::unique_ptr<ProbeDevice>> device = ProbeDevice::create();
    if (!device) {
        GTEST_SKIP() << "no device to test on: " << toString(device.error());
    }
    const ProbeResult result = must(measure(**device, probe, optionsFromEnvironment()));

    EXPECT_EQ(result.device.notFinite(), 0U) << "device: " << describe(result, result.device);
    EXPECT_EQ(result.single.notFinite(), 0U) << "C++: " << describe(result, result.single);
    EXPECT_LE(result.device.worst(), probe.bounds.worst) << "device: " << describe(result, result.device);
    EXPECT_LE(result.single.worst(), probe.bounds.worst) << "C++: " << describe(result, result.single);
    EXPECT_LE(result.device.median(), probe.bounds.median) << "device: " << describe(result, result.device);
    if (probe.decides()) {
        EXPECT_LE(static_cast<double>(result.undecided),
                  probe.undecidedShare * static_cast<double>(result.inputs));
    }
    for (const std::string& message : (*device)->messages()) {
        ADD_FAILURE() << message;
    }
}

INSTANTIATE_TEST_SUITE_P(Shaders, Precision, testing::ValuesIn(allProbes().begin(), allProbes().end()),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

TEST(Probes, EveryOneOfTheTextIsMeasured) {
    std::set<std::string_view> measured;
    for (const Probe& probe : allProbes()) {
        measured.insert(probe.name);
        measured.insert(probe.textbook);
        EXPECT_LE(probe.inputs, kMaxInputs) << probe.name;
        EXPECT_LE(probe.allOutputs(), kMaxOutputs) << probe.name;
    }
    for (const ProbeFunction<double>& probe : probeFunctions<double>()) {
        EXPECT_TRUE(measured.contains(probe.name)) << probe.name;
    }
}

}  // namespace
}  // namespace glint::numerics
