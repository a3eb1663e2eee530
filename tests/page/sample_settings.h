// The settings of the reports of sample_report.h.
#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <vector>

namespace glint::testing {

// The effect of a setting's value on time and on error, as factors.
struct Value {
    const char* name;
    double time;
    double error;
    const char* skipped = nullptr;
};
struct Setting {
    const char* name;
    const char* stage;
    bool approximates;
    const char* what;
    std::size_t defaultValue;
    std::vector<Value> values;
};

const std::vector<Setting>& sampleSettings();

// Returns the settings as the report lists them, plus one that has a single value.
nlohmann::ordered_json sampleSettingsJson();

}  // namespace glint::testing
