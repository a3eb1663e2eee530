// Every diagnostic that Glint makes, by id: what -W and --werror take. docs/diagnostics.md says what each
// means.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace glint::cli {

inline constexpr std::uint8_t kNote = 1;
inline constexpr std::uint8_t kWarning = 2;
inline constexpr std::uint8_t kError = 4;
inline constexpr std::uint8_t kAnySeverity = kNote | kWarning | kError;

// Returns the ids of the diagnostics that come with any of the severities (bits), sorted.
std::vector<std::string> diagnosticIds(std::uint8_t severities = kAnySeverity);

// Returns the severities with which diagnostics of that id come, or 0 if there is none.
std::uint8_t severitiesOf(std::string_view id);

}  // namespace glint::cli
