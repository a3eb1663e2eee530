// Compares Glint's pictures with the specification: a short list in every build, all of it under
// GLINT_NIGHTLY.
#include "oracle/spec/bounds.h"
#include "oracle/spec/comparison.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <memory>
#include <set>
#include <string>

namespace {

using namespace glint::spec;

bool nightly() {
    return std::getenv("GLINT_NIGHTLY") != nullptr;
}

// Every row of the scene is planned and uploaded; a short build compares some of them.
class SpecDevice : public ::testing::TestWithParam<bool> {
protected:
    static void SetUpTestSuite() {
        kRows = std::make_unique<Rows>(allRows());
    }
    static void TearDownTestSuite() {
        for (auto& comparer : kComparers) {
            comparer.reset();
        }
        kRows.reset();
    }

    // Packages with and without compensation are made once.
    Comparer& comparer() {
        std::unique_ptr<Comparer>& made = kComparers[GetParam() ? 1 : 0];
        if (!made) {
            ComparisonOptions options;
            options.device.compensation = GetParam();
            options.manyViews = nightly();
            options.quality = nightly() ? 96 : 32;
            options.device.samples = nightly() ? 64 : 4;
            made = std::make_unique<Comparer>(*kRows, options);
        }
        return *made;
    }
    // A short build leaves the plain formulas to lights and furnaces, and there to bases.
    static std::vector<std::size_t> compared() {
        std::vector<std::size_t> all;
        for (std::size_t i = 0; i < kRows->rows.size(); ++i) {
            const Row& row = kRows->rows[i];
            if (nightly() || (row.quick && (GetParam() || row.group == "base"))) {
                all.push_back(i);
            }
        }
        return all;
    }

    static std::unique_ptr<Rows> kRows;
    static std::array<std::unique_ptr<Comparer>, 2> kComparers;
};
std::unique_ptr<Rows> SpecDevice::kRows;
std::array<std::unique_ptr<Comparer>, 2> SpecDevice::kComparers;

void expectWithin(const Comparison& row) {
    const std::string objection = objectionTo(row);
    EXPECT_EQ(objection, "") << row.group << ": " << row.name;
}

TEST_P(SpecDevice, ShowsLightsAsTheSpecificationSays) {
    for (std::size_t row = 0; row < kRows->rows.size(); ++row) {
        if (nightly() || kRows->rows[row].quick) {
            expectWithin(comparer().underLights(row));
        }
    }
}

TEST_P(SpecDevice, ShowsAMapAsTheSpecificationSays) {
    for (const std::size_t row : compared()) {
        for (const Transport transport : {Transport::Traced, Transport::Untraced}) {
            expectWithin(comparer().underMap(row, MapKind::Smooth, transport));
            if (nightly()) {
                expectWithin(comparer().underMap(row, MapKind::Spot, transport));
            }
        }
    }
}

// Furnaces by equality: what does not absorb shows the white sky itself, or loses exactly what single
// scattering loses.
TEST_P(SpecDevice, KeepsAllLightInAWhiteFurnace) {
    for (const std::size_t row : compared()) {
        for (const Transport transport : {Transport::Traced, Transport::Untraced}) {
            expectWithin(comparer().underMap(row, MapKind::White, transport));
        }
    }
}

// Closed surfaces: what enters a sphere of glass leaves it again.
TEST_P(SpecDevice, KeepsAllLightOnSpheres) {
    for (std::size_t row = 0; GetParam() && row < kRows->rows.size(); ++row) {
        if (kRows->rows[row].sphere) {
            expectWithin(comparer().inFurnaceOnSphere(row, Transport::Traced));
            expectWithin(comparer().inFurnaceOnSphere(row, Transport::Untraced));
        }
    }
}

const char* packageName(const ::testing::TestParamInfo<bool>& compensation) {
    return compensation.param ? "Compensated" : "Plain";
}

INSTANTIATE_TEST_SUITE_P(, SpecDevice, ::testing::Values(false, true), packageName);

}  // namespace
