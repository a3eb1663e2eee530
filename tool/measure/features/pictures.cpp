// Pictures of a feature's lobe, for people.
#include "measure/features/checks.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace glint::measure {

namespace {

constexpr std::uint32_t kDiscSide = 128;
constexpr std::uint32_t kSphereSide = 96;
constexpr std::uint32_t kSphereSamples = 64;
// The grey of a white furnace: a gain of energy is brighter than the background.
constexpr float kFurnaceGrey = 0.5F;
// Above this, where noise can't be the reason, pixels of the sphere are red.
constexpr double kMadeLight = 1.02;

LinearImage blankImage(std::uint32_t width, std::uint32_t height, float grey) {
    return {width, height,
            std::vector<std::array<float, 4>>(std::size_t{width} * height, {grey, grey, grey, 1.0F})};
}

// A place of a disc with radius 1, or nothing outside of it.
struct DiscPlace {
    double x = 0.0;
    double y = 0.0;
    std::size_t pixel = 0;

    double radius() const {
        return std::hypot(x, y);
    }
    double azimuth() const {
        return std::atan2(y, x);
    }
};

std::vector<DiscPlace> discPlaces(std::uint32_t side, std::uint32_t left, std::uint32_t width) {
    std::vector<DiscPlace> places;
    for (std::uint32_t row = 0; row < side; ++row) {
        for (std::uint32_t column = 0; column < side; ++column) {
            const double x = (column + 0.5) / side * 2.1 - 1.05;
            const double y = 1.05 - (row + 0.5) / side * 2.1;
            if (std::hypot(x, y) < 1.0) {
                places.push_back({x, y, std::size_t{row} * width + left + column});
            }
        }
    }
    return places;
}

// Paints the lobe's reflection in each direction above the surface, seen from straight above the surface, in
// an equal-area map. The views lie to the right of the centre. The brightest hundredth of the directions is
// white.
Result<FeaturePicture> paintLobe(const FeatureOnDevice& on) {
    constexpr double kViews[] = {0.1, 0.7, 1.3};
    LinearImage image = blankImage(std::size(kViews) * kDiscSide, kDiscSide, 0.0F);
    std::vector<compiler::FeatureKernelInput> inputs;
    std::vector<std::size_t> pixels;
    for (std::uint32_t number = 0; number < std::size(kViews); ++number) {
        for (const DiscPlace& place : discPlaces(kDiscSide, number * kDiscSide, image.width)) {
            const double radius = place.radius();
            const double across = std::sqrt(2.0 - radius * radius);
            inputs.push_back(inputOf(on, on.feature.materials.front(), tiltedDirection(kViews[number], 0.0),
                                     {across * place.x, across * place.y, 1.0 - radius * radius}));
            pixels.push_back(place.pixel);
        }
    }
    GLINT_TRY(const auto outputs, on.evaluator.run(inputs));
    std::vector<float> brightness;
    for (const compiler::FeatureKernelOutput& output : outputs) {
        brightness.push_back(*std::ranges::max_element(output.reflected));
    }
    std::ranges::sort(brightness);
    const float white = std::max(brightness[brightness.size() * 99 / 100], 1e-6F);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        for (std::size_t channel = 0; channel < 3; ++channel) {
            // Zero stays distinguishable from the background.
            image.pixels[pixels[i]][channel] = 0.03F + 0.75F * outputs[i].reflected[channel] / white;
        }
    }
    return FeaturePicture{on.feature.code->name + "_lobe", std::move(image)};
}

// A sphere of the material under a white sky, by samples of the whole BSDF. The sphere of a material that
// reflects all light can't be seen.
Result<FeaturePicture> paintFurnace(const FeatureOnDevice& on) {
    LinearImage image = blankImage(kSphereSide, kSphereSide, kFurnaceGrey);
    const FeatureOnDevice whole{on.evaluator, on.scene, on.feature, 0, on.samples};
    const std::vector<DiscPlace> places = discPlaces(kSphereSide, 0, kSphereSide);
    std::vector<compiler::FeatureKernelInput> inputs;
    for (const DiscPlace& place : places) {
        for (std::uint32_t k = 0; k < kSphereSamples; ++k) {
            compiler::FeatureKernelInput input =
                inputOf(whole, on.feature.materials.front(),
                        tiltedDirection(std::asin(place.radius()), place.azimuth()), {0, 0, 1});
            input.mode = compiler::kKernelSamples;
            const std::array<double, 3> u = randomNumbers(place.pixel * kSphereSamples + k, 7);
            std::ranges::transform(u, input.random, [](double value) { return static_cast<float>(value); });
            inputs.push_back(input);
        }
    }
    GLINT_TRY(const auto outputs, on.evaluator.run(inputs));
    for (std::size_t i = 0; i < places.size(); ++i) {
        std::array<float, 4>& pixel = image.pixels[places[i].pixel];
        double made = 0.0;
        for (std::size_t channel = 0; channel < 3; ++channel) {
            double sum = 0.0;
            double squares = 0.0;
            for (std::uint32_t k = 0; k < kSphereSamples; ++k) {
                const double weight = static_cast<double>(outputs[i * kSphereSamples + k].weight[channel]);
                sum += weight / kSphereSamples;
                squares += weight * weight / kSphereSamples;
            }
            const double error = std::sqrt(std::max(squares - sum * sum, 0.0) / kSphereSamples);
            made = std::max(made, sum - 4.0 * error);
            pixel[channel] = kFurnaceGrey * static_cast<float>(sum);
        }
        if (made > kMadeLight) {
            pixel = {1.0F, 0.0F, 0.0F, 1.0F};
        }
    }
    return FeaturePicture{on.feature.code->name + "_furnace", std::move(image)};
}

}  // namespace

Result<std::vector<FeaturePicture>> paintFeature(const FeatureOnDevice& on) {
    std::vector<FeaturePicture> pictures;
    for (Result<FeaturePicture> (*const paint)(const FeatureOnDevice&) : {paintLobe, paintFurnace}) {
        GLINT_TRY(auto picture, paint(on));
        pictures.push_back(std::move(picture));
    }
    return pictures;
}

}  // namespace glint::measure
