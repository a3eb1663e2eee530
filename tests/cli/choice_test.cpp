// Options that contradict each other, and malformed lists.
#include "cli/command.h"
#include "cli/tiny_scene.h"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace glint::testing {
namespace {

class Choice : public CommandTest {
protected:
    void expectRefused(const std::vector<std::string>& arguments, const std::string& message) const {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.exit, 2) << message;
        EXPECT_TRUE(outcome.out.empty()) << outcome.out;
        EXPECT_NE(outcome.err.find(message), std::string::npos) << message << "\n" << outcome.err;
    }
};

TEST_F(Choice, RayQueriesCannotRunHitShaders) {
    const std::vector<std::string> line{"render",     "a.gltf",      "-o",       "a.png",
                                        "--strategy", "hit-shaders", "--tracer", "ray-query"};
    expectRefused(line, "ray-query can't run --strategy hit-shaders, which is a ray tracing pipeline");
}

TEST_F(Choice, WhatThePackageDecidesIsRefusedBesideIt) {
    const std::vector<std::vector<std::string>> decided{
        {"--merge", "all"},        {"--max-shaders", "3"},    {"--alpha", "tested"},
        {"--hit-lobes", "base"},   {"--energy-compensation"}, {"--texture-lod", "cones"},
        {"--shadows", "deferred"}, {"--hit-record", "full"},  {"--position-fetch"},
        {"--precision", "16"},     {"--lights", "4"}};
    for (const std::vector<std::string>& option : decided) {
        std::vector<std::string> line{"render", "a.gltf", "-o", "a.png", "--package", "p"};
        line.insert(line.end(), option.begin(), option.end());
        expectRefused(line, option.front() + ": is decided by --package; leave out one of them");
    }
}

TEST_F(Choice, ListsHaveItemsAndNoBlanks) {
    const auto refused = [&](const std::vector<std::string>& option, const std::string& message) {
        std::vector<std::string> line{"compile", "a.gltf", "-o", "x"};
        line.insert(line.end(), option.begin(), option.end());
        expectRefused(line, message);
    };
    refused({"--emit=", "--strategy", "uber"}, "--emit: is empty");
    refused({"--emit", "", "--strategy", "uber"}, "--emit: is empty");
    refused({"--emit", "--strategy", "uber"}, "--emit: \"--strategy\" is none of glsl, header");
    refused({"--strategy", ","}, "--strategy: is empty");
    refused({"--strategy=,"}, "--strategy: is empty");
    refused({"--strategy", "uber,"}, "\"uber,\" lacks an item");
    refused({"--strategy", "uber,", "visibility"}, "\"uber,\" lacks an item");
    refused({"--strategy", "uber,,visibility"}, "lacks an item");
    refused({"--strategy", ",uber"}, "lacks an item");
    refused({"--strategy", "uber, visibility"}, "has a blank; separate lists by commas alone");
    refused({"--tracer=all, ray-query"}, "has a blank");
    refused({"--hit-lobes", " base"}, "has a blank");
}

TEST_F(Choice, EmptyValuesNeverTakeTheNextArgument) {
    expectRefused({"compile", "a.gltf", "--output=", "b.gltf"}, "--output: is empty");
    expectRefused({"render", "a.gltf", "-o", "a.png", "--camera=", "b.gltf"}, "--camera: is empty");
    expectRefused({"lint", "a.spv", "--core=", "b.spv"}, "--core: is empty");
    expectRefused({"compile", "a.gltf", "-o"}, "--output");
}

TEST_F(Choice, RaysTestAlphaMasksWhereASceneHasThem) {
    // Compiles, and returns the policy that the manifest names.
    const auto policy = [&](const TinyScene& scene, const std::vector<std::string>& options, bool notes) {
        writeTinyScene(path(""), scene);
        const Outcome outcome =
            must(runWith({"compile", "scene.gltf", "-o", "package", "--strategy", "uber"}, options));
        EXPECT_EQ(outcome.err.find("[alpha-tested]") != std::string::npos, notes) << outcome.err;
        for (const auto& [note, asks] : {std::pair{"BLEND is drawn opaque: Floor [alpha-blend]", "tested"},
                                         std::pair{"[alpha-stochastic]", ""}}) {
            const bool asked = options.empty() ? *asks == '\0' : options.back() == asks;
            EXPECT_EQ(outcome.err.find(note) != std::string::npos, scene.blended && asked) << outcome.err;
        }
        return nlohmann::json::parse(readText(path("package/manifest.json"))).at("alpha").get<std::string>();
    };
    EXPECT_EQ(policy({}, {}, false), "opaque");
    EXPECT_EQ(policy({.blended = true}, {}, false), "stochastic");
    EXPECT_EQ(policy({.blended = true}, {"--alpha", "tested"}, false), "tested");
    EXPECT_EQ(policy({.masked = true, .blended = true}, {}, false), "stochastic");
    EXPECT_EQ(policy({.masked = true}, {}, true), "tested");
    EXPECT_EQ(policy({.masked = true}, {"--alpha", "opaque"}, false), "opaque");
    EXPECT_EQ(policy({.masked = true}, {"--alpha", "tested"}, false), "tested");
}

TEST_F(Choice, MaterialsAreListedAndSuggested) {
    writeTinyScene(path(""));
    const Outcome outcome = run({"explain", "scene.gltf", "--material", "Flor"});
    EXPECT_EQ(outcome.exit, 1);
    EXPECT_NE(outcome.err.find("(it has Floor, Wall, Spare); did you mean Floor?"), std::string::npos)
        << outcome.err;
}

}  // namespace
}  // namespace glint::testing
