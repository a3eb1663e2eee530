// Tests the help of options whose wording has misled users before.
#include "cli/command.h"

#include <sstream>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

class Help : public CommandTest {
protected:
    // Returns the help with one blank in place of every run of blanks and line breaks, so that lines may
    // break anywhere.
    std::string help(const std::string& command) const {
        std::istringstream words(run({command, "--help-all"}).out);
        std::string text;
        for (std::string word; words >> word;) {
            text += word + " ";
        }
        return text;
    }
};

struct Words {
    std::string command;
    std::string text;
};

TEST_F(Help, SaysWhatOptionsTakeAndNeed) {
    const std::vector<Words> expected{
        {"compile", "--strategy auto|all|LIST how hits can be shaded, separated by commas;"},
        {"compile",
         "--tracer all|LIST what traces rays, separated by commas; strategies of hit shaders always have "
         "their own; ray-query: "
         "compute shaders trace; ray-pipeline: ray generation shaders trace, for devices without ray "
         "queries"},
        {"compile", "data of a hit that strategies which sort hits keep between passes;"},
        {"compile",
         "limit of shaders: --merge auto and profile stay within it, the others fail above it; 0: no limit, "
         "or 32 for auto and profile"},
        {"compile", "if the lock file would change (needs --lock)"},
        {"compile", "(needs --lock, excludes --locked)"},
        {"compile", "-Wno-ID"},
        {"render", "how strategies that sort hits by shader do so; auto: by the device and the number"},
        {"render", "any message is an error; also checks the order of hits"},
        {"render", "1 to 16384 each way, 67108864 in all"},
        {"render", "needs --environment (-360 to 360, default: 0)"},
        {"render", "needs --environment (0 to 1e9, default: 1)"},
    };
    for (const Words& words : expected) {
        EXPECT_NE(help(words.command).find(words.text), std::string::npos) << words.text << "\n"
                                                                           << help(words.command);
    }
}

TEST_F(Help, HasNoTraceOfTheParserInItsOptions) {
    for (const char* command :
         {"compile", "explain", "inspect", "diff", "lint", "render", "compare", "completion"}) {
        const std::string text = help(command);
        EXPECT_EQ(text.find("Needs:"), std::string::npos) << command;
        EXPECT_EQ(text.find("Excludes:"), std::string::npos) << command;
        EXPECT_EQ(text.find(" ... "), std::string::npos) << command;
    }
}

// Continuation lines start at column 32. Texts are written for terminals with 92 columns.
TEST_F(Help, LinesFitATerminal) {
    constexpr std::size_t kColumns = 92;
    for (const char* command :
         {"compile", "explain", "inspect", "diff", "lint", "render", "compare", "completion"}) {
        std::istringstream lines(run({command, "--help"}).out + run({command, "--help-all"}).out);
        for (std::string line; std::getline(lines, line);) {
            EXPECT_LE(line.size(), kColumns) << command << ": " << line;
        }
    }
}

}  // namespace
}  // namespace glint::testing
