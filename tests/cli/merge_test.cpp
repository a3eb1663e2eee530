// Tests --merge auto and profile without a device: cases, reasons, and invalid profiles.
#include "cli/command.h"
#include "cli/tiny_scene.h"

#include <algorithm>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace glint::testing {
namespace {

using Json = nlohmann::json;

Json makeProfileJson(int unlitHits, int normalHits) {
    return {{"format", "glint-profile"},
            {"version", 1},
            {"sources", Json::array()},
            {"variant", nullptr},
            {"alpha", "opaque"},
            {"hitLobes",
             {"unlit", "specularGlossiness", "ior", "specular", "clearcoat", "sheen", "anisotropy",
              "iridescence", "transmission", "diffuseTransmission", "volume", "attenuation", "dispersion"}},
            {"keys",
             {{{"features", {"unlit"}}, {"materials", {"Wall"}}, {"hits", unlitHits}},
              {{"features", {"normals"}}, {"materials", {"Floor"}}, {"hits", normalHits}}}}};
}

class Merge : public TinySceneTest {
protected:
    Outcome plan(const std::vector<std::string>& more) const {
        return runWith({"compile", scene_, "--dry-run", "--json"}, more);
    }
    Outcome planWith(const Json& profile, const std::vector<std::string>& more = {}) const {
        writeText(path("hits.json"), profile.dump());
        std::vector<std::string> arguments{"--profile", "hits.json"};
        if (std::ranges::find(more, "--merge") == more.end()) {
            arguments.insert(arguments.end(), {"--merge", "profile"});
        }
        arguments.insert(arguments.end(), more.begin(), more.end());
        return plan(arguments);
    }
};

TEST_F(Merge, AutoKeepsToTheLimit) {
    const Outcome two = must(plan({"--merge", "auto"}));
    EXPECT_EQ(two.json().at("counts").at("cases"), 2);
    EXPECT_EQ(two.json().at("shaders")[0].at("reason"), "own");
    const Outcome one = must(plan({"--merge", "auto", "--max-shaders", "1"}));
    EXPECT_EQ(one.json().at("counts").at("cases"), 1);
    EXPECT_EQ(one.json().at("shaders")[0].at("reason"), "budget");
    EXPECT_EQ(one.json().at("shaders")[0].at("share"), 1.0);
    const Outcome none = plan({"--merge", "none", "--max-shaders", "1"});
    EXPECT_EQ(none.exit, 1);
    EXPECT_NE(none.err.find("--merge auto"), std::string::npos) << none.err;
}

TEST_F(Merge, ProfileTellsHotFromNeverHit) {
    const Outcome outcome = must(planWith(makeProfileJson(0, 30)));
    EXPECT_EQ(outcome.json().at("shaders")[0].at("reason"), "never-hit");
    EXPECT_EQ(outcome.json().at("shaders")[1].at("reason"), "hot");
    EXPECT_EQ(outcome.json().at("shaders")[1].at("share"), 1.0);
    EXPECT_TRUE(outcome.json().at("diagnostics").empty());
    const Outcome explained =
        must(run({"explain", scene_, "--merge", "profile:hits.json", "--material", "Wall"}));
    EXPECT_NE(explained.out.find("never-hit: no hit of the profile has its key"), std::string::npos)
        << explained.out;
    EXPECT_NE(explained.out.find("counted by the profile"), std::string::npos) << explained.out;
}

// The floor has the larger area, and the wall has the hits that the profile counts.
TEST_F(Merge, AutoTakesTheHitsOfAProfile) {
    const auto sharesOf = [](const Outcome& outcome) {
        const Json shaders = outcome.json().at("shaders");
        return std::pair(shaders[0].at("share").get<double>(), shaders[1].at("share").get<double>());
    };
    const Outcome counted = must(planWith(makeProfileJson(30, 10), {"--merge", "auto"}));
    EXPECT_EQ(sharesOf(counted), std::pair(0.75, 0.25));
    const Outcome named = must(plan({"--merge", "auto:hits.json"}));
    EXPECT_EQ(sharesOf(named), std::pair(0.75, 0.25));
    EXPECT_NE(sharesOf(plan({"--merge", "auto"})), std::pair(0.75, 0.25));
    const Outcome explained = run({"explain", scene_, "--merge", "auto:hits.json"});
    EXPECT_NE(explained.out.find("counted by the profile"), std::string::npos) << explained.out;
    EXPECT_EQ(plan({"--merge", "auto:missing.json"}).exit, 1);
}

// If the profile has no hit, the expectation by areas is better than nothing.
TEST_F(Merge, AutoDoesWithoutAProfileThatHasNoHits) {
    const Outcome outcome = must(planWith(makeProfileJson(0, 0), {"--merge", "auto"}));
    EXPECT_NE(outcome.err.find("hits are expected from areas"), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.json().at("shaders"), plan({"--merge", "auto"}).json().at("shaders"));
}

TEST_F(Merge, ProfilesOfOtherKeysAreWarnedOf) {
    Json profile = makeProfileJson(10, 30);
    profile["keys"][0]["features"] = {"normals", "clearcoat"};
    profile["keys"][0]["materials"] = {"Varnish"};
    const Outcome outcome = must(planWith(profile));
    EXPECT_NE(outcome.err.find("warning: has no count for 1 of the scene's 2 keys"), std::string::npos)
        << outcome.err;
    EXPECT_NE(outcome.err.find("Wall (unlit)"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("note: counts 1 keys that the scene does not have: Varnish"),
              std::string::npos)
        << outcome.err;
    EXPECT_EQ(outcome.json().at("diagnostics").size(), 2U);
    EXPECT_EQ(planWith(profile, {"--werror"}).exit, 1);
}

TEST_F(Merge, ProfilesOfOtherSettingsAreWarnedOf) {
    Json profile = makeProfileJson(10, 30);
    profile["alpha"] = "tested";
    const Outcome outcome = must(planWith(profile));
    EXPECT_NE(outcome.err.find("was counted with --alpha tested, but this is opaque"), std::string::npos)
        << outcome.err;
    EXPECT_NE(planWith(makeProfileJson(1, 1), {"--hit-lobes", "base"}).err.find("--hit-lobes"),
              std::string::npos);
    EXPECT_NE(planWith(makeProfileJson(0, 0)).err.find("[profile-empty]"), std::string::npos);
    profile["sources"] = {{{"file", "scene.gltf"}, {"hash", "0000000000000000"}}};
    EXPECT_NE(planWith(profile).err.find("[profile-stale]"), std::string::npos);
}

TEST_F(Merge, MalformedProfilesFailWithTheirPlace) {
    struct Broken {
        Json patch;
        std::string message;
    };
    const std::vector<Broken> all{
        {{{"op", "remove"}, {"path", "/format"}}, "hits.json: error: has no member \"format\""},
        {{{"op", "replace"}, {"path", "/format"}, {"value", "x"}}, "hits.json#/format: error: is not"},
        {{{"op", "replace"}, {"path", "/version"}, {"value", 2}},
         "#/version: error: is 2; this glint reads 1"},
        {{{"op", "replace"}, {"path", "/version"}, {"value", "1"}}, "#/version: error: is no whole number"},
        {{{"op", "replace"}, {"path", "/keys"}, {"value", 1}}, "#/keys: error: is no list"},
        {{{"op", "replace"}, {"path", "/keys/1"}, {"value", 1}}, "#/keys/1: error: is no JSON object"},
        {{{"op", "replace"}, {"path", "/keys/1/hits"}, {"value", -1}}, "#/keys/1/hits: error: is no whole"},
        {{{"op", "replace"}, {"path", "/keys/1/hits"}, {"value", 1.5}}, "#/keys/1/hits: error: is no whole"},
        {{{"op", "replace"}, {"path", "/keys/1/hits"}, {"value", 1e300}},
         "#/keys/1/hits: error: is no whole"},
        {{{"op", "replace"}, {"path", "/keys/0/features/0"}, {"value", 7}},
         "#/keys/0/features/0: error: is no string"},
        {{{"op", "replace"}, {"path", "/variant"}, {"value", 7}}, "#/variant: error: is no string"},
        {{{"op", "remove"}, {"path", "/alpha"}}, "has no member \"alpha\""},
        {{{"op", "replace"}, {"path", ""}, {"value", Json::array()}}, "is no JSON object"},
    };
    for (const Broken& broken : all) {
        const Outcome outcome = planWith(makeProfileJson(1, 1).patch(Json::array({broken.patch})));
        EXPECT_EQ(outcome.exit, 1) << broken.patch;
        EXPECT_NE(outcome.err.find(broken.message), std::string::npos) << broken.patch << outcome.err;
        EXPECT_NE(outcome.err.find("[profile-format]"), std::string::npos) << outcome.err;
    }
    writeText(path("hits.json"), "{\"format\": ");
    EXPECT_NE(plan({"--merge", "profile:hits.json"}).err.find("is not valid JSON: byte "), std::string::npos);
    EXPECT_NE(plan({"--merge", "profile:missing.json"}).err.find("[file-open]"), std::string::npos);
}

// A byte is changed, removed or cut off. The result must be a plan or a diagnostic.
TEST_F(Merge, DamagedProfilesNeverCrash) {
    constexpr unsigned kSeed = 20250320;
    RecordProperty("seed", kSeed);
    std::mt19937 random(kSeed);
    const std::string whole = makeProfileJson(10, 30).dump();
    for (int i = 0; i < 60; ++i) {
        std::string text = whole;
        const std::size_t place = random() % text.size();
        switch (random() % 3) {
            case 0:
                text[place] = static_cast<char>(random());
                break;
            case 1:
                text.erase(place, 1 + random() % 8);
                break;
            default:
                text.resize(place);
                break;
        }
        writeText(path("hits.json"), text);
        const Outcome outcome = plan({"--merge", "profile:hits.json"});
        EXPECT_TRUE(outcome.exit == 0 || outcome.exit == 1) << outcome.exit << ": " << text;
        EXPECT_TRUE(outcome.exit == 0 || !outcome.err.empty()) << text;
    }
    const std::string deep(100000, '[');
    writeText(path("hits.json"), deep);
    EXPECT_EQ(plan({"--merge", "profile:hits.json"}).exit, 1);
}

TEST_F(Merge, OptionsThatDisagreeAreRefused) {
    struct Mistake {
        std::vector<std::string> arguments;
        std::string message;
    };
    const std::vector<Mistake> all{
        {{"compile", "a.gltf", "-o", "x", "--merge", "profile"}, "glint render --profile FILE"},
        {{"compile", "a.gltf", "-o", "x", "--merge", "profile:"}, "is none of"},
        {{"compile", "a.gltf", "-o", "x", "--merge", "profle"}, "did you mean profile?"},
        {{"compile", "a.gltf", "-o", "x", "--profile", "p"},
         "is for --merge profile and auto, not for --merge family"},
        {{"compile", "a.gltf", "-o", "x", "--merge", "profile:p", "--profile", "q"}, "give only one of them"},
        {{"explain", "a.gltf", "--merge", "none", "--profile", "p"}, "is for --merge profile"},
        {{"explain", "a.gltf", "--merge", "family:p"}, "is none of"},
        {{"explain", "a.gltf", "--merge", "auto:"}, "is none of"},
        {{"explain", "a.gltf", "--merge", "auto:p", "--profile", "q"}, "give only one of them"},
        {{"render", "a.gltf", "-o", "a.png", "--merge", "profile"}, "profile:FILE"},
        {{"render", "a.gltf", "-o", "a.png", "--merge", "profile:p", "--profile", "q"}, "leave out --merge"},
        {{"render", "a.gltf", "-o", "a.png", "--merge", "all", "--profile", "q"}, "leave out --merge all"},
        {{"render", "a.gltf", "-o", "a.png", "--strategy", "uber", "--profile", "q"},
         "--strategy visibility"},
        {{"render", "a.gltf", "-o", "a.png", "--package", "d", "--profile", "q"}, "--package"},
        {{"render", "a.gltf", "-o", "a.png", "--package", "d", "--max-shaders", "4"}, "--package"},
    };
    for (const Mistake& mistake : all) {
        const Outcome outcome = run(mistake.arguments);
        EXPECT_EQ(outcome.exit, 2) << outcome.err;
        EXPECT_NE(outcome.err.find(mistake.message), std::string::npos) << mistake.message << "\n"
                                                                        << outcome.err;
    }
}

}  // namespace
}  // namespace glint::testing
