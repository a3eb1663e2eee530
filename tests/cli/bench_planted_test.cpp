// Checks that glint bench can fail: a fault in a package shows as an error above its interval, slow code
// shows as time, and a change that is neither shows as a tie.
#include "cli/command.h"
#include "cli/planted.h"
#include "cli/tiny_scene.h"
#include "image/image_file.h"
#include "support/must.h"

#include <array>
#include <map>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

using Json = nlohmann::json;

// Nothing else approximates, so that the planted fault is the only difference besides noise.
const std::vector<std::string> kExactPackage{"--texture-lod", "mip0", "--alpha", "tested"};
const std::vector<std::string> kExactFrame{"--max-roughness", "1", "--mirror-roughness", "0"};

class PlantedFaults : public CommandTest {
protected:
    // Writes the tiny scene with a rough, coated floor that reflects a wall with a checkerboard.
    void SetUp() override {
        CommandTest::SetUp();
        TinyScene options;
        options.variants = true;
        const std::filesystem::path file = writeTinyScene(path(""), options);
        Json gltf = Json::parse(readText(file));
        // The texture coordinates are the first two coordinates of each position.
        Json& attributes = gltf["meshes"][1]["primitives"][0]["attributes"];
        Json view = gltf["bufferViews"]
                        [gltf["accessors"][attributes["POSITION"].get<int>()]["bufferView"].get<int>()];
        view["byteStride"] = 12;
        gltf["bufferViews"].push_back(view);
        gltf["accessors"].push_back({{"bufferView", gltf["bufferViews"].size() - 1},
                                     {"componentType", 5126},
                                     {"count", 4},
                                     {"type", "VEC2"}});
        attributes["TEXCOORD_0"] = gltf["accessors"].size() - 1;
        writeCheckerboard();
        gltf["images"] = {{{"uri", "checkerboard.png"}}};
        gltf["textures"] = {{{"source", 0}}};
        gltf["materials"][1].erase("extensions");
        gltf["materials"][1]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
        gltf["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = 0.3;
        writeText(file, gltf.dump());
    }

    void writeCheckerboard() const {
        constexpr std::uint32_t kSize = 64;
        image::DisplayImage image{kSize, kSize, {}};
        for (std::uint32_t i = 0; i < kSize * kSize; ++i) {
            const bool isLight = (i % kSize < kSize / 2) != (i / kSize < kSize / 2);
            image.pixels.push_back(isLight ? std::array<std::uint8_t, 3>{250, 250, 250}
                                           : std::array<std::uint8_t, 3>{20, 20, 20});
        }
        must(writeImage(path("checkerboard.png"), image));
    }

    // Compiles a package with that name.
    void compile(const std::string& name) const {
        must(runWith({"compile", "scene.gltf", "-o", name, "--strategy", "visibility", "--emit", "glsl"},
                     kExactPackage));
    }
    // Returns the points of the packages, by name.
    std::map<std::string, Json> measure(const std::vector<std::string>& packages) const {
        std::vector<std::string> arguments{"bench",   "scene.gltf",  "-o",   "out",    "--quick", "--size",
                                           "64x36",   "--spp",       "16",   "--only", "spp",     "--depth",
                                           "singles", "--reference", "same", "--json"};
        arguments.insert(arguments.end(), kExactPackage.begin(), kExactPackage.end());
        arguments.insert(arguments.end(), kExactFrame.begin(), kExactFrame.end());
        for (const std::string& name : packages) {
            arguments.emplace_back("--candidate");
            arguments.emplace_back(name).append("=").append(name);
        }
        const Outcome outcome = must(run(arguments));
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
    // The faults are textures six levels too coarse, no clearcoat, and reflections that keep to the middle of
    // their lobe.
    plantInFirstHits(path("level"), "textureLod(GLINT_SAMPLER(record), uv, 0.0)",
                     "textureLod(GLINT_SAMPLER(record), uv, 6.0)");
    plantInFirstHits(path("lobe"), "factor = GLINT_MATERIAL_CLEARCOAT_FACTOR(hit)",
                     "factor = 0.0 * GLINT_MATERIAL_CLEARCOAT_FACTOR(hit)");
    plantInFirstHits(path("sampling"), "vec3 sampleVisibleNormal(vec3 v, vec2 alpha, vec2 u) {",
                     "vec3 sampleVisibleNormal(vec3 v, vec2 alpha, vec2 u) {\n    u.y *= 0.25;");
    // This work changes no picture, but no compiler can leave it out.
    plant(path("slow"), "compose.comp", "    RunningMean mean = RunningMean(radiance, vec3(0.0));",
          "    float work = radiance.x;\n"
          "    for (int i = 0; i < 20000; ++i) {\n        work = fract(work * 1.7 + float(i));\n    }\n"
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
    // This is not a bound on a time: that many instructions a pixel take more than all else.
    EXPECT_FALSE(points.at("slow").at("timeTie").get<bool>()) << points.at("slow").at("ratio").dump(1);
    EXPECT_GT(points.at("slow").at("ratio").at("low").get<double>(), 1.0);
}

}  // namespace
}  // namespace glint::testing
