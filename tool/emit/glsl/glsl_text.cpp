#include "emit/glsl/glsl_text.h"

#include <algorithm>
#include <cctype>

namespace glint {

namespace {

constexpr std::string_view kTextBlanks = " \t\r";

bool isWord(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

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

std::vector<std::string_view> identifiersOf(std::string_view line) {
    line = line.substr(0, std::min(line.find("//"), line.size()));
    std::vector<std::string_view> words;
    std::size_t begin = 0;
    while (begin < line.size()) {
        if (!isWord(line[begin])) {
            ++begin;
            continue;
        }
        std::size_t end = begin;
        while (end < line.size() && isWord(line[end])) {
            ++end;
        }
        if (std::isdigit(static_cast<unsigned char>(line[begin])) == 0) {
            words.push_back(line.substr(begin, end - begin));
        }
        begin = end;
    }
    return words;
}

}  // namespace glint
