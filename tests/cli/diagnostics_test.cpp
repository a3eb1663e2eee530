// Tests how diagnostics are reported: -W, --werror, --quiet, --verbose, --color.
#include "cli/command.h"
#include "cli/tiny_scene.h"

#include <regex>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

// The scene causes one warning, "extension-ignored".
class Diagnostics : public TinySceneTest {
protected:
    Diagnostics() : TinySceneTest({.unknownExtension = true}) {}

    static std::vector<std::string> dryRun(const std::vector<std::string>& options) {
        std::vector<std::string> line{"compile", "scene.gltf", "--dry-run"};
        line.insert(line.end(), options.begin(), options.end());
        return line;
    }
    Outcome plan(const std::vector<std::string>& options) const {
        return run(dryRun(options));
    }
    void expectUsageError(const std::string& option, const std::string& message) const {
        const Outcome outcome = plan({option});
        EXPECT_EQ(outcome.exit, 2) << option;
        EXPECT_TRUE(outcome.out.empty()) << outcome.out;
        EXPECT_NE(outcome.err.find(message), std::string::npos) << message << "\n" << outcome.err;
    }
};

constexpr const char* kColor = "\x1b[1;33mwarning\x1b[0m: ";

TEST_F(Diagnostics, AreReportedOnStandardErrorAndInJson) {
    const Outcome outcome = must(plan({"--json"}));
    EXPECT_TRUE(outcome.err.starts_with("scene.gltf#/extensionsUsed")) << outcome.err;
    EXPECT_TRUE(outcome.err.ends_with(" [extension-ignored]\n")) << outcome.err;
    const nlohmann::json list = outcome.json().at("diagnostics");
    ASSERT_EQ(list.size(), 1U);
    EXPECT_EQ(list[0].at("severity"), "warning");
    EXPECT_EQ(list[0].at("id"), "extension-ignored");
    EXPECT_EQ(list[0].at("where"), "scene.gltf#" + list[0].at("pointer").get<std::string>());
    EXPECT_TRUE(list[0].at("pointer").get<std::string>().starts_with("/extensionsUsed"));
}

TEST_F(Diagnostics, AreInTheJsonOfACommandThatFails) {
    const Outcome outcome = run({"compile", "none.gltf", "--dry-run", "--json"});
    EXPECT_EQ(outcome.exit, 1);
    const nlohmann::json json = outcome.json();
    ASSERT_EQ(json.size(), 1U) << json;
    EXPECT_EQ(json.at("diagnostics")[0].at("id"), "file-open");
    EXPECT_TRUE(json.at("diagnostics")[0].at("pointer").is_null());
}

TEST_F(Diagnostics, WnoLeavesThemOut) {
    const Outcome outcome = must(plan({"-Wno-extension-ignored", "--json"}));
    EXPECT_EQ(outcome.err, "");
    EXPECT_TRUE(outcome.json().at("diagnostics").empty());
    EXPECT_EQ(plan({"-W", "no-extension-ignored"}).err, "");
    EXPECT_NE(plan({"-Wno-animation-pointer"}).err, "");
}

TEST_F(Diagnostics, NotesAreLeftOutLikewise) {
    writeText(path("file"), "");
    const std::vector<std::string> compile{"compile", "scene.gltf", "-o", "package", "--cache", "file/cache"};
    EXPECT_NE(run(compile).err.find(": note: "), std::string::npos);
    std::vector<std::string> silent = compile;
    silent.insert(silent.end(), {"-Wno-cache-write", "-Wno-extension-ignored"});
    EXPECT_EQ(run(silent).err, "");
}

TEST_F(Diagnostics, WerrorMakesErrorsOfAllOrOfOneId) {
    const std::vector<std::vector<std::string>> raising{
        {"--werror"},
        {"-Werror"},
        {"--werror=extension-ignored"},
        {"-Werror=extension-ignored"},
        {"--werror=animation-pointer", "--werror=extension-ignored"},
        {"-Wno-animation-pointer", "-Werror=extension-ignored"}};
    for (const std::vector<std::string>& options : raising) {
        const Outcome outcome = plan(options);
        EXPECT_EQ(outcome.exit, 1) << options[0];
        EXPECT_NE(outcome.err.find(": error: the extension EXT_not_known_to_anyone"), std::string::npos)
            << outcome.err;
        EXPECT_NE(outcome.err.find("[werror]"), std::string::npos) << outcome.err;
    }
    for (const char* option : {"--werror=animation-pointer", "-Werror=animation-pointer"}) {
        const Outcome outcome = plan({option});
        EXPECT_EQ(outcome.exit, 0) << option;
        EXPECT_NE(outcome.err.find(": warning: "), std::string::npos) << outcome.err;
    }
}

TEST_F(Diagnostics, WhatIsLeftOutIsNoError) {
    for (const char* option : {"--werror", "-Werror", "--werror=extension-ignored"}) {
        const Outcome outcome = plan({option, "-Wno-extension-ignored"});
        EXPECT_EQ(outcome.exit, 0) << option << "\n" << outcome.err;
        EXPECT_EQ(outcome.err, "");
    }
}

TEST_F(Diagnostics, ErrorsCannotBeLeftOut) {
    const std::string message = "\"file-open\" is always an error; name a warning";
    expectUsageError("-Wno-file-open", message);
    expectUsageError("-Werror=file-open", message);
    expectUsageError("--werror=file-open", message);
}

TEST_F(Diagnostics, MisspeltIdsAreSuggested) {
    const std::string message =
        "there is no diagnostic \"extension-ignord\"; did you mean extension-ignored?";
    expectUsageError("-Wno-extension-ignord", message);
    expectUsageError("-Werror=extension-ignord", message);
    expectUsageError("--werror=extension-ignord", message);
    expectUsageError("-Wno-frobnicate", "there is no diagnostic \"frobnicate\"");
    expectUsageError("-Wall", "\"all\" is neither no-ID, error nor error=ID");
    expectUsageError("--werror=", "--werror: is empty");
    expectUsageError("-W", "-W");
}

TEST_F(Diagnostics, QuietLeavesErrorsAndJson) {
    const Outcome quiet = must(plan({"--quiet"}));
    EXPECT_EQ(quiet.out, "");
    EXPECT_EQ(quiet.err, "");
    EXPECT_EQ(plan({"--quiet", "--json"}).json().at("counts").at("materials"), 3);
    const Outcome failed = run({"compile", "none.gltf", "--dry-run", "--quiet"});
    EXPECT_EQ(failed.exit, 1);
    EXPECT_NE(failed.err.find("[file-open]"), std::string::npos) << failed.err;
    EXPECT_NE(plan({"--quiet", "--werror"}).err.find("[extension-ignored]"), std::string::npos);
}

TEST_F(Diagnostics, VerboseSaysWhatIsDoneAndWhen) {
    const Outcome outcome =
        must(run({"compile", "scene.gltf", "-o", "package", "--verbose", "--cache", "none"}));
    for (const char* step : {"reading scene.gltf", "compiling scene.gltf", "writing package"}) {
        EXPECT_TRUE(
            std::regex_search(outcome.err, std::regex(R"((^|\n) *\d+\.\d{3} s  )" + std::string(step))))
            << step << "\n"
            << outcome.err;
    }
    EXPECT_NE(outcome.out.find("materials"), std::string::npos) << outcome.out;
    expectUsageError("--verbose=x", "--verbose");
    EXPECT_EQ(plan({"--verbose", "--quiet"}).exit, 2);
}

TEST_F(Diagnostics, ColorIsForTerminalsAndForThoseWhoAsk) {
    EXPECT_EQ(plan({}).err.find('\x1b'), std::string::npos);
    EXPECT_NE(plan({"--color", "always"}).err.find(kColor), std::string::npos);
    const std::vector<std::pair<std::string, std::string>> noColor{{"NO_COLOR", "1"}};
    EXPECT_NE(run(dryRun({"--color=always"}), noColor).err.find(kColor), std::string::npos);

    EXPECT_NE(runOnTerminal(dryRun({}), {{"NO_COLOR", ""}}).err.find(kColor), std::string::npos);
    for (const Outcome& plain :
         {runOnTerminal(dryRun({}), noColor), runOnTerminal(dryRun({"--color", "never"}))}) {
        EXPECT_EQ(plain.exit, 0);
        EXPECT_EQ(plain.err.find("\x1b[1"), std::string::npos) << plain.err;
        EXPECT_NE(plain.err.find(": warning: "), std::string::npos) << plain.err;
    }
    const Outcome unknown = plan({"--color", "alway"});
    EXPECT_EQ(unknown.exit, 2);
    EXPECT_NE(unknown.err.find("did you mean always?"), std::string::npos) << unknown.err;
}

TEST_F(Diagnostics, ProgressIsForTerminals) {
    const std::vector<std::string> compile{"compile", "scene.gltf", "-o", "package", "--cache", "none"};
    EXPECT_EQ(run(compile).err.find("reading"), std::string::npos);
    const std::string terminal = runOnTerminal(compile).err;
    EXPECT_NE(terminal.find("\r\x1b[Kreading scene.gltf"), std::string::npos) << terminal;
    EXPECT_NE(terminal.find("\r\x1b[Kcompiling 2 of "), std::string::npos) << terminal;
    EXPECT_TRUE(terminal.ends_with("\r\x1b[K")) << "the last line of progress stays: " << terminal;
    std::vector<std::string> quiet = compile;
    quiet.emplace_back("--quiet");
    EXPECT_EQ(runOnTerminal(quiet).err, "");
}

}  // namespace
}  // namespace glint::testing
