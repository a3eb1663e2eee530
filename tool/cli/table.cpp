#include "cli/table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <utility>

namespace glint::cli {

namespace {

// Counts characters, not bytes, so that names in UTF-8 line up.
std::size_t displayWidth(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(
        text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

// Returns whether the cell is a title such as "12 Clearcoat…", which shaderTitle() makes.
bool isTitle(const std::string& cell) {
    const std::size_t end = cell.find_first_not_of("0123456789");
    return end != std::string::npos && cell[end] == ' ' && end + 1 < cell.size() &&
           std::isupper(static_cast<unsigned char>(cell[end + 1])) != 0;
}

bool looksNumeric(const std::string& cell) {
    if (isTitle(cell)) {
        return false;
    }
    return cell == "-" || (!cell.empty() && std::isdigit(static_cast<unsigned char>(cell[0])) != 0);
}

constexpr std::string_view kEllipsis = "…";

// These return the first or last `count` characters of a text. They cut between code points, so that UTF-8
// stays valid.
std::string firstCharacters(const std::string& text, std::size_t count) {
    std::size_t end = 0;
    for (std::size_t seen = 0; end < text.size(); ++end) {
        if ((static_cast<unsigned char>(text[end]) & 0xC0U) != 0x80U && ++seen > count) {
            break;
        }
    }
    return text.substr(0, end);
}

std::string lastCharacters(const std::string& text, std::size_t count) {
    return text.substr(firstCharacters(text, displayWidth(text) - count).size());
}

// Cuts a path at its beginning, because its end identifies the file, and other texts at their end.
std::string cut(const std::string& text, std::size_t width) {
    if (displayWidth(text) <= width) {
        return text;
    }
    const std::string ellipsis(kEllipsis);
    return text.find('/') == std::string::npos ? firstCharacters(text, width - 1) + ellipsis
                                               : ellipsis + lastCharacters(text, width - 1);
}

struct Column {
    std::size_t width = 0;
    std::size_t head = 0;  // width of the cell in the first row
    bool numeric = true;
};

std::vector<Column> columnsOf(const Rows& rows, bool alignNumbers) {
    std::vector<Column> columns;
    for (std::size_t r = 0; r < rows.size(); ++r) {
        columns.resize(std::max(columns.size(), rows[r].size()));
        for (std::size_t c = 0; c < rows[r].size(); ++c) {
            columns[c].width = std::max(columns[c].width, displayWidth(rows[r][c]));
            columns[c].head = r == 0 ? columns[c].width : columns[c].head;
            columns[c].numeric = columns[c].numeric && alignNumbers && (r == 0 || looksNumeric(rows[r][c]));
        }
    }
    return columns;
}

constexpr std::size_t kGap = 2;

std::size_t widthOf(const std::vector<Column>& columns) {
    std::size_t width = columns.empty() ? 0 : kGap * (columns.size() - 1);
    for (const Column& column : columns) {
        width += column.width;
    }
    return width;
}

// Narrows the widest columns of text until the table has this width, or until each has `least` or the width
// of its head.
void narrow(std::vector<Column>& columns, std::size_t width, std::size_t least) {
    while (widthOf(columns) > width) {
        Column* widest = nullptr;
        for (Column& column : columns) {
            const bool canShrink = !column.numeric && column.width > std::max(least, column.head);
            if (canShrink && (widest == nullptr || column.width > widest->width)) {
                widest = &column;
            }
        }
        if (widest == nullptr) {
            return;
        }
        --widest->width;
    }
}

std::string lineOf(const std::vector<std::string>& row, const std::vector<Column>& columns) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c) {
        const std::string cell = cut(row[c], columns[c].width);
        const std::string padding(columns[c].width - displayWidth(cell), ' ');
        line += c == 0 ? "" : std::string(kGap, ' ');
        line += columns[c].numeric ? padding + cell : cell + padding;
    }
    line.erase(line.find_last_not_of(' ') + 1);
    return line + "\n";
}

// Breaks a text at spaces into lines of at most `width` characters. A longer word has a line of its own.
std::vector<std::string> linesOf(const std::string& text, std::size_t width) {
    std::vector<std::string> lines{""};
    std::size_t begin = 0;
    while (begin <= text.size()) {
        const std::size_t end = std::min(text.find(' ', begin), text.size());
        const std::string word = text.substr(begin, end - begin);
        if (begin > 0 && displayWidth(lines.back()) + 1 + displayWidth(word) > width) {
            lines.push_back(word);
        } else {
            lines.back() += (begin > 0 ? " " : "") + word;
        }
        begin = end + 1;
    }
    return lines;
}

}  // namespace

std::string formatTable(const Rows& rows, Detail detail) {
    std::vector<Column> columns = columnsOf(rows, true);
    if (detail == Detail::Short) {
        // Cells rarely need more characters than this to be told apart. Before they get shorter, the table
        // becomes wider.
        constexpr std::size_t kReadable = 28;
        constexpr std::size_t kLeast = 12;
        narrow(columns, kTableWidth, kReadable);
        narrow(columns, kMostTableWidth, kLeast);
    }
    std::string text;
    for (const std::vector<std::string>& row : rows) {
        text += lineOf(row, columns);
    }
    return text;
}

std::string formatMarkdown(const Rows& rows) {
    const std::vector<Column> columns = columnsOf(rows, false);
    std::string text;
    std::string line;
    for (const std::vector<std::string>& row : rows) {
        for (std::size_t c = 0; c < row.size(); ++c) {
            const std::size_t width = std::max<std::size_t>(columns[c].width, 3);
            text += fmt::format("| {}{} ", row[c], std::string(width - displayWidth(row[c]), ' '));
            line += &row == &rows.front() ? fmt::format("|{}", std::string(width + 2, '-')) : "";
        }
        text += "|\n" + (line.empty() ? line : std::exchange(line, {}) + "|\n");
    }
    return text;
}

std::string formatFields(const Rows& rows, Detail detail) {
    // A value wraps no narrower than this, however wide the labels are.
    constexpr std::size_t kLeast = 20;
    const std::vector<Column> columns = columnsOf(rows, false);
    std::string text;
    for (const std::vector<std::string>& row : rows) {
        std::size_t begin = 0;
        for (std::size_t c = 0; c + 1 < row.size(); ++c) {
            begin += columns[c].width + kGap;
        }
        const bool wraps = detail == Detail::Short && row.size() > 1;
        const std::size_t room = std::max(kTableWidth - std::min(begin, kTableWidth), kLeast);
        const std::vector<std::string> lines =
            wraps ? linesOf(row.back(), room) : std::vector<std::string>{row.empty() ? "" : row.back()};
        std::vector<std::string> cells = row;
        for (const std::string& line : lines) {
            std::string start;
            for (std::size_t c = 0; c + 1 < cells.size(); ++c) {
                start += cells[c] + std::string(columns[c].width - displayWidth(cells[c]) + kGap, ' ');
                cells[c].clear();
            }
            start += line;
            start.erase(start.find_last_not_of(' ') + 1);
            text += start + "\n";
        }
    }
    return text;
}

std::string wrapped(const std::string& text, std::size_t width) {
    std::string result;
    std::size_t begin = 0;
    while (begin < text.size()) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        const std::string line = text.substr(begin, end - begin);
        const bool isSet = line.starts_with(' ');
        result += isSet ? line : fmt::format("{}", fmt::join(linesOf(line, width), "\n"));
        result += end < text.size() ? "\n" : "";
        begin = end + 1;
    }
    return result;
}

std::string shaderTitle(std::uint64_t id, std::string_view name, Detail detail) {
    constexpr std::size_t kMostName = 28;
    if (detail == Detail::Whole || name.size() <= kMostName) {
        return fmt::format("{} {}", id, name);
    }
    const std::string_view start = name.substr(0, kMostName);
    const std::size_t word = start.rfind('_');
    return fmt::format("{} {}{}", id,
                       word == std::string_view::npos || word == 0 ? start : start.substr(0, word),
                       kEllipsis);
}

std::string formatMilliseconds(double milliseconds) {
    return fmt::format("{:.3f} ms", milliseconds);
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

}  // namespace glint::cli
