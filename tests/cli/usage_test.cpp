#include "cli/command.h"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

class Usage : public CommandTest {};

const std::vector<std::string> kUsageCommands{"compile", "compile-module", "explain", "inspect",
                                              "diff",    "render",         "compare", "lint"};

TEST_F(Usage, HelpNamesEveryCommand) {
    const Outcome help = must(run({"--help"}));
    EXPECT_TRUE(help.err.empty()) << help.err;
    for (const std::string& command : kUsageCommands) {
        EXPECT_TRUE(has(help.out, "\n  " + command + " ")) << command;
    }
}

TEST_F(Usage, HelpOfEveryCommandFitsAScreen) {
    constexpr std::ptrdiff_t kLines = 24;
    for (const std::string& command : kUsageCommands) {
        const Outcome help = run({command, "--help"});
        EXPECT_EQ(help.exit, 0) << command;
        EXPECT_TRUE(has(help.out, "Examples:\n  glint " + command + " ")) << help.out;
        EXPECT_TRUE(has(help.out, "--help-all lists all ")) << help.out;
        EXPECT_LE(std::ranges::count(help.out, '\n'), kLines) << help.out;
        EXPECT_EQ(run({"help", command}).out, help.out);
        EXPECT_GT(run({command, "--help-all"}).out.size(), help.out.size()) << command;
    }
    EXPECT_EQ(run({"help"}).out, run({"--help"}).out);
}

// The examples of each help must at least parse: they fail because their files are missing, not because of
// their options.
TEST_F(Usage, ExamplesOfTheHelpAreValidCommandLines) {
    for (const std::string& command : kUsageCommands) {
        const std::string help = run({command, "--help"}).out;
        std::size_t examples = 0;
        for (std::size_t at = help.find("\n  glint "); at != std::string::npos;
             at = help.find("\n  glint ", at + 1)) {
            std::istringstream line(help.substr(at, help.find('\n', at + 1) - at));
            std::vector<std::string> words{std::istream_iterator<std::string>(line), {}};
            words.erase(words.begin());
            const Outcome outcome = run(words);
            EXPECT_EQ(outcome.exit, 1) << command << ": " << outcome.err;
            EXPECT_TRUE(has(outcome.err, "error: ") || has(outcome.err, "quiet")) << outcome.err;
            ++examples;
        }
        EXPECT_EQ(examples, 2U) << help;
    }
}

TEST_F(Usage, VersionIsPrinted) {
    const Outcome version = must(run({"--version"}));
    EXPECT_TRUE(version.out.starts_with("glint ")) << version.out;
    for (const char* const part :
         {", commit ", "package format ", "glslang ", "SPIRV-Tools v", "KTX2 textures "}) {
        EXPECT_TRUE(has(version.out, part)) << version.out;
    }
}

struct Mistake {
    std::vector<std::string> arguments;
    std::string message;
};

TEST_F(Usage, MistakesExitWithTwoAndSayWhatToDo) {
    const std::vector<Mistake> mistakes{
        {{}, "a command is missing"},
        {{"complie"}, "did you mean compile?"},
        {{"--hlep"}, "did you mean --help?"},
        {{"frobnicate"}, "unknown command \"frobnicate\""},
        {{"compile", "a.gltf", "--ouput", "x"}, "did you mean --output?"},
        {{"compile", "a.gltf", "--outptu=x"}, "did you mean --output?"},
        {{"compile", "a.gltf"}, "-o DIR"},
        {{"compile", "-o", "x"}, "SCENE"},
        {{"explain", "a.gltf", "b.gltf"}, "b.gltf"},
        {{"compile", "a.gltf", "-o", "x", "--merge", "famly"}, "did you mean family?"},
        {{"compile", "a.gltf", "-o", "x", "--strategy", "vis"},
         "none of auto, uber, visibility, sorted-uber, hit-shaders, all"},
        {{"compile", "a.gltf", "-o", "x", "--emit", "glsl,heder"}, "did you mean header?"},
        {{"compile", "a.gltf", "-o", "x", "--max-shaders", "-1"}, "from 0 to"},
        {{"compile", "a.gltf", "-o", "x", "--jobs", "many"}, "\"many\""},
        {{"compile", "a.gltf", "-o", ""}, "is empty"},
        {{"compile", "a.gltf", "-o", "x", "--hit-lobes", "base,clearcoast"}, "did you mean clearcoat?"},
        {{"compile", "a.gltf", "-o", "x", "--hit-lobes", "normals"}, "\"normals\" is none of all, base"},
        {{"compile", "a.gltf", "-o", "x", "--energy-compensation=yes"}, "none of on, off"},
        {{"compile", "a.gltf", "-o", "x", "--texture-lod", "mip1"}, "did you mean mip0?"},
        {{"explain", "a.gltf", "--variant", ""}, "is empty"},
        {{"explain", "a.gltf", "--hit-lobes", "shen"}, "did you mean sheen?"},
        {{"render", "a.gltf"}, "--output"},
        {{"render", "a.gltf", "-o", "a.jpg"}, ".png or .exr"},
        {{"render", "a.gltf", "-o", "a.png", "--size", "960"}, "960x540"},
        {{"render", "a.gltf", "-o", "a.png", "--size", "0x10"}, "0x10"},
        {{"render", "a.gltf", "-o", "a.png", "--size", "10x10x10"}, "10x10x10"},
        {{"render", "a.gltf", "-o", "a.png", "--spp", "0"}, "from 1 to"},
        {{"render", "a.gltf", "-o", "a.png", "--seed", "4294967296"}, "from 0 to"},
        {{"render", "a.gltf", "-o", "a.png", "--exposure", "bright"}, "neither auto nor"},
        {{"render", "a.gltf", "-o", "a.png", "--exposure", "nan"}, "neither auto nor"},
        {{"render", "a.gltf", "-o", "a.png", "--max-roughness", "1.5"}, "from 0 to 1"},
        {{"render", "a.gltf", "-o", "a.png", "--package", "p", "--merge", "all"}, "--package"},
        {{"render", "a.gltf", "-o", "a.png", "--package", "p", "--hit-lobes", "base"}, "--package"},
        {{"render", "a.gltf", "-o", "a.png", "--package", "p", "--texture-lod", "mip0"}, "--package"},
        {{"compile", "a.gltf", "-o", "x", "--precision", "8"}, "none of auto, 32, 16"},
        {{"render", "a.gltf", "-o", "a.png", "--package", "p", "--no-energy-compensation"}, "--package"},
        {{"render", "a.gltf", "-o", "a.png", "--view", "ray"}, "did you mean rays?"},
        {{"render", "a.gltf", "-o", "a.png", "--view", "reflection.rays"}, "use rays"},
        {{"render", "a.gltf", "-o", "a.png", "--view", "reflection.hit-distanc"},
         "did you mean hit-distance?"},
        {{"render", "a.gltf", "-o", "a.png", "--view", "nan"}, "--help-all lists them"},
        {{"render", "a.gltf", "-o", "a.exr", "--view", "rays"}, "--layers rays"},
        {{"render", "a.gltf", "-o", "a.png", "--view", "difference"}, "--view-reference FILE"},
        {{"render", "a.gltf", "-o", "a.png", "--view-reference", "b.exr"}, "--view difference"},
        {{"compare", "a.png"}, "B is missing; give the reference"},
        {{"compare", "a.png", "b.png", "--max-error", "-1"}, "from 0 to"},
        {{"compare", "a.png", "b.png", "--diff", "d.exr"}, ".png"},
        {{"check-materials", "pack", "--boxes", "9"}, "--prove"},
        {{"check-materials", "pack", "--prove", "--samples", "256"}, "--prove"},
        {{"compile", "a.gltf", "-o", "x", "-Z"}, "unknown option -Z"},
    };
    for (const Mistake& mistake : mistakes) {
        const Outcome outcome = run(mistake.arguments);
        EXPECT_EQ(outcome.exit, 2) << mistake.message;
        EXPECT_TRUE(outcome.out.empty()) << outcome.out;
        EXPECT_TRUE(has(outcome.err, mistake.message)) << mistake.message << "\n" << outcome.err;
        EXPECT_TRUE(has(outcome.err, " --help for its options.")) << outcome.err;
        // The message says first what is wrong, then what to do.
        const std::string line = outcome.err.substr(0, outcome.err.find('\n'));
        EXPECT_TRUE(has(line, "; ")) << line;
    }
    EXPECT_TRUE(filesBelow(path("")).empty());
}

TEST_F(Usage, TheLastFormOfABooleanOptionCounts) {
    const auto refused = [&](const std::vector<std::string>& more) {
        return runWith({"explain", "none.gltf"}, more).exit;
    };
    EXPECT_EQ(refused({"--quiet", "--verbose"}), 2);
    EXPECT_EQ(refused({"-q", "-v"}), 2);
    EXPECT_EQ(refused({"--quiet", "--verbose", "--no-quiet"}), 1);
    EXPECT_EQ(refused({"--trust-textures", "--no-trust-textures"}), 1);
    EXPECT_EQ(refused({"--trust-textures=off"}), 1);
    EXPECT_EQ(refused({"--trust-textures=auto"}), 2);
}

TEST_F(Usage, OutputsThatCantBeWrittenAreFoundBeforeAnythingIsRead) {
    const std::vector<std::vector<std::string>> lines{
        {"render", "none.gltf", "-o", "/proc/a.png"},
        {"render", "none.gltf", "-o", "a.png", "--stats", "/proc/a.json"},
        {"compile", "none.gltf", "-o", "/proc/a"},
        {"compile", "none.gltf", "--dry-run", "-o", "/proc/a"},
        {"compile", "none.gltf", "-o", "a", "--depfile", "/proc/a.d"},
        {"compile", "none.gltf", "--embed", "/proc/a.cpp"},
        {"compile", "none.gltf", "-o", "a", "--plan-only", "/proc/a"},
        {"compile-module", "none.glsl", "-o", "/proc/a.module"},
        {"bench", "none.gltf", "-o", "/proc/a"},
        {"compare", "none.png", "none.png", "--diff", "/proc/a.png"},
        {"check-materials", "none", "--pictures", "/proc/a"}};
    for (const std::vector<std::string>& line : lines) {
        const Outcome outcome = run(line);
        EXPECT_EQ(outcome.exit, 1) << line[0];
        EXPECT_TRUE(outcome.err.starts_with("/proc/a")) << line[0] << ": " << outcome.err;
        EXPECT_TRUE(has(outcome.err, "can't be written")) << outcome.err;
    }
    // The trials leave nothing behind.
    EXPECT_EQ(run({"render", "none.gltf", "-o", "a.png", "--stats", "a.json"}).exit, 1);
    EXPECT_EQ(run({"compile", "none.gltf", "-o", "below/a"}).exit, 1);
    EXPECT_TRUE(filesBelow(path("")).empty());
}

TEST_F(Usage, MistakesAreAnsweredAsDocumented) {
    const std::string document = GLINT_SOURCE_DIR "/docs/diagnostics.md";
    const std::string printed =
        runProgram({"bash", GLINT_SOURCE_DIR "/tests/cli/mistakes.sh", commandPath()}).out;
    const std::string begin = "<!-- mistakes: begin -->\n```\n";
    const std::string end = "\n```\n<!-- mistakes: end -->";
    const std::string text = readText(document);
    const std::size_t first = text.find(begin) + begin.size();
    const std::size_t last = text.find(end);
    ASSERT_TRUE(first < last && last != std::string::npos) << "the transcript's place is missing";
    const std::string transcript = printed.substr(0, printed.find_last_not_of('\n') + 1);
    if (std::getenv("GLINT_UPDATE_DOCUMENTS") != nullptr) {
        writeText(document, text.substr(0, first) + transcript + text.substr(last));
        return;
    }
    EXPECT_EQ(text.substr(first, last - first), transcript)
        << "write it anew: GLINT_UPDATE_DOCUMENTS=1 ctest -R MistakesAreAnswered";
}

TEST_F(Usage, NegativeExposureIsAValue) {
    const Outcome outcome = run({"render", "none.gltf", "-o", "a.png", "--exposure", "-3.5"});
    EXPECT_EQ(outcome.exit, 1) << outcome.err;
}

TEST_F(Usage, MissingFilesExitWithOneAndNameTheFile) {
    const std::vector<std::vector<std::string>> lines{{"compile", "none.gltf", "-o", "x"},
                                                      {"explain", "none.gltf"},
                                                      {"inspect", "none.gltf"},
                                                      {"render", "none.gltf", "-o", "x.png"},
                                                      {"compare", "none.gltf.png", "b.png"},
                                                      {"lint", "none.gltf"}};
    for (const std::vector<std::string>& line : lines) {
        const Outcome outcome = run(line);
        EXPECT_EQ(outcome.exit, 1) << line[0];
        EXPECT_TRUE(outcome.out.empty()) << outcome.out;
        EXPECT_TRUE(outcome.err.starts_with("none.gltf")) << outcome.err;
        EXPECT_TRUE(has(outcome.err, "error: ")) << outcome.err;
    }
    EXPECT_TRUE(filesBelow(path("")).empty());
}

}  // namespace
}  // namespace glint::testing
