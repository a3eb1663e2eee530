// That glint bench can fail: what is wrong with a package shows as an error above its interval, what is slow
// as time, and what is neither as a tie.
#include "cli/planted.h"
#include "cli/render_command.h"

#include <string>
#include <vector>

namespace glint::testing {
namespace {

using Json = nlohmann::json;

constexpr const char* kGallery = GLINT_GALLERY_FOLDER "/gallery.gltf";

class PlantedFaults : public CommandTest {
protected:
    // A package of the gallery of its own.
    void compile(const std::string& name, const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{"compile",    kGallery,     "-o",     name,
                                           "--strategy", "visibility", "--emit", "glsl"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = run(arguments);
        ASSERT_EQ(outcome.exit, 0) << outcome.err;
    }
    // The points of the packages, by name.
    std::map<std::string, Json> measure(const std::vector<std::string>& packages) const {
        std::vector<std::string> arguments{"bench",  kGallery,  "-o",      "out",   "--quick",
                                           "--size", "48x27",   "--spp",   "4",     "--only",
                                           "spp",    "--depth", "singles", "--json"};
        for (const std::string& name : packages) {
            arguments.insert(arguments.end(), {"--candidate", name + "=" + name});
        }
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.exit, 0) << outcome.err;
        const Json report = outcome.json();
        std::map<std::string, Json> points;
        for (const Json& point : report.at("points")) {
            points[point.at("name")] = point;
        }
        for (const std::string& name : packages) {
            EXPECT_TRUE(points.contains(name)) << name << " was left out: " << outcome.err;
        }
        return points;
    }
};

TEST_F(PlantedFaults, ShowAsErrorsOrAsTime) {
    for (const char* const name : {"sound", "level", "lobe", "sampling", "slow"}) {
        ASSERT_NO_FATAL_FAILURE(compile(name));
    }
    // Textures four levels too coarse, no clearcoat, reflections that keep to the middle of their lobe.
    plant(path("level"), "lighting.comp", "gradients.xy, gradients.zw",
          "gradients.xy * 16.0, gradients.zw * 16.0");
    plant(path("lobe"), "lighting.comp", "GLINT_MATERIAL(hit).clearcoatFactor",
          "0.0 * GLINT_MATERIAL(hit).clearcoatFactor");
    plant(path("sampling"), "lighting.comp", "vec3 sampleVisibleNormal(vec3 v, vec2 alpha, vec2 u) {",
          "vec3 sampleVisibleNormal(vec3 v, vec2 alpha, vec2 u) {\n    u.y *= 0.25;");
    // Work that no picture shows, but that no compiler can leave out.
    plant(path("slow"), "compose.comp", "    RunningMean mean = RunningMean(radiance, vec3(0.0));",
          "    float work = radiance.x;\n"
          "    for (int i = 0; i < 100000; ++i) {\n        work = fract(work * 1.7 + float(i));\n    }\n"
          "    radiance.x += work == -1.0 ? 1.0 : 0.0;\n"
          "    RunningMean mean = RunningMean(radiance, vec3(0.0));");
    std::map<std::string, Json> points = measure({"sound", "level", "lobe", "sampling", "slow"});
    for (const char* const name : {"level", "lobe", "sampling"}) {
        const Json& point = points.at(name);
        EXPECT_FALSE(point.at("errorTie").get<bool>()) << name << point.at("error").dump(1);
        EXPECT_FALSE(point.at("sameImage").get<bool>()) << name;
        EXPECT_GT(point.at("error").at("trimmed").at("median").get<double>(),
                  points.at("default").at("error").at("trimmed").at("median").get<double>())
            << name;
    }
    for (const char* const name : {"sound", "slow"}) {
        EXPECT_TRUE(points.at(name).at("sameImage").get<bool>()) << name;
        EXPECT_TRUE(points.at(name).at("errorTie").get<bool>()) << name;
    }
    // Not a bound on a time: that many instructions a pixel are more than all else.
    EXPECT_FALSE(points.at("slow").at("timeTie").get<bool>()) << points.at("slow").at("ratio").dump(1);
    EXPECT_GT(points.at("slow").at("ratio").at("low").get<double>(), 1.0);
}

}  // namespace
}  // namespace glint::testing
