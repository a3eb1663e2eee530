// Tests settings files: their effect, what takes precedence, and what is refused.
#include "cli/render_command.h"

#include <string>
#include <vector>

namespace glint::testing {
namespace {

using Json = nlohmann::json;

class SettingsFile : public RenderCommand {
protected:
    std::string write(const Json& settings, const std::string& name = "settings.json") const {
        writeText(path(name),
                  Json{{"format", "glint-settings"}, {"version", 1}, {"settings", settings}}.dump());
        return name;
    }
    void expectRefused(const std::string& text, const std::string& where, const std::string& message) const {
        writeText(path("bad.json"), text);
        const Outcome outcome = run({"compile", scene_, "-o", "package", "--settings", "bad.json"});
        EXPECT_EQ(outcome.exit, 1) << text;
        EXPECT_TRUE(has(outcome.err, where + ": error: ")) << outcome.err;
        EXPECT_TRUE(has(outcome.err, message)) << outcome.err;
        EXPECT_TRUE(has(outcome.err, "[settings-file]")) << outcome.err;
        EXPECT_FALSE(std::filesystem::exists(path("package")));
    }
};

TEST_F(SettingsFile, GivesOptionsToCompile) {
    write({{"strategy", "uber"}, {"texture-lod", "mip0"}, {"merge", "none"}, {"spp", 16}, {"ssr", "8"}});
    must(run({"compile", scene_, "-o", "package", "--settings", "settings.json"}));
    const Json manifest = Json::parse(readText(path("package/manifest.json")));
    EXPECT_EQ(manifest.at("strategies"), Json({"uber"}));
    EXPECT_EQ(manifest.at("merge"), "none");
    EXPECT_EQ(manifest.at("settings").at("textureLod"), "mip0");
}

TEST_F(SettingsFile, YieldsToTheCommandLine) {
    write({{"strategy", "uber"}, {"merge", "none"}, {"spp", "16"}});
    for (const std::vector<std::string>& spp : {std::vector<std::string>{"--spp", "3"}, {"--spp=3"}}) {
        std::vector<std::string> more{"--settings", "settings.json", "--json"};
        more.insert(more.end(), spp.begin(), spp.end());
        const Outcome outcome = must(render("a.exr", more));
        EXPECT_EQ(outcome.json().at("spp"), 3);
        EXPECT_EQ(outcome.json().at("strategy"), "uber");
        EXPECT_EQ(outcome.json().at("merge"), "none");
    }
}

TEST_F(SettingsFile, LeavesToAPackageWhatThatHasDecided) {
    ASSERT_EQ(run({"compile", scene_, "-o", "package", "--strategy", "uber"}).exit, 0);
    write({{"strategy", "uber"}, {"texture-lod", "mip0"}, {"batch-effects", "on"}, {"spp", 2}});
    const Outcome outcome =
        must(render("a.exr", {"--settings", "settings.json", "--package", "package", "--json"}));
    EXPECT_EQ(outcome.json().at("spp"), 2);
}

TEST_F(SettingsFile, CompilesAnewWhenItChanges) {
    const std::vector<std::string> line{"compile", scene_,       "-o",
                                        "package", "--settings", write({{"merge", "none"}})};
    ASSERT_EQ(run(line).exit, 0);
    write({{"merge", "all"}});
    ASSERT_EQ(run(line).exit, 0);
    EXPECT_EQ(Json::parse(readText(path("package/manifest.json"))).at("merge"), "all");
}

TEST_F(SettingsFile, IsRefusedWithItsPlace) {
    expectRefused("{", "bad.json", "is no file of settings");
    expectRefused("[]", "bad.json", "is no file of settings");
    expectRefused(R"({"format": "glint-settings", "version": 1})", "bad.json", "is no file of settings");
    expectRefused(R"({"format": "glint-settings", "version": 2, "settings": {}})", "bad.json#/version",
                  "is not 1");
    const auto of = [](const std::string& settings) {
        return R"({"format": "glint-settings", "version": 1, "settings": )" + settings + "}";
    };
    expectRefused(of(R"({"texture-lot": "mip0"})"), "bad.json#/settings/texture-lot", "texture-lod");
    expectRefused(of(R"({"texture-lod": "mip1"})"), "bad.json#/settings/texture-lod", "mip1");
    expectRefused(of(R"({"texture-lod": {}})"), "bad.json#/settings/texture-lod",
                  "neither a text nor a number");
    expectRefused(of(R"({"texture-lod": ""})"), "bad.json#/settings/texture-lod",
                  "neither a text nor a number");
    expectRefused(of(R"({"position-fetch": "maybe"})"), "bad.json#/settings/position-fetch",
                  "none of on, off");
    expectRefused(std::string(5000, '['), "bad.json", "is no file of settings");
    EXPECT_EQ(run({"compile", scene_, "-o", "package", "--settings", "none.json"}).exit, 1);
    EXPECT_EQ(run({"compile", scene_, "-o", "package", "--settings"}).exit, 2);
}

}  // namespace
}  // namespace glint::testing
