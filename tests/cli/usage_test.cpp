#include "cli/command.h"

#include <string>
#include <utility>
#include <vector>

namespace glint::testing {
namespace {

class Usage : public CommandTest {};

const std::vector<std::string> kUsageCommands{"compile", "compile-module", "explain", "inspect",
                                              "diff",    "render",         "compare", "lint"};

TEST_F(Usage, HelpNamesEveryCommand) {
    const Outcome help = run({"--help"});
    EXPECT_EQ(help.exit, 0);
    EXPECT_TRUE(help.err.empty()) << help.err;
    for (const std::string& command : kUsageCommands) {
        EXPECT_TRUE(has(help.out, "\n  " + command + " ")) << command;
    }
}

TEST_F(Usage, HelpOfEveryCommandHasAnExample) {
    for (const std::string& command : kUsageCommands) {
        const Outcome help = run({command, "--help"});
        EXPECT_EQ(help.exit, 0) << command;
        EXPECT_TRUE(has(help.out, "Example:\n  glint " + command + " ")) << help.out;
    }
}

// The example of each help must at least parse: it fails because its files are missing, not because of its
// options.
TEST_F(Usage, ExamplesOfTheHelpAreValidCommandLines) {
    for (const std::string& command : kUsageCommands) {
        const std::string help = run({command, "--help"}).out;
        std::size_t begin = help.find("Example:\n  glint ");
        ASSERT_NE(begin, std::string::npos);
        begin += std::string("Example:\n  glint ").size();
        std::vector<std::string> words;
        std::string word;
        for (const char c : help.substr(begin, help.find('\n', begin) - begin) + " ") {
            if (c != ' ') {
                word += c;
            } else {
                words.push_back(std::exchange(word, {}));
            }
        }
        const Outcome outcome = run(words);
        EXPECT_EQ(outcome.exit, 1) << command << ": " << outcome.err;
        EXPECT_TRUE(has(outcome.err, "error: ")) << outcome.err;
    }
}

TEST_F(Usage, VersionIsPrinted) {
    const Outcome version = run({"--version"});
    EXPECT_EQ(version.exit, 0);
    EXPECT_TRUE(version.out.starts_with("glint ")) << version.out;
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
        {{"compile", "a.gltf", "-o", "x", "--energy-compensation", "yes"}, "none of on, off"},
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
        {{"compile", "a.gltf", "-o", "x", "--precision", "8"}, "none of 32, 16"},
        {{"render", "a.gltf", "-o", "a.png", "--package", "p", "--energy-compensation", "off"}, "--package"},
        {{"render", "a.gltf", "-o", "a.png", "--view", "ray"}, "did you mean rays?"},
        {{"render", "a.gltf", "-o", "a.png", "--view", "reflection.rays"}, "use rays"},
        {{"render", "a.gltf", "-o", "a.png", "--view", "reflection.hit-distanc"},
         "did you mean hit-distance?"},
        {{"render", "a.gltf", "-o", "a.png", "--view", "nan"}, "--help lists them"},
        {{"render", "a.gltf", "-o", "a.exr", "--view", "rays"}, "--layers rays"},
        {{"render", "a.gltf", "-o", "a.png", "--view", "difference"}, "--view-reference FILE"},
        {{"render", "a.gltf", "-o", "a.png", "--view-reference", "b.exr"}, "--view difference"},
        {{"compare", "a.png"}, "B is required"},
        {{"compare", "a.png", "b.png", "--max-error", "-1"}, "from 0 to"},
        {{"compare", "a.png", "b.png", "--diff", "d.exr"}, ".png"},
    };
    for (const Mistake& mistake : mistakes) {
        const Outcome outcome = run(mistake.arguments);
        EXPECT_EQ(outcome.exit, 2) << mistake.message;
        EXPECT_TRUE(outcome.out.empty()) << outcome.out;
        EXPECT_TRUE(has(outcome.err, mistake.message)) << mistake.message << "\n" << outcome.err;
        EXPECT_TRUE(has(outcome.err, " --help for its options.")) << outcome.err;
    }
    EXPECT_TRUE(filesBelow(path("")).empty());
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
