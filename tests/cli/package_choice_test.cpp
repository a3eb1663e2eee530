// Tests rendering from packages that support only some settings.
#include "cli/render_command.h"

#include <string>
#include <vector>

namespace glint::testing {
namespace {

class PackageChoice : public RenderCommand {
protected:
    void compile(const std::vector<std::string>& options) const {
        must(runWith({"compile", scene_, "-o", "package"}, options));
    }
    void expectRefused(const std::vector<std::string>& options, const std::string& message) const {
        std::vector<std::string> line{"--package", "package"};
        line.insert(line.end(), options.begin(), options.end());
        const Outcome outcome = render("a.png", line);
        EXPECT_EQ(outcome.exit, 1);
        EXPECT_EQ(outcome.err, message + "\n");
        EXPECT_FALSE(std::filesystem::exists(path("a.png")));
    }
};

TEST_F(PackageChoice, AStrategyThatItLacksIsAnsweredByThoseItHas) {
    compile({"--strategy", "uber,sorted-uber"});
    const std::string message =
        "package: error: has uber, sorted-uber, not visibility; render with --strategy uber, or compile with "
        "--strategy visibility [package-mismatch]";
    expectRefused({}, message);
    expectRefused({"--strategy", "visibility"}, message);
}

TEST_F(PackageChoice, ATracerThatItLacksIsAnsweredByThoseItHas) {
    compile({"--strategy", "uber"});
    expectRefused(
        {"--strategy", "uber", "--tracer", "ray-pipeline"},
        "package: error: has ray-query for uber, not ray-pipeline; render with --tracer ray-query, or "
        "compile with --tracer ray-pipeline [package-tracer]");
}

TEST_F(PackageChoice, OrderingIsOfStrategiesThatOrder) {
    compile({"--strategy", "all"});
    const auto rendered = [&](const std::string& strategy) {
        return render("a.png", {"--package", "package", "--strategy", strategy, "--json"}).json();
    };
    for (const char* strategy : {"uber", "hit-shaders"}) {
        EXPECT_TRUE(rendered(strategy).at("ordering").is_null()) << strategy;
    }
    for (const char* strategy : {"visibility", "sorted-uber"}) {
        EXPECT_TRUE(rendered(strategy).at("ordering").is_string()) << strategy;
    }
}

}  // namespace
}  // namespace glint::testing
