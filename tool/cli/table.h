// Formats tables for people. Programs read --json, because cells here are cut and wrapped to fit a terminal.
#pragma once

#include "base/text.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace glint::cli {

// How much of long cells is shown.
enum class Detail : std::uint8_t {
    Short,  // as much as fits into a terminal
    Whole,  // everything, with --verbose
};

// Cells by row.
using Rows = std::vector<std::vector<std::string>>;

// The length of a line with Detail::Short, in characters. Tables of many columns may take up to
// kMostTableWidth, and more only if their numbers alone do.
inline constexpr std::size_t kTableWidth = 80;
inline constexpr std::size_t kMostTableWidth = 100;

// Formats columns that are padded to the widest cell and two spaces apart. A column is right-aligned if every
// cell below the first row begins with a digit or is "-", and none is the title of a shader. Missing cells
// are empty. With Detail::Short the widest columns of text are cut, with "…" at the end, or at the beginning
// of a path.
std::string formatTable(const Rows& rows, Detail detail = Detail::Short);

// Formats the same as a table in Markdown, with nothing cut.
std::string formatMarkdown(const Rows& rows);

// Formats lines of "label  value" with padded labels. With Detail::Short the last cell of a row is wrapped at
// spaces, and continues below itself.
std::string formatFields(const Rows& rows, Detail detail = Detail::Short);

// Returns the text with line breaks instead of some spaces, so that its lines have at most `width`
// characters unless a word is longer. Existing line breaks stay, and lines that begin with a space are not
// changed.
std::string wrapped(const std::string& text, std::size_t width = kTableWidth);

// Names a shader for people: its ID, and its name, which is cut after a whole word if it is long: "12
// Clearcoat_BaseTex…". The ID alone identifies the shader: `glint inspect --disassemble` accepts it, and
// `glint explain` lists its features.
std::string shaderTitle(std::uint64_t id, std::string_view name, Detail detail);

// Returns "812 B", "12.3 KiB" or "4.56 MiB".
std::string formatBytes(std::uint64_t bytes);
// Returns "1.234 ms".
std::string formatMilliseconds(double milliseconds);

}  // namespace glint::cli
