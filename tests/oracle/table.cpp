#include "oracle/table.h"

#include "oracle/comparison.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

namespace glint::oracle {
namespace {

std::vector<std::string>& rows() {
    static std::vector<std::string> all;
    return all;
}

class TableWriter : public ::testing::Environment {
public:
    void TearDown() override {
        if (rows().empty()) {
            return;
        }
        std::ofstream file(GLINT_BINARY_DIR "/tests/effects_accuracy.md");
        file << "| effect | scene | truth | pixels | samples | mean | RMS error | of independent samples | "
                "largest "
                "error | share of its bound | mean signed error |\n"
                "|---|---|---|---|---|---|---|---|---|---|---|\n";
        for (const std::string& row : rows()) {
            file << row;
        }
        EXPECT_TRUE(file.good());
    }
};

const ::testing::Environment* const kWriter = ::testing::AddGlobalTestEnvironment(new TableWriter);

}  // namespace

void addRow(const Subject& subject, const Comparison& comparison) {
    rows().push_back(fmt::format(
        "| {} | {} | {} | {} | {} | {:.3g} | {:.1e} | {:.1e} | {:.1e} | {:.0f} % | {:+.1e} ± {:.0e} |\n",
        subject.effect, subject.what, subject.truth, comparison.pixels, subject.samples, comparison.mean,
        comparison.rootMeanSquare, comparison.expected, comparison.largest, 100.0 * comparison.worst,
        comparison.signedMean, comparison.signedError));
    std::printf("%s", rows().back().c_str());
}

}  // namespace glint::oracle
