#include "emit/glsl/tokens.h"

#include <algorithm>

namespace glint::compiler {

namespace {

constexpr std::string_view kTextBlanks = " \t\r";

}  // namespace

std::string_view trim(std::string_view text) {
    const std::size_t first = text.find_first_not_of(kTextBlanks);
    if (first == std::string_view::npos) {
        return {};
    }
    return text.substr(first, text.find_last_not_of(kTextBlanks) - first + 1);
}

std::vector<std::string_view> splitLines(std::string_view text) {
    std::vector<std::string_view> lines;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        std::string_view line = text.substr(0, end);
        if (!line.empty() && line.back() == '\r') {
            line.remove_suffix(1);
        }
        lines.push_back(line);
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return lines;
}

Directive parseDirective(std::string_view line) {
    line = trim(line);
    if (line.empty() || line.front() != '#') {
        return {};
    }
    line = trim(line.substr(1));
    const std::size_t end = std::min(line.find_first_of(" \t\"<"), line.size());
    std::string_view argument = line.substr(end);
    argument = trim(argument.substr(0, std::min(argument.find("//"), argument.size())));
    return {line.substr(0, end), argument};
}

std::size_t commentLength(std::string_view text) {
    if (text.starts_with("//")) {
        return std::min(text.find('\n'), text.size());
    }
    if (text.starts_with("/*")) {
        const std::size_t end = text.find("*/", 2);
        return end == std::string_view::npos ? text.size() : end + 2;
    }
    return 0;
}

std::vector<std::string_view> identifiersOf(std::string_view line) {
    std::vector<std::string_view> words;
    forEachPiece(line, [&](std::string_view piece) {
        if (startsWord(piece.front())) {
            words.push_back(piece);
        }
    });
    return words;
}

}  // namespace glint::compiler
