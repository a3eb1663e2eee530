// --host DIR and --emit library of `glint compile`.
#include "cli/command.h"
#include "cli/tiny_scene.h"

#include <algorithm>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSkyFile = "host/sky.glsl";
constexpr const char* kSky =
    "#include \"host/resources.glsl\"\n\n"
    "vec3 hostSky(vec3 direction) {\n    return vec3(0.25);\n}\n"
    "vec3 hostSkyAround(vec3 direction, float roughness) {\n    return vec3(0.25);\n}\n"
    "vec3 hostSkyIrradianceOverPi(vec3 normal) {\n    return vec3(0.25);\n}\n";

class HostCommand : public TinySceneTest {
protected:
    void SetUp() override {
        TinySceneTest::SetUp();
        fs::create_directories(path("host"));
    }
    Outcome compile(std::vector<std::string> options) const {
        return runWith(
            {"compile", "scene.gltf", "-o", "package", "--strategy", "uber", "--cache", "cache", "--json"},
            options);
    }
    void expectError(const std::string& id, const std::string& part) const {
        const Outcome outcome = compile({"--host", "host"});
        EXPECT_EQ(outcome.exit, 1);
        const nlohmann::json diagnostic = outcome.json().at("diagnostics").at(0);
        EXPECT_EQ(diagnostic.at("id"), id) << outcome.out;
        EXPECT_TRUE(has(diagnostic.dump(), part)) << diagnostic.dump();
        EXPECT_FALSE(fs::exists(path("package")));
    }
};

TEST_F(HostCommand, IsAnInputOfThePackage) {
    writeText(path(kSkyFile), kSky);
    writeText(path("host/README.md"), "Notes are no part of a host.\n");
    const std::vector<std::string> options{"--host", "host", "--depfile", "package.d"};
    must(compile(options));
    EXPECT_TRUE(has(readText(path("package.d")), kSkyFile));
    const nlohmann::json manifest = nlohmann::json::parse(readText(path("package/manifest.json")));
    EXPECT_EQ(manifest.at("host"), nlohmann::json::array({"sky.glsl"}));
    EXPECT_EQ(run({"inspect", "package", "--json"}).json().at("host"), manifest.at("host"));
    EXPECT_TRUE(has(run({"inspect", "package"}).out, "host                 sky.glsl\n"));
    EXPECT_TRUE(compile(options).json().at("upToDate").get<bool>());
    std::string other = kSky;
    other.replace(other.find("0.25"), 4, "0.75");
    writeText(path(kSkyFile), other);
    const nlohmann::json changed = compile(options).json();
    EXPECT_FALSE(changed.at("upToDate").get<bool>());
    EXPECT_GT(changed.at("modules").at("compiled"), 0);
    // Without it, another package is made. A host brings textures of its own, so nothing is concluded from
    // those of the scene.
    std::filesystem::copy(path("package"), path("hosted"), std::filesystem::copy_options::recursive);
    ASSERT_EQ(compile({"--no-trust-textures"}).exit, 0);
    const nlohmann::json changes = run({"diff", "hosted", "package", "--json"}).json().at("settings");
    ASSERT_EQ(changes.size(), 1U) << changes;
    EXPECT_EQ(changes[0].at("name"), "host");
    EXPECT_EQ(changes[0].at("before"), "sky.glsl");
    EXPECT_TRUE(has(run({"inspect", "package"}).out, "host                 Glint's own\n"));
    EXPECT_TRUE(nlohmann::json::parse(readText(path("package/manifest.json"))).at("host").empty());
}

TEST_F(HostCommand, RefusesWhatIsNoHost) {
    expectError("host-folder", "has no file");
    writeText(path("host/ski.glsl"), kSky);
    expectError("host-unknown", "sky.glsl");
    fs::remove(path("host/ski.glsl"));
    writeText(path(kSkyFile), kSky);
    fs::create_directories(path("host/hit"));
    expectError("host-unknown", "rename");
    fs::remove_all(path("host"));
    expectError("host-folder", "listed");
}

TEST_F(HostCommand, ErrorsOfGlslNameTheFileAndTheLine) {
    std::string text = kSky;
    text.replace(text.find("vec3(0.25)"), 10, "nonsense");
    writeText(path(kSkyFile), text);
    expectError("glsl", "host/sky.glsl:4");
    writeText(path(kSkyFile), "#include \"host/resources.glsl\"\n");
    expectError("glsl", "docs/host.md");
}

TEST_F(HostCommand, TheLibraryIsPartOfThePackage) {
    const Outcome outcome = must(compile({"--emit", "library,linkable", "--merge", "none"}));
    const std::vector<std::string> files = filesBelow(path("package"));
    for (const char* const name : {"glint_host.glsl", "glint_library.glsl", "glint_library.spv"}) {
        EXPECT_TRUE(std::ranges::find(files, std::string("library/") + name) != files.end()) << name;
    }
    // One file for each case.
    EXPECT_EQ(std::ranges::count_if(files,
                                    [](const std::string& name) { return has(name, "library/glint_case_"); }),
              static_cast<std::ptrdiff_t>(outcome.json().at("shaders").size()));
    ASSERT_EQ(compile({}).exit, 0);
    EXPECT_FALSE(fs::exists(path("package/library")));
}

}  // namespace
}  // namespace glint::testing
