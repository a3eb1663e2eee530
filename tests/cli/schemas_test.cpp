// Checks the --json output of every command and the files of a package against docs/schemas.
#include "cli/schemas.h"

#include "cli/command.h"
#include "cli/tiny_scene.h"
#include "materials/declaration_files.h"

#include <algorithm>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

using Json = nlohmann::json;

class Schemas : public TinySceneTest {
protected:
    Schemas() : TinySceneTest({.unknownExtension = true, .variants = true}) {}

    Json json(std::vector<std::string> arguments, int exit = 0) const {
        arguments.emplace_back("--json");
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.exit, exit) << outcome.err;
        return outcome.json();
    }
    // Expects a result, which has more than its diagnostics.
    void expectResult(const std::string& schema, const Json& result) const {
        expectFits(schema, result);
        EXPECT_GT(result.size(), 1U) << result;
    }
    Json compile(const std::string& package, const std::vector<std::string>& options) const {
        std::vector<std::string> line{"compile", "scene.gltf", "-o", package};
        line.insert(line.end(), options.begin(), options.end());
        return json(line);
    }
};

TEST_F(Schemas, HoldCompileAndInspect) {
    const std::vector<std::string> options{"--strategy", "all", "--tracer", "all", "--emit", "glsl,header"};
    const Json made = compile("package", options);
    expectResult("compile", made);
    EXPECT_EQ(made.at("upToDate"), false);
    const Json repeated = compile("package", options);
    expectResult("compile", repeated);
    EXPECT_EQ(repeated.at("upToDate"), true);
    expectFits("manifest", Json::parse(readText(path("package/manifest.json"))));
    expectResult("inspect", json({"inspect", "package"}));
    expectResult("inspect", json({"inspect", "package", "--disassemble", "0"}));
    expectResult("compile", json({"compile", "scene.gltf", "--dry-run", "--variant", "Day"}));
    expectResult("compile", json({"compile", "scene.gltf", "--embed", "scene.cpp", "--cache", "none"}));
}

TEST_F(Schemas, HoldTheManifest) {
    compile("small", {"--strategy", "uber", "--merge", "auto", "--max-shaders", "1", "--variant", "Night",
                      "--environment-map", "--hit-lobes", "base"});
    expectFits("manifest", Json::parse(readText(path("small/manifest.json"))));
}

// The lock file is text with one line for each key, as docs/cli.md says.
TEST_F(Schemas, LockFilesHaveTheFormOfTheDocument) {
    ASSERT_EQ(run({"compile", "scene.gltf", "-o", "package", "--lock", "glint.lock", "--merge", "none",
                   "--strategy", "uber"})
                  .exit,
              0);
    std::istringstream lines(readText(path("glint.lock")));
    const std::regex key(R"((0|[1-9]\d*) (-|[A-Za-z0-9]+( [A-Za-z0-9]+)*))");
    std::vector<std::string> text;
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with('#')) {
            text.push_back(line);
        }
    }
    ASSERT_EQ(text.size(), 3U);
    EXPECT_EQ(text[0], "version 1");
    EXPECT_TRUE(std::regex_match(text[1], key)) << text[1];
    EXPECT_TRUE(std::regex_match(text[2], key)) << text[2];
}

TEST_F(Schemas, HoldExplain) {
    expectResult("explain", json({"explain", "scene.gltf"}));
    expectResult("explain", json({"explain", "scene.gltf", "--material", "Spare", "--merge", "auto"}));
    expectResult("explain", json({"explain", "scene.gltf", "--variant", "Day", "--hit-lobes", "base"}));
}

TEST_F(Schemas, HoldPlans) {
    for (const char* const policy : {"none", "family", "all", "auto"}) {
        expectResult("explain-plan", json({"explain", "scene.gltf", "--plan", "--merge", policy}));
    }
}

TEST_F(Schemas, HoldCompileModule) {
    const Json planned = json({"compile", "scene.gltf", "-o", "package", "--plan-only", "plan"});
    expectResult("compile", planned);
    EXPECT_GT(planned.at("plan").at("modules").get<int>(), 0);
    // A module that is joined from parts needs them compiled, so this takes one that has none.
    const std::filesystem::directory_iterator modules(path("plan/modules"));
    const auto module = std::find_if(begin(modules), end(modules), [](const auto& file) {
        return readText(file.path()).find("\n// part ") == std::string::npos;
    });
    ASSERT_NE(module, end(modules));
    expectResult("compile-module", json({"compile-module", module->path().string(), "-o", "module"}));
}

TEST_F(Schemas, HoldDiff) {
    compile("a", {"--merge", "none"});
    compile("b", {"--merge", "all", "--variant", "Day", "--strategy", "sorted-uber"});
    const Json different = json({"diff", "a", "b", "--exit-code"}, 1);
    expectResult("diff", different);
    EXPECT_EQ(different.at("differ"), true);
    expectResult("diff", json({"diff", "b", "a"}));
    expectResult("diff", json({"diff", "a", "a"}));
}

TEST_F(Schemas, HoldLint) {
    compile("package", {"--strategy", "uber,hit-shaders", "--merge", "all", "--alpha", "tested"});
    writeText(path("package/broken.spv"), "this is no SPIR-V");
    const Json found = json({"lint", "package", "package/broken.spv", "--max-instructions", "10"}, 1);
    expectResult("lint", found);
    EXPECT_GT(found.at("errors").get<int>(), 1);
}

TEST_F(Schemas, HoldFailures) {
    const std::vector<std::vector<std::string>> lines{
        {"compile", "none.gltf", "-o", "x"},    {"explain", "none.gltf"},      {"inspect", "none"},
        {"compile-module", "none", "-o", "x"},  {"diff", "none", "none"},      {"lint", "none.spv"},
        {"render", "none.gltf", "-o", "a.png"}, {"compare", "a.png", "b.png"}, {"check-materials", "none"},
        {"bench", "none.gltf", "-o", "x"},      {"view", "none.gltf"}};
    for (const std::vector<std::string>& line : lines) {
        const Json failed = json(line, 1);
        expectFits(line[0], failed);
        ASSERT_EQ(failed.size(), 1U) << failed;
        EXPECT_EQ(failed.at("diagnostics").back().at("severity"), "error");
    }
}

TEST_F(Schemas, RefuseWhatTheyDoNotKnow) {
    const Json good = json({"explain", "scene.gltf"});
    ASSERT_TRUE(fits("explain", good));
    Json more = good;
    more["materials"][0]["keys"][0]["case"]["colour"] = "red";
    EXPECT_FALSE(fits("explain", more));
    Json less = good;
    less["materials"][0].erase("name");
    EXPECT_FALSE(fits("explain", less));
    Json other = good;
    other["diagnostics"][0]["severity"] = "fatal";  // behind a reference to another file
    EXPECT_FALSE(fits("explain", other));
    EXPECT_FALSE(fits("explain", Json::object()));
}

// Expects that every member has a description, and that other members are rejected.
void expectDescribed(const Json& schema, const std::string& where) {
    if (schema.is_array()) {
        for (const Json& element : schema) {
            expectDescribed(element, where);
        }
    }
    if (!schema.is_object()) {
        return;
    }
    if (schema.contains("properties")) {
        EXPECT_EQ(schema.value("additionalProperties", Json()), Json(false)) << where;
        for (const auto& [name, member] : schema.at("properties").items()) {
            EXPECT_TRUE(member.contains("description") || member.contains("$ref")) << where << "/" << name;
        }
    }
    for (const auto& [name, value] : schema.items()) {
        expectDescribed(value, std::string(where).append("/").append(name));
    }
}

TEST(SchemaFiles, DescribeEveryMember) {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(GLINT_SOURCE_DIR "/docs/schemas")) {
        const std::string name = entry.path().stem().string();
        expectDescribed(readSchema(name), name);
        names.insert(name);
    }
    for (const char* command : {"compile", "compile-module", "explain", "explain-plan", "inspect", "diff",
                                "lint", "render", "view", "bench", "compare", "check-materials"}) {
        EXPECT_TRUE(names.contains(command)) << command;
    }
}

// Returns the first JSON block below a heading of a document.
Json exampleIn(const std::string& document, const std::string& heading) {
    const std::string text = readText(GLINT_SOURCE_DIR "/docs/" + document);
    const std::string fence = "```json\n";
    const std::size_t begin = text.find(fence, text.find("\n" + heading + "\n")) + fence.size();
    return Json::parse(text.substr(begin, text.find("\n```", begin) - begin), nullptr, false);
}

TEST(SchemaFiles, FitTheDeclarationsOfMaterials) {
    ASSERT_FALSE(materials::declarationFiles().empty());
    for (const base::BuiltinFile& file : materials::declarationFiles()) {
        SCOPED_TRACE(file.name);
        expectFits(file.name.starts_with("effects/") ? "effect" : "material_feature", Json::parse(file.text));
    }
    EXPECT_FALSE(fits("effect", Json{{"name", "glow"}, {"about", "It glows."}, {"kind", "glowing"}}));
    EXPECT_FALSE(
        fits("material_feature", Json{{"name", "wet"}, {"stage", "layer"}, {"neutrl", Json::array()}}));
    Json wet{{"name", "wet"}, {"stage", "layer"}, {"short", "Wet"}};
    EXPECT_FALSE(fits("material_feature", wet));
    wet["extension"] = "EXT_wet";
    expectFits("material_feature", wet);
}

TEST(SchemaFiles, FitTheExamplesOfTheDocuments) {
    expectFits("material_feature", exampleIn("material_features.md", "## Declarations"));
    expectFits("material_list", exampleIn("material_lists.md", "## From nothing to a picture"));
    expectFits("effect", exampleIn("effects.md", "## An effect of your own"));
    expectFits("compile", exampleIn("cli.md", "## glint compile"));
    expectFits("lint", exampleIn("lint.md", "## JSON"));
    const Json diagnostic = exampleIn("cli.md", "## What is reported");
    expectFits("compare", Json{{"diagnostics", {diagnostic}}});
}

}  // namespace
}  // namespace glint::testing
