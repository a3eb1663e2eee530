#include "base/lists.h"
#include "emit/compile.h"
#include "emit/feature_kernel.h"
#include "materials/declarations.h"
#include "measure/features/checks.h"
#include "resolve/resolve.h"

#include <glint/measure/check_materials.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <numbers>

namespace glint::measure {

namespace {

// Directions of one dispatch: some 20 MiB go in and out.
constexpr std::size_t kMostOfRun = 1U << 17U;

// The package of the checked scene: as few modules as packages have.
compiler::CompileSettings checkedSettings() {
    compiler::CompileSettings settings;
    settings.strategies = package::kDefaultStrategy;
    settings.tracers = package::kTracerRayQuery;
    settings.plan.merge = compiler::MergePolicy::All;
    settings.effects = {};
    settings.emitHeader = false;
    return settings;
}

}  // namespace

Result<std::unique_ptr<FeatureEvaluator>> FeatureEvaluator::create(const gltf::Scene& scene,
                                                                   const CheckMaterialsOptions& options,
                                                                   const Observer& observer) {
    std::unique_ptr<FeatureEvaluator> evaluator(new FeatureEvaluator);
    HeadlessOptions device;
    device.validation = options.validate ? Validation::Synchronization : Validation::Off;
    device.deviceName = options.device;
    GLINT_TRY(evaluator->context_, Context::createHeadless(device));

    observer.progress("compiling");
    compiler::CompileSettings settings = checkedSettings();
    settings.jobs = options.jobs;
    if ((evaluator->context_->handles().tracers & package::kTracerRayQuery) == 0) {
        settings.tracers = package::kTracerRayPipeline;
    }
    GLINT_TRY(const auto build, compiler::resolve(std::span(&scene, 1), settings));
    GLINT_TRY(auto package, session::compileAndLoad(build));
    GLINT_TRY(auto kernel, compileFeatureKernel(build));
    evaluator->lobes_ = std::move(kernel.lobes);

    observer.progress("making the pipeline");
    session::SceneViewData data = session::makeSceneView(scene);
    data.vertices = SceneView::VertexForm::Full;  // frames of surfaces are compared exactly
    GLINT_TRY(evaluator->scene_,
              session::DeviceScene::upload(*evaluator->context_, std::move(package), std::move(data)));
    GLINT_TRY(evaluator->kernel_, SceneKernel::create(*evaluator->scene_.gpu, kernel.spirv));
    return evaluator;
}

std::uint32_t FeatureEvaluator::lobeOf(const std::string& feature) const {
    const auto found = std::ranges::find(lobes_, feature);
    return found == lobes_.end() ? 0 : static_cast<std::uint32_t>(found - lobes_.begin()) + 1;
}

Result<std::vector<compiler::FeatureKernelOutput>> FeatureEvaluator::run(
    std::span<const compiler::FeatureKernelInput> inputs) const {
    std::vector<compiler::FeatureKernelOutput> outputs(inputs.size());
    constexpr std::size_t kWordsIn = sizeof(compiler::FeatureKernelInput) / sizeof(std::uint32_t);
    constexpr std::size_t kWordsOut = sizeof(compiler::FeatureKernelOutput) / sizeof(std::uint32_t);
    for (std::size_t first = 0; first < inputs.size(); first += kMostOfRun) {
        const std::size_t count = std::min(kMostOfRun, inputs.size() - first);
        std::vector<std::uint32_t> words(count * kWordsIn);
        std::memcpy(words.data(), inputs.data() + first, count * sizeof(compiler::FeatureKernelInput));
        GLINT_TRY(const auto found,
                  kernel_->run(words, static_cast<std::uint32_t>(count), count * kWordsOut));
        std::memcpy(static_cast<void*>(outputs.data() + first), found.data(),
                    count * sizeof(compiler::FeatureKernelOutput));
    }
    return outputs;
}

std::string FeatureEvaluator::deviceName() const {
    return context_->deviceName();
}

Status FeatureEvaluator::validate(const Observer& observer) const {
    return checkValidation(observer, *context_);
}

namespace {

// The description of a check.
struct CheckInfo {
    MaterialCheck check;
    const char* name;
    const char* quantity;
    const char* id;        // of the diagnostic
    const char* function;  // of the layer "wax": {}Density(); those of other features have none
    const char* meaning;   // for a picture
};
constexpr CheckInfo kCheckInfos[] = {
    {MaterialCheck::Range, "range", "distance from the range", "check-range", "",
     "pixels would be black or wrong, and the light of all samples with them"},
    {MaterialCheck::Density, "density",
     "distance of the integral and the lost samples from one, beyond noise", "check-density", "{}Density()",
     "light that is sampled would be too bright or too dark by this factor"},
    {MaterialCheck::Samples, "samples", "probability of a difference like this by chance", "check-samples",
     "{}Sample()", "pictures would not converge to what the layer evaluates"},
    {MaterialCheck::Reciprocity, "reciprocity", "difference as a share of the lobe", "check-reciprocity",
     "{}Evaluate()",
     "the declaration claims that it is reciprocal; light paths and camera paths would differ"},
    {MaterialCheck::Energy, "energy",
     "light that is made, as a share of what comes in, beyond errors of quadrature", "check-energy", "",
     "light that bounces between such surfaces would grow"},
    {MaterialCheck::Albedo, "albedo", "difference of shares of a white sky, beyond errors of quadrature",
     "check-albedo", "{}Shares()", "the sky's light on it would differ from that of rays"},
};

const CheckInfo& infoOf(MaterialCheck check) {
    return *std::ranges::find(kCheckInfos, check, &CheckInfo::check);
}

Result<FeatureChecks> checkFeature(const FeatureOnDevice& on) {
    const materials::FeatureCode& code = *on.feature.code;
    FeatureChecks checks;
    checks.feature = code.name;
    checks.declaration = code.declaration;
    checks.isLobe = on.lobe != 0;
    checks.combinations = static_cast<std::uint32_t>(on.feature.materials.size());
    GLINT_TRY(auto ranges, checkRanges(on));
    GLINT_TRY(auto integrals, checkIntegrals(on));
    GLINT_TRY(auto reciprocity, checkReciprocity(on));
    if (integrals.energy.state == CheckState::Failed && !code.gains.empty()) {
        integrals.energy.state = CheckState::Waived;
        integrals.energy.message += fmt::format("; declared: {}", code.gains);
    }
    checks.outcomes = {std::move(ranges),      std::move(integrals.density), std::move(integrals.samples),
                       std::move(reciprocity), std::move(integrals.energy),  std::move(integrals.albedo)};
    return checks;
}

std::string textOfDirection(const Direction& direction) {
    const double angle = std::acos(std::clamp(direction[2], -1.0, 1.0)) * 180.0 / std::numbers::pi;
    return fmt::format("({:.4g}, {:.4g}, {:.4g}), {:.4g}° from the normal", direction[0], direction[1],
                       direction[2], angle);
}

std::string textOfPlace(const CheckPlace& place) {
    std::vector<std::string> values;
    for (const auto& [name, numbers] : place.parameters) {
        values.push_back(name == "textures" ? "its textures"
                                            : fmt::format("{} {:.6g}", name, fmt::join(numbers, ", ")));
    }
    std::string text = fmt::format("over a {}", place.base);
    text += values.empty() ? "" : fmt::format(" with {}", fmt::join(values, ", "));
    text += fmt::format(", seen from {}", textOfDirection(place.view));
    text += place.light ? fmt::format(", lit from {}", textOfDirection(*place.light)) : "";
    return text;
}

}  // namespace

std::string_view nameOf(MaterialCheck check) {
    return infoOf(check).name;
}

std::string_view quantityOf(MaterialCheck check) {
    return infoOf(check).quantity;
}

std::string_view nameOf(CheckState state) {
    constexpr std::string_view kNames[] = {"passed", "failed", "absent", "unasked", "unsure", "waived"};
    return kNames[static_cast<std::size_t>(state)];
}

bool FeatureChecks::failed() const {
    return std::ranges::find(outcomes, CheckState::Failed, &CheckOutcome::state) != outcomes.end();
}

Result<MaterialChecksReport> checkMaterials(const CheckMaterialsOptions& options, const Observer& observer) {
    GLINT_TRY(const auto model, materials::loadMaterialModel(options.packs));
    GLINT_TRY(const auto scene, makeCheckedScene(*model, options.combinations));
    GLINT_TRY(auto evaluator, FeatureEvaluator::create(scene.scene, options, observer));
    MaterialChecksReport report;
    report.device = evaluator->deviceName();
    report.samples = options.samples;
    for (const CheckedFeature& feature : scene.features) {
        observer.progress(fmt::format("checking {} of {}: {}", report.features.size() + 1,
                                      scene.features.size(), feature.code->name));
        const FeatureOnDevice on{*evaluator, scene, feature, evaluator->lobeOf(feature.code->name),
                                 options.samples};
        GLINT_TRY(auto checks, checkFeature(on));
        report.features.push_back(std::move(checks));
        if (options.pictures) {
            GLINT_TRY(auto pictures, paintFeature(on));
            std::ranges::move(pictures, std::back_inserter(report.pictures));
        }
    }
    observer.progress("");
    GLINT_TRY_DO(evaluator->validate(observer));
    return report;
}

std::vector<Diagnostic> failuresOf(const FeatureChecks& feature) {
    std::vector<Diagnostic> failures;
    for (const CheckOutcome& outcome : feature.outcomes) {
        if (outcome.state != CheckState::Failed) {
            continue;
        }
        const CheckInfo& info = infoOf(outcome.check);
        const std::string function = feature.isLobe && *info.function != '\0'
                                         ? fmt::format(fmt::runtime(info.function), feature.feature)
                                         : feature.feature;
        failures.push_back(makeError(info.id, feature.declaration,
                                     fmt::format("{}: {}, {}", function, outcome.message,
                                                 outcome.place ? textOfPlace(*outcome.place) : ""),
                                     info.meaning));
    }
    return failures;
}

// --- Pictures of a feature's lobe, for people ---

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
    auto brightness = base::mapped<float>(outputs, [](const compiler::FeatureKernelOutput& output) {
        return *std::ranges::max_element(output.reflected);
    });
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
