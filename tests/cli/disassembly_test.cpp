// glint inspect --disassemble
#include "cli/command.h"
#include "cli/shell.h"
#include "cli/tiny_scene.h"

#include <set>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

class Disassembly : public TinySceneTest {
protected:
    void SetUp() override {
        TinySceneTest::SetUp();
        must(run({"compile", "scene.gltf", "-o", "package", "--strategy", "uber,visibility,hit-shaders",
                  "--tracer", "all", "--effects", "all"}));
    }
    nlohmann::json disassemble(const std::string& what) const {
        const Outcome outcome = must(run({"inspect", "package", "--disassemble", what, "--json"}));
        return outcome.json().at("disassembly");
    }
};

TEST_F(Disassembly, OfAShaderIsAllOfItsModules) {
    const nlohmann::json shader = run({"inspect", "package", "--json"}).json().at("shaders")[1];
    const nlohmann::json modules = disassemble("1");
    std::set<std::string> files;
    for (const nlohmann::json& module : modules) {
        EXPECT_EQ(module.at("shaderId"), 1);
        EXPECT_NE(module.at("text").get<std::string>().find("OpFunctionEnd"), std::string::npos);
        files.insert(module.at("file").get<std::string>());
    }
    std::set<std::string> expected;
    for (const nlohmann::json& stage : shader.at("stages")) {
        expected.insert(stage.at("file").get<std::string>());
    }
    EXPECT_EQ(files.size(), 5U);  // first hits and visibility with each tracer, and hit-shaders
    EXPECT_EQ(files, expected);
    EXPECT_EQ(disassemble(shader.at("name").get<std::string>()), modules);
}

TEST_F(Disassembly, OfARoleOrAFile) {
    const nlohmann::json role = disassemble("UberShade");
    ASSERT_EQ(role.size(), 2U) << "one for each tracer";
    EXPECT_TRUE(role[0].at("shaderId").is_null());
    const std::string file = role[0].at("file").get<std::string>();
    const nlohmann::json module = disassemble(file);
    ASSERT_EQ(module.size(), 1U);
    EXPECT_EQ(module[0], role[0]);
}

TEST_F(Disassembly, AsTextIsAssemblyOfTheSameModule) {
    const Outcome text = must(run({"inspect", "package", "--disassemble", "gbuffer.frag.spv"}));
    EXPECT_TRUE(text.out.starts_with("; gbuffer.frag.spv: GBufferFragment\n")) << text.out.substr(0, 80);
    if (!hasProgram("spirv-as")) {
        GTEST_SKIP() << "spirv-as is not installed";
    }
    writeText(path("text.spvasm"), text.out);
    must(runShell(path(""),
                  "spirv-as --preserve-numeric-ids --target-env vulkan1.2 text.spvasm -o again.spv"));
    // The first five words name the assembler, so they are left out.
    constexpr std::size_t kHeaderBytes = 20;
    EXPECT_EQ(readText(path("again.spv")).substr(kHeaderBytes),
              readText(path("package/gbuffer.frag.spv")).substr(kHeaderBytes));
}

TEST_F(Disassembly, OfNothingIsAnError) {
    for (const char* what : {"99", "UberShad", "-1"}) {
        const Outcome outcome = run({"inspect", "package", "--disassemble", what});
        EXPECT_EQ(outcome.exit, 1) << what;
        EXPECT_EQ(outcome.out, "");
        EXPECT_NE(outcome.err.find("[module-unknown]"), std::string::npos) << outcome.err;
    }
    EXPECT_NE(run({"inspect", "package", "--disassemble", "UberShad"}).err.find("did you mean UberShade?"),
              std::string::npos);
}

}  // namespace
}  // namespace glint::testing
