// The filter of examples/denoise: it removes noise, converges over frames, follows a moving camera, and says
// what a package lacks.
#include "denoiser.h"

#include "image/compare.h"
#include "render/hall.h"
#include "render/harness.h"
#include "support/must.h"

#include <memory>
#include <optional>
#include <string>

namespace glint::testing {
namespace {

constexpr std::uint32_t kFilteredWidth = 64;
constexpr std::uint32_t kFilteredHeight = 36;
constexpr std::uint32_t kFilteredSamples = 4;

// A mirror floor, walls side by side and a fence with holes of a pixel: filters that take edges for noise
// blur them.
class FilteredHall : public ::testing::Test {
protected:
    void load(std::vector<std::string> layers) {
        compiler::CompileSettings settings;
        settings.layers = std::move(layers);
        settings.effects = {false, compiler::builtinEffects(
                                       {"shadow", "ambient-occlusion", "reflection", "indirect-diffuse"})};
        loaded_.emplace(hallScene(), settings);
        RendererOptions options;
        options.width = kFilteredWidth;
        options.height = kFilteredHeight;
        options.accumulate = true;
        renderer_ = loaded_->makeRenderer(options);
        frame_ = defaultSetup(hallScene(), kFilteredWidth, kFilteredHeight).frame;
    }

    Result<std::unique_ptr<denoise::Denoiser>> makeDenoiser() const {
        denoise::FilterSettings settings;
        settings.samples = kFilteredSamples;
        return denoise::Denoiser::create(sharedContext(), *renderer_, kFilteredWidth, kFilteredHeight,
                                         settings);
    }

    LinearImage picture(std::uint32_t seed, std::uint32_t samples) {
        frame_.seed = seed;
        return drawn(*renderer_, frame_, samples);
    }

    std::optional<LoadedScene> loaded_;
    std::unique_ptr<Renderer> renderer_;
    FrameOptions frame_;
};

TEST_F(FilteredHall, KeepsItsEdgesAndConverges) {
    std::vector<std::string> layers = denoise::wantedLayers();
    layers.emplace_back("virtual-motion");
    load(layers);
    const LinearImage truth = picture(1000, 512);
    const auto errorOf = [&](const LinearImage& image) {
        return image::measureErrors(image, truth, 0.0).relMse;
    };
    const double plain = errorOf(picture(1, kFilteredSamples));
    const auto denoiser = must(makeDenoiser());
    const LinearImage first = must(denoiser->filter());
    EXPECT_LT(errorOf(first), 1.6 * plain) << "edges were taken for noise";
    EXPECT_GT(denoiser->milliseconds(), 0.0);
    std::optional<LinearImage> last;
    for (std::uint32_t i = 2; i <= 16; ++i) {
        picture(i, kFilteredSamples);
        LinearImage filtered = must(denoiser->filter());
        last = std::move(filtered);
    }
    EXPECT_LT(errorOf(*last), 0.5 * plain);
    // After a restart nothing is left of the frames before.
    denoiser->restart();
    picture(1, kFilteredSamples);
    const LinearImage again = must(denoiser->filter());
    expectSameImage(again, first, "after a restart");
}

TEST_F(FilteredHall, SaysWhichLayerIsMissing) {
    load({"depth", "normal", "motion", "emission", "demodulated", "variance"});
    const Diagnostic denoiser = mustFail(makeDenoiser());
    EXPECT_EQ(denoiser.id, "layer-missing");
    EXPECT_NE(denoiser.message.find("roughness"), std::string::npos) << denoiser.message;
}

}  // namespace
}  // namespace glint::testing
