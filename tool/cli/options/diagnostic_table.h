// Every diagnostic that Glint makes, by id: what -W and --werror take. docs/diagnostics.md is the same for
// people.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace glint::cli {

inline constexpr std::uint8_t kNote = 1;
inline constexpr std::uint8_t kWarning = 2;
inline constexpr std::uint8_t kError = 4;

struct DiagnosticInfo {
    std::string_view id;
    std::uint8_t severities = 0;  // those that it comes with: bits of kNote, kWarning, kError
    std::string_view meaning;     // one sentence
};

// Returns the table, sorted by id.
std::span<const DiagnosticInfo> diagnosticTable();

// Returns null if there is no diagnostic with that id.
const DiagnosticInfo* findDiagnostic(std::string_view id);

}  // namespace glint::cli
