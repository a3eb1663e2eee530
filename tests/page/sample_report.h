// Made-up reports in the form that `glint bench` writes. Their content is known, and they contain cases that
// a machine seldom gives.
#pragma once

#include "measure/page.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace glint::testing {

// Moving the Json can't throw here. NOLINTNEXTLINE(bugprone-exception-escape)
struct SamplePage {
    nlohmann::ordered_json report;
    std::vector<measure::PageImage> images;
};

// Returns about 60 points: singles, pairs, a search, other packages; ties, skipped values, an infinite PSNR,
// a bias whose interval contains 0.
SamplePage samplePage();

// Returns a report whose names try to be markup, script or an end of the element that contains them.
SamplePage hostilePage();

// Returns one point, with everything null or empty that may be.
SamplePage sparsePage();

}  // namespace glint::testing
