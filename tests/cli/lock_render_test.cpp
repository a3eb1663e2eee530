// A package with gaps in its shader IDs runs in every strategy, by every tracer.
#include "cli/command.h"
#include "cli/tiny_scene.h"

#include <string>
#include <vector>

namespace glint::testing {
namespace {

class LockRender : public CommandTest {};

TEST_F(LockRender, GapsChangeNoPixel) {
    const std::string scene = writeTinyScene(path("")).string();
    writeText(path("glint.lock"), "version 1\n6 normals\n2 unlit\n4 sheen\n");
    const std::vector<std::string> compile{"compile", scene,      "--merge", "none", "--strategy",
                                           "all",     "--tracer", "all",     "-o"};
    std::vector<std::string> plain = compile;
    plain.emplace_back("plain");
    ASSERT_EQ(run(plain).exit, 0);
    std::vector<std::string> gaps = compile;
    gaps.insert(gaps.end(), {"gaps", "--lock", "glint.lock"});
    must(run(gaps));
    const nlohmann::json inspected = run({"inspect", "gaps", "--json"}).json();
    EXPECT_EQ(inspected.at("counts").at("cases"), 2);
    EXPECT_EQ(inspected.at("counts").at("buckets"), 8);

    const std::vector<std::vector<std::string>> runs{
        {"uber", "ray-query"},          {"uber", "ray-pipeline"},     {"visibility", "ray-query"},
        {"visibility", "ray-pipeline"}, {"sorted-uber", "ray-query"}, {"sorted-uber", "ray-pipeline"},
        {"hit-shaders", "ray-pipeline"}};
    for (const std::vector<std::string>& choice : runs) {
        SCOPED_TRACE(choice[0] + " by " + choice[1]);
        const auto render = [&](const std::string& package) {
            return run({"render", scene, "-o", package + ".exr", "--package", package, "--strategy",
                        choice[0], "--tracer", choice[1], "--size", "32x18", "--validate", "--json"});
        };
        ASSERT_EQ(render("plain").exit, 0);
        const Outcome rendered = must(render("gaps"));
        const nlohmann::json counters = rendered.json().at("counters");
        EXPECT_EQ(counters.at("unknownShader"), 0);
        EXPECT_EQ(counters.at("orderErrors"), 0);
        EXPECT_GT(counters.at("rays"), 0);
        EXPECT_EQ(run({"compare", "gaps.exr", "plain.exr", "--max-error", "0"}).exit, 0);
    }
}

}  // namespace
}  // namespace glint::testing
