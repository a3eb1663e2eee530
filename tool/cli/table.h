// Tables for people.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace glint {

// Columns padded to the widest cell and two spaces apart; a column is right-aligned where every cell below
// the first row begins with a digit or is "-". Missing cells are empty.
std::string formatTable(const std::vector<std::vector<std::string>>& rows);

// "label  value" lines, labels padded.
std::string formatFields(const std::vector<std::vector<std::string>>& rows);

// "812 B", "12.3 KiB", "4.56 MiB"
std::string formatBytes(std::uint64_t bytes);
// "a, b, c", or "-" for nothing.
std::string join(const std::vector<std::string>& words);

}  // namespace glint
