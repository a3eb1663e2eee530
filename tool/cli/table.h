// Tables for people.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace glint {

// Pads columns to the widest cell, with two spaces between them. A column is right-aligned if every cell
// below the first row begins with a digit or is "-". Missing cells are empty.
std::string formatTable(const std::vector<std::vector<std::string>>& rows);

// Returns "label  value" lines with padded labels.
std::string formatFields(const std::vector<std::vector<std::string>>& rows);

// Returns "812 B", "12.3 KiB" or "4.56 MiB".
std::string formatBytes(std::uint64_t bytes);
// Returns "a, b, c", or "-" for an empty list.
std::string join(const std::vector<std::string>& words);

}  // namespace glint
