// Compares docs/cli.md with the program: every option of every command must be in its section.
#include "cli/command.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

class DocumentedOptions : public CommandTest {
protected:
    // Returns the long options of a command, as its help lists them, and "-W", which has no long form.
    std::set<std::string> optionsOf(const std::string& command) const {
        std::set<std::string> options;
        std::istringstream lines(run({command, "--help-all"}).out);
        for (std::string line; std::getline(lines, line);) {
            if (!line.starts_with("  -")) {
                continue;
            }
            const std::string names = line.substr(2, line.find(' ', 2) - 2);
            const std::size_t begin = names.find("--");
            std::string name = begin == std::string::npos ? names : names.substr(begin);
            const std::size_t no = name.find("[no-]");
            options.insert(no == std::string::npos ? name : name.erase(no, 5));
        }
        options.erase("--help");
        options.erase("--help-all");
        return options;
    }
};

const std::vector<std::string> kOptionsDocumentedCommands{
    "compile", "compile-module", "explain", "inspect",         "diff",       "lint", "render",
    "view",    "bench",          "compare", "check-materials", "completion", "help"};

// Returns the text below each heading of the second level.
std::map<std::string, std::string> sectionsOf(const std::string& document) {
    std::map<std::string, std::string> sections;
    std::istringstream lines(document);
    std::string heading;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("## ")) {
            heading = line.substr(3);
        } else {
            sections[heading] += line + "\n";
        }
    }
    return sections;
}

std::vector<std::string> cellsOf(const std::string& row) {
    std::vector<std::string> cells;
    for (std::size_t begin = 2; begin < row.size();) {
        const std::size_t end = std::min(row.find(" |", begin), row.size());
        cells.push_back(row.substr(begin, end - begin));
        begin = end + 3;
    }
    return cells;
}

// Returns for each option the second cells of its rows, "| `-o`, `--output` | second | …". A row with an
// empty first cell belongs to the option of the row above.
std::map<std::string, std::string> rowsOf(const std::string& section) {
    std::map<std::string, std::string> rows;
    std::vector<std::string> options;
    std::istringstream lines(section);
    for (std::string line; std::getline(lines, line);) {
        const bool continues = line.starts_with("| | ");
        if (!continues) {
            options.clear();
        }
        if (!continues && !line.starts_with("| `-")) {
            continue;
        }
        const std::vector<std::string> cells = cellsOf(continues ? "| " + line.substr(1) : line);
        for (std::size_t at = cells[0].find("`-"); at != std::string::npos;
             at = cells[0].find("`-", at + 1)) {
            options.push_back(cells[0].substr(at + 1, cells[0].find('`', at + 1) - at - 1));
        }
        for (const std::string& option : options) {
            rows[option] += cells[1] + "; ";
        }
    }
    return rows;
}

TEST_F(DocumentedOptions, AreThoseOfTheProgram) {
    std::map<std::string, std::string> sections = sectionsOf(readText(GLINT_SOURCE_DIR "/docs/cli.md"));
    // The rows of these sections say which commands have the option.
    const std::map<std::string, std::string> shared =
        rowsOf(sections["What shaders are made"] + sections["Settings"]);
    const std::map<std::string, std::string> reporting = rowsOf(sections["What is reported"]);
    ASSERT_FALSE(shared.empty());
    ASSERT_FALSE(reporting.empty());
    for (const std::string& command : kOptionsDocumentedCommands) {
        ASSERT_TRUE(sections.contains("glint " + command)) << command;
        std::set<std::string> documented;
        for (const auto& [option, what] : rowsOf(sections["glint " + command])) {
            documented.insert(option);
        }
        for (const auto& [option, commands] : shared) {
            if (commands.find("`" + command + "`") != std::string::npos) {
                documented.insert(option);
            }
        }
        if (command != "completion" && command != "help") {
            for (const auto& [option, what] : reporting) {
                documented.insert(option);
            }
        }
        // Short names stand beside long ones.
        std::erase_if(documented, [](const std::string& name) { return name.size() == 2 && name != "-W"; });
        EXPECT_EQ(documented, optionsOf(command)) << command;
    }
}

TEST_F(DocumentedOptions, CommandsAreThoseOfTheProgram) {
    std::set<std::string> commands;
    std::istringstream lines(run({"--help"}).out);
    bool within = false;
    for (std::string line; std::getline(lines, line);) {
        within = line == "Commands:" || (within && !line.empty());
        if (within && line.starts_with("  ") && line[2] != ' ') {
            commands.insert(line.substr(2, line.find(' ', 2) - 2));
        }
    }
    EXPECT_EQ(commands,
              std::set<std::string>(kOptionsDocumentedCommands.begin(), kOptionsDocumentedCommands.end()));
}

// Every document must be reachable through the list in README.md.
TEST(Documents, AreListedInTheReadme) {
    const std::string readme = readText(GLINT_SOURCE_DIR "/README.md");
    const std::size_t begin = readme.find("## Documents");
    ASSERT_NE(begin, std::string::npos);
    for (const auto& entry : std::filesystem::directory_iterator(GLINT_SOURCE_DIR "/docs")) {
        const std::string name = entry.path().filename().string();
        if (name.ends_with(".md")) {
            EXPECT_NE(readme.find("(docs/" + name + ")", begin), std::string::npos) << name;
        }
    }
}

}  // namespace
}  // namespace glint::testing
