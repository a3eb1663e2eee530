// Holds the pipelines of three packages to budgets, on a GPU that is not there: RADV's null device compiles
// for it.
#include "cli/command.h"
#include "support/models.h"
#include "support/nightly.h"

#include <filesystem>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

namespace fs = std::filesystem;

// Returns the path of RADV's manifest, or an empty path.
fs::path radvManifest() {
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator("/usr/share/vulkan/icd.d", error)) {
        if (entry.path().filename().string().starts_with("radeon_icd")) {
            return entry.path();
        }
    }
    return {};
}

class PackageBudgets : public CommandTest {
protected:
    // Radeon RX 7900.
    Outcome inspect(const std::string& budget) const {
        return run({"inspect", "package", "--pipelines", "--budget", budget},
                   {{"VK_DRIVER_FILES", radvManifest().string()}, {"RADV_FORCE_FAMILY", "navi31"}});
    }
    // Compiles the scene, whose tracing modules are compute shaders, and expects its pipelines within budget.
    void expectWithinBudget(const std::string& scene, std::vector<std::string> options) const {
        must(runWith({"compile", scene, "-o", "package", "--strategy", "uber,visibility"}, options));
        const Outcome inspected =
            must(inspect(std::string(GLINT_SOURCE_DIR) + "/tests/cli/pipeline_budgets.json"));
        EXPECT_TRUE(has(inspected.out, "RADV NAVI31")) << inspected.out;
    }
};

TEST_F(PackageBudgets, OfTheGalleryHold) {
    const fs::path scene = fs::path(GLINT_BINARY_DIR) / "tests/render/gallery/gallery.gltf";
    if (radvManifest().empty() || !fs::exists(scene)) {
        GTEST_SKIP() << "needs RADV and the gallery";
    }
    expectWithinBudget(scene.string(), {});
    // No pipeline keeps this one.
    writeText(path("tight.json"),
              R"({"format": "glint-pipeline-budget", "budgets": [{"pipelines": "*", "registers": 1}]})");
    EXPECT_EQ(inspect("tight.json").exit, 1);
}

TEST_F(PackageBudgets, OfSheenChairHold) {
    const fs::path scene = test::modelsFolder() / "features/SheenChair/SheenChair.gltf";
    if (!fs::exists(scene)) {
        GTEST_SKIP() << test::noModels(scene);
    }
    if (radvManifest().empty()) {
        GTEST_SKIP() << "needs RADV";
    }
    expectWithinBudget(scene.string(), {});
}

TEST_F(PackageBudgets, OfManyCasesHold) {
    const std::string script = std::string(GLINT_SOURCE_DIR) + "/benchmarks/make_synthetic_scene.py";
    const std::string cases = test::nightly() ? "64" : "16";
    if (radvManifest().empty() ||
        runProgram({"/usr/bin/python3", "-B", script, "scene", "--materials", cases, "--keys", cases}).exit !=
            0) {
        GTEST_SKIP() << "needs RADV and Python";
    }
    expectWithinBudget("scene/scene.gltf", {"--merge", "none"});
}

}  // namespace
}  // namespace glint::testing
