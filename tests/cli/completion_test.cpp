// Tests the scripts of `glint completion` in the installed shells.
#include "cli/command.h"
#include "cli/shell.h"

#include <algorithm>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

const std::vector<std::string> kCompletionCommands{"compile", "explain", "inspect", "diff",      "lint",
                                                   "render",  "bench",   "compare", "completion"};

class Completion : public CommandTest {
protected:
    void SetUp() override {
        CommandTest::SetUp();
        for (const char* shell : {"bash", "zsh", "fish"}) {
            const Outcome outcome = must(run({"completion", shell}));
            writeText(path(std::string("glint.") + shell), outcome.out);
        }
    }

    // Runs `script` with a shell in the test's folder. Both output streams are in Outcome::out.
    Outcome shell(const std::string& name, const std::string& script) const {
        writeText(path("script"), script);
        return runShell(path(""), name + " ./script");
    }

    // Returns what bash offers for the last of these words, as it splits them.
    std::string bash(const std::vector<std::string>& words) const {
        std::string script = "source ./glint.bash\nCOMP_WORDS=(glint";
        for (const std::string& word : words) {
            script += " '" + word + "'";
        }
        script += ")\nCOMP_CWORD=" + std::to_string(words.size()) + "\n_glint\necho \"${COMPREPLY[*]}\"\n";
        const Outcome outcome = must(shell("bash", script));
        return outcome.out.substr(0, outcome.out.find('\n'));
    }
};

std::vector<std::string> words(const std::string& line) {
    std::istringstream stream(line);
    return {std::istream_iterator<std::string>(stream), {}};
}

// Returns the long options that the help of a command lists, in its order.
std::vector<std::string> optionsOf(const std::string& help) {
    std::vector<std::string> options;
    std::istringstream lines(help);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t begin = line.starts_with("  -") ? line.find("--") : std::string::npos;
        if (begin < 6) {
            std::string name = line.substr(begin, line.find(' ', begin) - begin);
            const std::size_t no = name.find("[no-]");
            options.push_back(no == std::string::npos ? name : name.erase(no, 5));
        }
    }
    return options;
}

TEST_F(Completion, BashOffersCommands) {
    EXPECT_EQ(bash({"comp"}), "compile compile-module compare completion");
    EXPECT_EQ(bash({"--v"}), "--version");
    for (const std::string& command : kCompletionCommands) {
        EXPECT_TRUE(std::ranges::count(words(bash({""})), command) == 1) << command;
    }
}

TEST_F(Completion, BashOffersEveryOptionOfEveryCommand) {
    for (const std::string& command : kCompletionCommands) {
        const std::vector<std::string> options = optionsOf(run({command, "--help-all"}).out);
        EXPECT_FALSE(options.empty()) << command;
        const std::vector<std::string> offered = words(bash({command, "--"}));
        for (const std::string& option : options) {
            EXPECT_TRUE(std::ranges::count(offered, option) == 1) << command << " " << option;
        }
    }
}

TEST_F(Completion, BashOffersValues) {
    EXPECT_EQ(bash({"compile", "--shadows", ""}), "auto inline deferred");
    EXPECT_EQ(bash({"compile", "--shadows", "=", "d"}), "deferred");
    EXPECT_EQ(bash({"compile", "--shadows", "="}), "auto inline deferred");
    EXPECT_EQ(bash({"compile", "--strategy", "uber,vis"}), "uber,visibility");
    EXPECT_EQ(bash({"compile", "--merge", "pro"}), "profile");
    EXPECT_EQ(bash({"compile", "--jobs", ""}), "");
    EXPECT_EQ(bash({"completion", "z"}), "zsh");
}

TEST_F(Completion, BashOffersFilesAndFolders) {
    writeText(path("scene one.gltf"), "{}");
    std::filesystem::create_directories(path("scenes"));
    const std::string offered = bash({"compile", "sce"});  // in no particular order
    EXPECT_TRUE(offered == "scene one.gltf scenes" || offered == "scenes scene one.gltf") << offered;
    EXPECT_EQ(bash({"inspect", "sce"}), "scenes");
    EXPECT_EQ(bash({"render", "a.gltf", "--package", "sce"}), "scenes");
}

TEST_F(Completion, BashScriptIsCleanAndComplete) {
    EXPECT_EQ(shell("bash", "set -eu\nsource ./glint.bash\ncomplete -p glint").out,
              "complete -F _glint glint\n");
}

TEST_F(Completion, ZshTakesItsScript) {
    if (!hasProgram("zsh")) {
        GTEST_SKIP() << "zsh is not installed";
    }
    EXPECT_EQ(shell("zsh -n", readText(path("glint.zsh"))).out, "");
    const Outcome registered =
        shell("zsh -f",
              "autoload -Uz compinit && compinit -u -D\nsource ./glint.zsh\nprint -r -- $_comps[glint]\n");
    EXPECT_EQ(registered.out, "_glint\n");
}

TEST_F(Completion, FishOffersCommandsOptionsAndValues) {
    if (!hasProgram("fish")) {
        GTEST_SKIP() << "fish is not installed";
    }
    const auto offered = [&](const std::string& line) {
        return shell("fish --no-config",
                     "source ./glint.fish\ncomplete -C '" + line + "' | string replace -r '\\t.*' ''\n")
            .out;
    };
    EXPECT_EQ(offered("glint rend"), "render\n");
    EXPECT_EQ(offered("glint compile --shad"), "--shadows\n");
    EXPECT_EQ(offered("glint compile --shadows d"), "deferred\n");
    EXPECT_EQ(offered("glint completion f"), "fish\n");
}

TEST_F(Completion, UnknownShellsAreRefused) {
    const Outcome outcome = run({"completion", "bahs"});
    EXPECT_EQ(outcome.exit, 2);
    EXPECT_NE(outcome.err.find("did you mean bash?"), std::string::npos) << outcome.err;
    EXPECT_EQ(run({"completion"}).exit, 2);
}

}  // namespace
}  // namespace glint::testing
