// Tables for people. Programs read --json: what stands here is cut and wrapped to fit a terminal.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace glint {

// How much of long cells is shown.
enum class Detail : std::uint8_t {
    Short,  // as much as fits a terminal
    Whole,  // all of it, with --verbose
};

// Characters of a line with Detail::Short. Tables of many columns may take up to kMostTableWidth, and more
// only where their numbers alone do.
inline constexpr std::size_t kTableWidth = 80;
inline constexpr std::size_t kMostTableWidth = 100;

// Columns padded to the widest cell and two spaces apart; a column is right-aligned where every cell below
// the first row begins with a digit or is "-", and none is the title of a shader. Missing cells are empty.
// With Detail::Short the widest columns of text are cut, with "…" at the end, or at the beginning of a path.
std::string formatTable(const std::vector<std::vector<std::string>>& rows, Detail detail = Detail::Short);

// "label  value" lines, labels padded. With Detail::Short the last cell of a row is wrapped at spaces, and
// continues below itself.
std::string formatFields(const std::vector<std::vector<std::string>>& rows, Detail detail = Detail::Short);

// The text with line breaks instead of spaces, so that its lines have at most kTableWidth characters as far
// as its words do. Line breaks that it has stay; lines of its own that begin with a space are left as they
// are.
std::string wrapped(const std::string& text);

// A shader for people: its ID, and its name, cut behind whole words where it is long: "12
// Clearcoat_BaseTex…". The ID alone names the shader: `glint inspect --disassemble` takes it, and `glint
// explain` tells its features.
std::string shaderTitle(std::uint64_t id, std::string_view name, Detail detail);

// Returns "812 B", "12.3 KiB" or "4.56 MiB".
std::string formatBytes(std::uint64_t bytes);
// "1.234 ms"
std::string formatMilliseconds(double milliseconds);
// Returns "a, b, c", or "-" for an empty list.
std::string join(const std::vector<std::string>& words);

}  // namespace glint
