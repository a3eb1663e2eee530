// Formats results of probes as text.
#pragma once

#include "measure.h"

#include <span>
#include <string>
#include <utility>
#include <vector>

namespace glint::numerics {

struct ReportRow {
    Probe probe;
    ProbeResult result;

    // Returns whether all values are finite, and errors and undecided inputs are within the probe's bounds.
    bool passes() const;
};

struct Report {
    std::string device;
    MeasureOptions options;
    std::vector<ReportRow> rows;
};

// Returns "(0.5, 1, -2e-07)", with enough digits to identify a float.
std::string formatInputs(std::span<const float> inputs);

std::string toMarkdown(const Report& report);
std::string toJson(const Report& report);

// Returns the form in the table: "exact", "< 1e-10", "1.2e-07", "not finite".
std::string formatError(double error);

}  // namespace glint::numerics
