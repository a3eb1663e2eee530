// The values of settings that are worth trying on a scene and a device.
#pragma once

#include "resolve/build.h"
#include "settings/descriptor.h"

#include <glint/result.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace glint::measure {

// Returns the facts of one of a build's scenes on which the values worth trying depend. BenchFacts of the
// device are left out.
compiler::BenchFacts factsOf(const compiler::Build& build, std::size_t scene = 0);

struct SkippedValue {
    std::string value;
    std::string reason;
};

// A setting that is swept.
struct Setting {
    std::string name;
    std::string_view what;
    bool isCompiled = false;            // another value needs another package
    bool approximates = false;          // false if it changes time alone
    std::string base;                   // the value in the default configuration
    std::string exact{};                // the value in the reference; empty: `base`
    std::vector<std::string> values{};  // the values worth trying, including `base`, in their natural order
    std::vector<SkippedValue> skipped{};
};

// Returns the settings for which `base`, the default configuration, has a value. With `quick` they have fewer
// values.
std::vector<Setting> settingsFor(const compiler::BenchFacts& facts, const compiler::Configuration& base,
                                 bool quick);

// Returns whether the reference has a value of its own, and that value is worth trying.
bool hasExactValue(const Setting& setting);

// Returns the configuration of the reference: every approximation is off, and other settings keep their
// value. Approximations of transport also keep their value, unless the reference has all of light transport
// (BenchFacts::fullTransport).
compiler::Configuration exactValues(const compiler::BenchFacts& facts);

// Returns `configuration`, to be applied over `base`, without values that have no effect: an ordering if
// nothing is ordered, and values that equal those of `base`.
compiler::Configuration simplified(const compiler::Configuration& configuration,
                                   const compiler::Configuration& base);

// Returns the value of a setting at a point: its own, or that of `base`.
const std::string& valueOf(std::string_view name, const compiler::Configuration& configuration,
                           const compiler::Configuration& base);

// Returns "spp 4, ssr 16", or "default" for an empty configuration.
std::string nameOf(const compiler::Configuration& configuration);

// --- Files of settings: docs/schemas/settings.json ---

// Returns the text of a file. `origin` is the command line that it comes from.
std::string settingsText(const compiler::Configuration& settings, const std::string& origin);

// Has the errors of readFile(), and "settings-file" if the file has another format or a setting that Glint
// does not know.
Result<compiler::Configuration> readSettings(const std::filesystem::path& file);

// Returns the error "settings-file" about the place `pointer` of a file, or about the whole file if that is
// empty.
Diagnostic settingsError(const std::filesystem::path& file, const std::string& pointer,
                         const std::string& message, const std::string& hint);

}  // namespace glint::measure
