#include "base/text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

namespace glint::base {

std::string join(const std::vector<std::string>& words) {
    return words.empty() ? "-" : fmt::format("{}", fmt::join(words, ", "));
}

std::string firstOf(const std::vector<std::string>& texts, std::size_t most, std::string_view separator,
                    std::string_view last) {
    const std::size_t shown = std::min(texts.size(), most);
    const auto end = texts.begin() + static_cast<std::ptrdiff_t>(shown);
    const std::string text = fmt::format("{}", fmt::join(texts.begin(), end, separator));
    return texts.size() > shown ? fmt::format("{}{}{} more", text, last, texts.size() - shown) : text;
}

std::string someOf(const std::vector<std::string>& texts, std::size_t most) {
    return firstOf(texts, most, "; ", "; and ");
}

std::string counted(std::size_t count, std::string_view noun) {
    return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string shellQuoted(std::string_view text) {
    std::string result = "'";
    for (const char c : text) {
        result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    }
    return result + "'";
}

std::string shellWords(const std::vector<std::string>& words) {
    constexpr std::string_view kPlain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./,:=+@%";
    std::string text;
    for (const std::string& word : words) {
        text += text.empty() ? "" : " ";
        if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) {
            text += word;
            continue;
        }
        text += shellQuoted(word);
    }
    return text;
}

int editDistance(std::string_view a, std::string_view b) {
    // Row i holds the distances of the first i characters of `a` to every beginning of `b`.
    std::vector<std::vector<int>> rows(a.size() + 1, std::vector<int>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i) {
        for (std::size_t j = 0; j <= b.size(); ++j) {
            if (i == 0 || j == 0) {
                rows[i][j] = static_cast<int>(i + j);
                continue;
            }
            const int substitution = a[i - 1] == b[j - 1] ? 0 : 1;
            rows[i][j] =
                std::min({rows[i - 1][j] + 1, rows[i][j - 1] + 1, rows[i - 1][j - 1] + substitution});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                rows[i][j] = std::min(rows[i][j], rows[i - 2][j - 2] + 1);
            }
        }
    }
    return rows[a.size()][b.size()];
}

namespace {

// Handles ASCII only, because identifiers and options are ASCII.
char lower(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

// Returns the first candidate that contains `word`, ignoring case; empty if there is none.
std::string containing(std::string_view word, std::span<const std::string> candidates) {
    // Shorter words are contained in too many candidates to be a hint.
    constexpr std::size_t kShortestPart = 3;
    if (word.size() < kShortestPart) {
        return {};
    }
    const auto found = std::ranges::find_if(candidates, [&](const std::string& candidate) {
        return std::search(candidate.begin(), candidate.end(), word.begin(), word.end(),
                           [](char a, char b) { return lower(a) == lower(b); }) != candidate.end();
    });
    return found == candidates.end() ? std::string() : *found;
}

}  // namespace

std::string nearest(std::string_view word, std::span<const std::string> candidates) {
    // Nobody mistypes a name this long by three edits. It bounds the table of editDistance().
    constexpr std::size_t kLongestWord = 64;
    if (word.size() > kLongestWord) {
        return {};
    }
    int best = std::clamp(static_cast<int>(word.size()) / 3, 1, 3) + 1;
    std::string found;
    for (const std::string& candidate : candidates) {
        if (candidate.size() > kLongestWord) {
            continue;
        }
        const int distance = editDistance(word, candidate);
        if (distance < best) {
            best = distance;
            found = candidate;
        }
    }
    return found.empty() ? containing(word, candidates) : found;
}

std::string suggestion(std::string_view word, std::span<const std::string> candidates) {
    const std::string found = nearest(word, candidates);
    return found.empty() ? std::string() : "; did you mean " + found + "?";
}

std::string enumeration(std::span<const std::string> candidates) {
    constexpr std::size_t kShown = 8;
    std::string text;
    std::size_t count = 0;
    for (const std::string& candidate : candidates) {
        if (!candidate.empty() && ++count <= kShown) {
            const char* const quote = candidate.find(',') == std::string::npos ? "" : "\"";
            text += (count > 1 ? ", " : "") + (quote + candidate) + quote;
        }
    }
    if (count == 0) {
        return {};
    }
    return " (it has " + text + (count > kShown ? " and " + std::to_string(count - kShown) + " more)" : ")");
}

}  // namespace glint::base
