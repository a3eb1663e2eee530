// The example of an engine with its own scene, formats, acceleration structures, bindings and frames, against
// Glint's own renderer on the same content.
#include "frame.h"
#include "gltf/import.h"
#include "gpu.h"
#include "render/harness.h"
#include "world.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

constexpr std::uint32_t kWidth = 160;
constexpr std::uint32_t kHeight = 90;
const std::string kScene = GLINT_SOURCE_DIR "/examples/engine/scene/engine.gltf";

// Reflections by one ray in the mirror's direction, as the engine has them.
LinearImage picturedByGlint() {
    gltf::ImportOptions import;
    import.decodeImages = true;
    const Result<gltf::Scene> scene = importScene(kScene, import);
    EXPECT_TRUE(scene) << toString(scene.error());
    RenderSetup setup = defaultSetup(*scene, kWidth, kHeight);
    setup.frame.maxReflectionRoughness = 1.0F;
    setup.frame.mirrorRoughness = 1.0F;
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyVisibility;
    const LoadedScene loaded(*scene, settings);
    return loaded.render(package::kStrategyVisibility, setup);
}

const LinearImage& reference() {
    static const LinearImage kImage = picturedByGlint();
    return kImage;
}

// The largest difference relative to max(1, value), and its root mean square.
struct Difference {
    double largest = 0.0;
    double rms = 0.0;
    std::size_t pixelsAbove = 0;  // a difference of 1e-4
};

Difference difference(const engine::Picture& picture) {
    Difference result;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        double worst = 0.0;
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const double truth = reference().pixels[i][channel];
            worst = std::max(worst, std::abs(picture.pixels[i][channel] - truth) / std::max(1.0, truth));
            result.rms += std::pow(picture.pixels[i][channel] - truth, 2);
        }
        result.largest = std::max(result.largest, worst);
        result.pixelsAbove += worst > 1e-4 ? 1 : 0;
    }
    result.rms = std::sqrt(result.rms / (3.0 * static_cast<double>(picture.pixels.size())));
    return result;
}

class EngineExample : public ::testing::Test {
protected:
    static engine::Picture render(engine::Format format, package::Strategy strategy, package::Tracer tracer,
                                  int turns) {
        const Result<Package> package = Package::load(std::filesystem::path(GLINT_ENGINE_PACKAGE));
        EXPECT_TRUE(package) << toString(package.error());
        const engine::World world =
            engine::readGltf(kScene, format, static_cast<float>(kWidth) / static_cast<float>(kHeight));
        engine::Gpu gpu(true, tracer);
        engine::Picture picture;
        {
            const std::string shaders = GLINT_ENGINE_SHADERS;
            engine::Engine renderer(gpu, *package, world, shaders, {kWidth, kHeight, strategy, tracer});
            std::vector<std::array<float, 12>> rest;
            for (const engine::Instance& instance : world.instances) {
                rest.push_back(instance.objectToWorld);
            }
            // Frames in which everything is elsewhere must leave nothing in the last one.
            std::vector<std::array<float, 12>> moved = rest;
            for (std::array<float, 12>& rows : moved) {
                rows[3] += 0.7F;
            }
            for (int i = 0; i < turns; ++i) {
                renderer.frame(moved);
            }
            renderer.frame(rest);
            picture = renderer.picture();
            EXPECT_GT(renderer.rays(), kWidth * kHeight / 3);
        }
        EXPECT_EQ(gpu.messages(), 0U);
        return picture;
    }
};

TEST_F(EngineExample, ShowsWhatGlintsRendererShows) {
    ASSERT_FALSE(reference().pixels.empty());
    struct Way {
        package::Strategy strategy;
        package::Tracer tracer;
    };
    // The engine's own shader traces by the same means.
    for (const Way& way : {Way{package::kStrategyVisibility, package::kTracerRayQuery},
                           Way{package::kStrategyVisibility, package::kTracerRayPipeline},
                           Way{package::kStrategyHitShaders, package::kTracerRayPipeline}}) {
        const Difference found = difference(render(engine::Format::Full, way.strategy, way.tracer, 3));
        EXPECT_LE(found.largest, 1e-4) << nameOf(way.strategy) << ", " << found.pixelsAbove << " pixels";
        RecordProperty(std::string(nameOf(way.strategy)) + "_" + std::string(nameOf(way.tracer)),
                       std::to_string(found.largest));
    }
}

// Compact vertices move silhouettes by up to 1/65534 of a mesh and turn normals by a few thousandths of a
// degree.
TEST_F(EngineExample, LosesLittleWithCompactVertices) {
    ASSERT_FALSE(reference().pixels.empty());
    const Difference found =
        difference(render(engine::Format::Compact, package::kStrategyUber, package::kTracerRayQuery, 0));
    EXPECT_LE(found.rms, 0.02);
    EXPECT_LE(found.pixelsAbove, kWidth * kHeight);
    RecordProperty("rms", std::to_string(found.rms));
    RecordProperty("above", std::to_string(found.pixelsAbove));
}

}  // namespace
