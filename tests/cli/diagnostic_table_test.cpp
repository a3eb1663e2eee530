// Compares the table of diagnostics with the sources that make them, and with its document.
#include "cli/console.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glint {
namespace {

namespace fs = std::filesystem;

std::string readText(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

// Removes comments, because they only mention ids.
std::string withoutComments(const std::string& source) {
    std::string text;
    std::istringstream lines(source);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t comment = line.find("// ");
        // A // within a literal is part of an address, and no blank follows it.
        text += line.substr(0, comment) + "\n";
    }
    return text;
}

// Returns all sources that make diagnostics, except the table itself.
const std::vector<std::string>& sources() {
    static const std::vector<std::string> kSources = [] {
        std::vector<std::string> texts;
        for (const char* folder : {"tool", "runtime", "verify"}) {
            for (const auto& entry : fs::recursive_directory_iterator(fs::path(GLINT_SOURCE_DIR) / folder)) {
                const std::string extension = entry.path().extension().string();
                const bool isTable = entry.path().stem() == "diagnostic_table";
                if (!isTable && (extension == ".cpp" || extension == ".h")) {
                    texts.push_back(withoutComments(readText(entry.path())));
                }
            }
        }
        return texts;
    }();
    return kSources;
}

// The code that makes a diagnostic, up to the literal of its id, and the severity that it gives.
struct Maker {
    std::string_view code;
    std::uint8_t severity;
    bool first = true;  // whether the id is the first argument, else it is the first literal
};

constexpr Maker kMakers[] = {
    {"makeError(", cli::kError},
    {"error(", cli::kError},
    {"errorAt(", cli::kError},
    {"SchemaError{", cli::kError},
    {"checkBudget(", cli::kError, false},
    {"makeWarning(", cli::kWarning},
    {"warn(", cli::kWarning},
    {"note(", cli::kNote},
    {"Severity::Error,", cli::kError},
    {"Severity::Warning,", cli::kWarning},
    {"Severity::Note,", cli::kNote},
};

// Returns the id in a literal that starts at `at`, or an empty one.
std::string idAt(const std::string& text, std::size_t at) {
    const std::size_t end = at < text.size() && text[at] == '"' ? text.find('"', at + 1) : std::string::npos;
    std::string id = end == std::string::npos ? "" : text.substr(at + 1, end - at - 1);
    const bool isId =
        id.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") == std::string::npos && id > "a";
    return isId ? id : "";
}

// Returns the ids in literals at the places above, with their severities.
const std::map<std::string, std::uint8_t>& madeIds() {
    static const std::map<std::string, std::uint8_t> kIds = [] {
        std::map<std::string, std::uint8_t> ids;
        for (const Maker& maker : kMakers) {
            for (const std::string& text : sources()) {
                for (std::size_t at = text.find(maker.code); at != std::string::npos;
                     at = text.find(maker.code, at + 1)) {
                    const bool isWord =
                        at == 0 ||
                        (std::isalnum(static_cast<unsigned char>(text[at - 1])) == 0 && text[at - 1] != '_');
                    const std::size_t behind = at + maker.code.size();
                    const std::string id = idAt(
                        text, maker.first ? text.find_first_not_of(" \n", behind) : text.find('"', behind));
                    if (isWord && !id.empty()) {
                        ids[id] |= maker.severity;
                    }
                }
            }
        }
        return ids;
    }();
    return kIds;
}

TEST(DiagnosticTable, FindsSeverities) {
    for (const std::uint8_t severity : {cli::kNote, cli::kWarning, cli::kError}) {
        for (const std::string& id : cli::diagnosticIds(severity)) {
            EXPECT_NE(cli::severitiesOf(id) & severity, 0) << id;
        }
    }
    EXPECT_EQ(cli::severitiesOf("no-such-id"), 0);
    EXPECT_EQ(cli::severitiesOf(""), 0);
}

TEST(DiagnosticTable, HasEveryIdThatTheSourcesMake) {
    // With fewer, the patterns would no longer find them.
    EXPECT_GT(madeIds().size(), 150U);
    for (const auto& [id, severities] : madeIds()) {
        const std::uint8_t known = cli::severitiesOf(id);
        EXPECT_NE(known, 0) << id << " is made, and not in the table";
        EXPECT_TRUE(known == 0 || (severities & ~known) == 0)
            << id << " is made with a severity that the table does not have";
    }
}

// If an id reaches its diagnostic indirectly, there must at least be a literal for it somewhere. Only an id
// with a hyphen can be recognised as one.
TEST(DiagnosticTable, HasNoIdThatNothingMakes) {
    for (const std::string& id : cli::diagnosticIds()) {
        const bool isLiteral =
            id.find('-') != std::string::npos && std::ranges::any_of(sources(), [&](const std::string& text) {
                return text.find('"' + id + '"') != std::string::npos;
            });
        EXPECT_TRUE(isLiteral || madeIds().contains(id)) << id;
    }
}

std::string severityNames(std::uint8_t severities) {
    std::string text;
    for (const auto& [bit, name] :
         {std::pair(cli::kError, "error"), {cli::kWarning, "warning"}, {cli::kNote, "note"}}) {
        if ((severities & bit) != 0) {
            text += (text.empty() ? "" : ", ") + std::string(name);
        }
    }
    return text;
}

TEST(DiagnosticTable, IsThatOfItsDocument) {
    const std::string document = readText(fs::path(GLINT_SOURCE_DIR) / "docs" / "diagnostics.md");
    const std::string head = "| id | severity | meaning |\n|---|---|---|\n";
    const std::size_t begin = document.find(head);
    ASSERT_NE(begin, std::string::npos);
    std::istringstream rows(document.substr(begin + head.size()));
    for (const std::string& id : cli::diagnosticIds()) {
        std::string row;
        std::getline(rows, row);
        // The meaning is one sentence or several.
        const std::string start = "| `" + id + "` | " + severityNames(cli::severitiesOf(id)) + " | ";
        EXPECT_TRUE(row.starts_with(start) && row.ends_with(". |")) << row << "\nshould be\n" << start;
    }
    std::string after;
    EXPECT_FALSE(std::getline(rows, after) && !after.empty()) << after << " is not in the table";
}

}  // namespace
}  // namespace glint
