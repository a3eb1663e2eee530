#include "cli/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace glint {

namespace {

using Rows = std::vector<std::vector<std::string>>;

// Counts characters, not bytes, so that names in UTF-8 line up.
std::size_t displayWidth(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(
        text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

bool looksNumeric(const std::string& cell) {
    return cell == "-" || (!cell.empty() && std::isdigit(static_cast<unsigned char>(cell[0])) != 0);
}

struct Column {
    std::size_t width = 0;
    bool numeric = true;
};

std::vector<Column> measure(const Rows& rows, bool alignNumbers) {
    std::vector<Column> columns;
    for (std::size_t r = 0; r < rows.size(); ++r) {
        columns.resize(std::max(columns.size(), rows[r].size()));
        for (std::size_t c = 0; c < rows[r].size(); ++c) {
            columns[c].width = std::max(columns[c].width, displayWidth(rows[r][c]));
            columns[c].numeric = columns[c].numeric && alignNumbers && (r == 0 || looksNumeric(rows[r][c]));
        }
    }
    return columns;
}

std::string format(const Rows& rows, bool alignNumbers) {
    const std::vector<Column> columns = measure(rows, alignNumbers);
    std::string text;
    for (const std::vector<std::string>& row : rows) {
        std::string line;
        for (std::size_t c = 0; c < row.size(); ++c) {
            const std::string padding(columns[c].width - displayWidth(row[c]), ' ');
            line += c == 0 ? "" : "  ";
            line += columns[c].numeric ? padding + row[c] : row[c] + padding;
        }
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + "\n";
    }
    return text;
}

}  // namespace

std::string formatTable(const Rows& rows) {
    return format(rows, true);
}

std::string formatFields(const Rows& rows) {
    return format(rows, false);
}

std::string formatBytes(std::uint64_t bytes) {
    constexpr double kKibi = 1024.0;
    const auto value = static_cast<double>(bytes);
    if (value < kKibi) {
        return fmt::format("{} B", bytes);
    }
    if (value < kKibi * kKibi) {
        return fmt::format("{:.1f} KiB", value / kKibi);
    }
    return fmt::format("{:.2f} MiB", value / (kKibi * kKibi));
}

std::string join(const std::vector<std::string>& words) {
    return words.empty() ? "-" : fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace glint
