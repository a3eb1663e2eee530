// Reports as `glint bench` writes them, made up: what the page is to show is known, and cases that a machine
// seldom gives are there.
#pragma once

#include "bench/page.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace glint::testing {

// NOLINTNEXTLINE(bugprone-exception-escape): the move of Json, which throws nothing that can be thrown here.
struct SamplePage {
    nlohmann::ordered_json report;
    std::vector<PageImage> images;
};

// About 60 points: singles, pairs, a search, other packages; ties, skipped values, an infinite PSNR, a bias
// whose interval holds 0.
SamplePage samplePage();

// One whose names try to be markup, script or an end of the element that they are in.
SamplePage hostilePage();

// One point, and everything null or empty that may be.
SamplePage sparsePage();

}  // namespace glint::testing
