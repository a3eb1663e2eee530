// The table of views, and the function by which each shows its layers.
#include "plan/cost.h"

#include <glint/internal/package_modules.h>
#include <glint/measure/views.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <utility>

namespace glint::measure {

namespace {

using Marks = std::map<std::uint32_t, ViewCategory>;

// Marks of pixels without a value. Shader IDs, materials and counts are below them.
enum Mark : std::uint32_t {
    kMarkSurfaceless = 0xFFFFFF00,
    kMarkRayless,
    kMarkSky,
    kMarkScreen,
    kMarkUntextured,
    kMarkUngrouped,
    kMarkEqual,
    kMarkNotFinite,
};

constexpr std::uint32_t kNoLayerValue = 0xFFFFFFFF;

const ViewCategory& plain(Mark mark) {
    // Shades of grey, which no palette has.
    static const Marks kPlain = {
        {kMarkSurfaceless, {"no surface", {24, 24, 24}}},
        {kMarkRayless, {"no ray", {64, 64, 64}}},
        {kMarkSky, {"left the scene", {150, 150, 150}}},
        {kMarkScreen, {"found on screen", {210, 210, 210}}},
        {kMarkUntextured, {"no texture", {100, 100, 100}}},
        {kMarkUngrouped, {"no workgroup known", {110, 110, 110}}},
        {kMarkEqual, {"up to 0.0001", {64, 64, 64}}},
        {kMarkNotFinite, {"not finite", {255, 0, 255}}},
    };
    return kPlain.at(mark);
}

class Filler {
public:
    Filler(const ViewInput& input, ViewValues& values) : values_(values) {
        const std::size_t pixels = std::size_t{input.width} * input.height;
        values.numbers.assign(pixels, 0.0);
        values.marks.assign(pixels, ViewValues::kNumber);
    }

    void number(std::size_t pixel, double value) {
        values_.numbers[pixel] = value;
    }
    void mark(std::size_t pixel, Mark mark) {
        values_.marks[pixel] = mark;
        values_.categories.try_emplace(mark, plain(mark));
    }
    // A category with a colour by its number.
    void category(std::size_t pixel, std::uint32_t number, const std::function<std::string()>& name) {
        values_.marks[pixel] = number;
        if (!values_.categories.contains(number)) {
            values_.categories.emplace(number, ViewCategory{name(), image::categoryColor(number)});
        }
    }
    void category(std::size_t pixel, std::uint32_t number, std::string_view name, image::Color8 color) {
        values_.marks[pixel] = number;
        values_.categories.try_emplace(number, ViewCategory{std::string(name), color});
    }
    void oneOfMany(std::size_t pixel, std::uint32_t number, const std::function<std::string()>& name) {
        category(pixel, number, name);
        values_.categories.at(number).isOneOfMany = true;
    }
    std::size_t size() const {
        return values_.marks.size();
    }

    // Calls show(pixel, value) for each pixel of a layer that has a value. The others have no surface.
    template <typename Show>
    void eachSurface(const std::vector<std::uint32_t>& layer, const Show& show) {
        for (std::size_t i = 0; i < size(); ++i) {
            if (layer[i] == kNoLayerValue) {
                mark(i, kMarkSurfaceless);
            } else {
                show(i, layer[i]);
            }
        }
    }
    // Calls show(pixel, shader) for each pixel whose ray has a hit with a shader. The others are marked.
    template <typename Show>
    void eachHit(const std::vector<std::uint32_t>& shaders, const Show& show) {
        for (std::size_t i = 0; i < size(); ++i) {
            switch (shaders[i]) {
                case package::kNoRay:
                    mark(i, kMarkRayless);
                    break;
                case package::kRayLeftScene:
                    mark(i, kMarkSky);
                    break;
                case package::kRayEndedOnScreen:
                    mark(i, kMarkScreen);
                    break;
                default:
                    show(i, shaders[i]);
            }
        }
    }

private:
    ViewValues& values_;
};

const std::vector<std::uint32_t>& integersOf(const ViewInput& input, const char* layer) {
    return input.layers.at(layer).integers;
}

std::string caseName(const ViewInput& input, std::uint32_t shaderId) {
    const std::span<const package::CaseEntry> cases = input.package->cases();
    if (shaderId >= cases.size()) {
        return fmt::format("shader {}: no case", shaderId);
    }
    return fmt::format("{} {}", shaderId, input.package->string(cases[shaderId].name));
}

void showShaders(const ViewInput& input, ViewValues& values) {
    Filler filler(input, values);
    filler.eachSurface(integersOf(input, "shader"), [&](std::size_t i, std::uint32_t shader) {
        filler.category(i, shader, [&] { return caseName(input, shader); });
    });
}

void showMaterials(const ViewInput& input, ViewValues& values) {
    Filler filler(input, values);
    filler.eachSurface(integersOf(input, "material"), [&](std::size_t i, std::uint32_t number) {
        filler.category(i, number, [&] {
            const bool isNamed = number < input.materialNames.size() && !input.materialNames[number].empty();
            return isNamed ? fmt::format("{} {}", number, input.materialNames[number])
                           : fmt::format("material {}", number);
        });
    });
}

// A set of lobes, with the model of a pack, has the place among those of the scene as its number, so that its
// colour depends on the scene alone.
void showKeys(const ViewInput& input, ViewValues& values) {
    constexpr std::uint32_t kBaseAlone = 0x10000;  // no set of lobes has this number
    Filler filler(input, values);
    using LobesAndModel = std::pair<std::uint32_t, std::uint32_t>;
    std::set<LobesAndModel> known;
    std::map<std::uint32_t, std::uint32_t> models;  // by material
    for (const package::PrimitiveEntry& primitive : input.package->scene(input.scene).primitives) {
        known.emplace(primitive.key.lobes, primitive.key.model);
        models[primitive.materialIndex] = primitive.key.model;
    }
    const std::vector<std::uint32_t>& lobes = integersOf(input, "lobes");
    const std::vector<std::uint32_t>& materials = integersOf(input, "material");
    const auto keyOf = [&](std::size_t i) {
        const auto model = models.find(materials[i]);
        return LobesAndModel(lobes[i], model == models.end() ? 0 : model->second);
    };
    filler.eachSurface(lobes, [&](std::size_t i, std::uint32_t) { known.insert(keyOf(i)); });
    known.erase({0, 0});
    const std::vector<LobesAndModel> ordered(known.begin(), known.end());
    filler.eachSurface(lobes, [&](std::size_t i, std::uint32_t set) {
        const LobesAndModel key = keyOf(i);
        if (key == LobesAndModel(0, 0)) {
            filler.category(i, kBaseAlone, "base alone", {44, 52, 66});
            return;
        }
        const auto place = std::ranges::lower_bound(ordered, key) - ordered.begin();
        filler.category(i, static_cast<std::uint32_t>(place), [&] {
            return fmt::format("{}", fmt::join(input.package->featureNames({set, 0, key.second}), " "));
        });
    });
}

void showNonFinite(const ViewInput& input, ViewValues& values) {
    Filler filler(input, values);
    const std::vector<std::uint32_t>& counts = integersOf(input, "non-finite");
    for (std::size_t i = 0; i < filler.size(); ++i) {
        const bool isNan = counts[i] % package::kInfiniteSample > 0;
        const bool isInfinite = counts[i] >= package::kInfiniteSample;
        if (isNan) {
            filler.category(i, 2, "not a number", image::categoryColor(5));
        } else if (isInfinite) {
            filler.category(i, 1, "infinite", image::categoryColor(3));
        } else {
            filler.category(i, 0, "finite", {40, 60, 80});
        }
    }
}

// Shows the only layer, a count over all samples, as the count of one sample.
void showCount(const ViewInput& input, ViewValues& values) {
    Filler filler(input, values);
    const std::vector<std::uint32_t>& counts = input.layers.begin()->second.integers;
    for (std::size_t i = 0; i < filler.size(); ++i) {
        filler.number(i, static_cast<double>(counts[i]) / input.samples);
    }
}

void showDistance(const ViewInput& input, ViewValues& values) {
    constexpr float kMiss = 65504.0F;
    Filler filler(input, values);
    const std::vector<float>& distances = input.layers.at("distance").reals;
    for (std::size_t i = 0; i < filler.size(); ++i) {
        if (distances[i] <= 0.0F) {
            filler.mark(i, kMarkRayless);
        } else if (distances[i] >= kMiss) {
            filler.mark(i, kMarkSky);
        } else {
            filler.number(i, distances[i]);
        }
    }
}

void showHitShaders(const ViewInput& input, ViewValues& values) {
    Filler filler(input, values);
    filler.eachHit(integersOf(input, "hit-shader"), [&](std::size_t i, std::uint32_t shader) {
        filler.category(i, shader, [&] { return caseName(input, shader); });
    });
}

void showFallbacks(const ViewInput& input, ViewValues& values) {
    Filler filler(input, values);
    const std::span<const package::CaseEntry> cases = input.package->cases();
    filler.eachHit(integersOf(input, "hit-shader"), [&](std::size_t i, std::uint32_t shader) {
        if (shader < cases.size() && cases[shader].keyCount > 0) {
            filler.category(i, 0, "has a case", image::categoryColor(4));
        } else if (input.package->shape().fallback) {
            filler.category(i, 1, "fallback", image::categoryColor(0));
        } else {
            filler.category(i, 2, "no case: magenta", {255, 0, 255});
        }
    });
}

void showDivergence(const ViewInput& input, ViewValues& values) {
    Filler filler(input, values);
    const std::vector<std::uint32_t>& run = integersOf(input, "cases-run");
    filler.eachHit(integersOf(input, "hit-shader"), [&](std::size_t i, std::uint32_t) {
        if (run[i] == kNoLayerValue) {
            filler.mark(i, kMarkUngrouped);
        } else {
            filler.number(i, run[i]);
        }
    });
}

// Workgroups of one dispatch, and of the dispatches of the cases, have different numbers.
void showGroups(const ViewInput& input, ViewValues& values) {
    Filler filler(input, values);
    const std::vector<std::uint32_t>& groups = integersOf(input, "workgroup");
    const std::vector<std::uint32_t>& shaders = integersOf(input, "hit-shader");
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> numbers;
    for (std::size_t i = 0; i < filler.size(); ++i) {
        if (groups[i] != kNoLayerValue) {
            numbers.emplace(std::pair(input.dispatchesCases ? shaders[i] : 0U, groups[i]), 0U);
        }
    }
    std::uint32_t next = 0;
    for (auto& [group, number] : numbers) {
        number = next++;
    }
    filler.eachHit(shaders, [&](std::size_t i, std::uint32_t shader) {
        if (groups[i] == kNoLayerValue) {
            filler.mark(i, kMarkUngrouped);
            return;
        }
        const std::pair group(input.dispatchesCases ? shader : 0U, groups[i]);
        filler.oneOfMany(i, numbers.at(group), [&] {
            return input.dispatchesCases ? fmt::format("group {} of shader {}", group.second, group.first)
                                         : fmt::format("group {}", group.second);
        });
    });
}

void showBranches(const ViewInput& input, ViewValues& values) {
    Filler filler(input, values);
    filler.eachSurface(integersOf(input, "branches"),
                       [&](std::size_t i, std::uint32_t branches) { filler.number(i, branches); });
}

double weightOfFeatures(const materials::FeatureMask& always, const materials::FeatureMask& sometimes,
                        const ViewInput& input) {
    const compiler::CodeEstimate code = compiler::estimateCode(always, sometimes, *input.model);
    return code.instructions + compiler::kFetchCost * code.fetches;
}

// Shows the model's cost of shading a pixel: of its surface by its material's key, and of the hits of all
// effects by their cases.
void showCost(const ViewInput& input, ViewValues& values) {
    Filler filler(input, values);
    std::map<std::uint32_t, double> ofMaterial;
    for (const package::PrimitiveEntry& primitive : input.package->scene(input.scene).primitives) {
        const materials::FeatureMask key = input.model->maskOf(primitive.key);
        double& weight = ofMaterial[primitive.materialIndex];
        weight = std::max(weight, weightOfFeatures(key, 0, input));
    }
    std::vector<double> ofCase;
    for (const package::CaseEntry& entry : input.package->cases()) {
        ofCase.push_back(
            weightOfFeatures(input.model->maskOf(entry.always), input.model->maskOf(entry.sometimes), input));
    }
    std::vector<const std::vector<std::uint32_t>*> hits;  // of each effect
    for (const auto& [name, layer] : input.layers) {
        if (name.ends_with(".hit-shader")) {
            hits.push_back(&layer.integers);
        }
    }
    filler.eachSurface(integersOf(input, "material"), [&](std::size_t i, std::uint32_t material) {
        double weight = ofMaterial[material];
        for (const std::vector<std::uint32_t>* const shaders : hits) {
            const std::uint32_t shader = (*shaders)[i];
            weight += shader < ofCase.size() ? ofCase[shader] : 0.0;
        }
        filler.number(i, weight);
    });
}

void showTextureLevel(const ViewInput& input, ViewValues& values) {
    constexpr float kUntextured = 65504.0F;
    Filler filler(input, values);
    const std::vector<float>& levels = input.layers.at("texture-level").reals;
    const std::vector<float>& footprints = input.layers.at("footprint").reals;
    for (std::size_t i = 0; i < filler.size(); ++i) {
        if (footprints[i] <= 0.0F) {
            filler.mark(i, kMarkSurfaceless);
        } else if (levels[i] >= kUntextured) {
            filler.mark(i, kMarkUntextured);
        } else {
            filler.number(i, levels[i]);
        }
    }
}

void showFootprint(const ViewInput& input, ViewValues& values) {
    Filler filler(input, values);
    const std::vector<float>& footprints = input.layers.at("footprint").reals;
    for (std::size_t i = 0; i < filler.size(); ++i) {
        if (footprints[i] <= 0.0F) {
            filler.mark(i, kMarkSurfaceless);
        } else {
            filler.number(i, footprints[i]);
        }
    }
}

// The error of a pixel is that of `glint compare`: the largest of the channels, |a - b| / max(1, |b|).
void showDifference(const ViewInput& input, ViewValues& values) {
    constexpr double kEqual = 1e-4;  // strategies differ by no more
    Filler filler(input, values);
    for (std::size_t i = 0; i < filler.size(); ++i) {
        double largest = 0.0;
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const double a = input.picture->pixels[i][channel];
            const double b = input.reference->pixels[i][channel];
            const double error = std::abs(a - b) / std::max(1.0, std::abs(b));
            largest =
                std::isfinite(error) ? std::max(largest, error) : std::numeric_limits<double>::infinity();
            if (!std::isfinite(error)) {
                break;
            }
        }
        if (!std::isfinite(largest)) {
            filler.mark(i, kMarkNotFinite);
        } else if (largest <= kEqual) {
            filler.mark(i, kMarkEqual);
        } else {
            filler.number(i, largest);
        }
    }
}

ViewInfo view(std::string_view name, std::string_view what, ViewScale scale, std::string_view unit,
              std::vector<std::string_view> layers, decltype(ViewInfo::evaluate) evaluate,
              bool readsReference = false, std::string_view everySource = {}) {
    return {name, what, scale, unit, std::move(layers), evaluate, readsReference, everySource};
}

// To add a view, add a row here, and its picture to docs/views.md.
const std::vector<ViewInfo>& rows() {
    using enum ViewScale;
    static const std::vector<ViewInfo> kRows = {
        view("shader", "case that shades the material where rays hit it", Categories, "case", {"shader"},
             showShaders),
        view("key", "model of a pack and set of lobes of the surface's key", Categories, "lobes",
             {"lobes", "material"}, showKeys),
        view("material", "material of the surface", Categories, "material", {"material"}, showMaterials),
        view("hit-shader", "case that shades what the ray hits", Categories, "case", {"hit-shader"},
             showHitShaders),
        view("fallback", "hits that the fallback shades, and hits without a case", Categories, "hits",
             {"hit-shader"}, showFallbacks),
        view("bucket", "workgroup that shades the hit; neighbours in order have different colours",
             Categories, "workgroup", {"workgroup", "hit-shader"}, showGroups),
        view("divergence", "cases that the hit's subgroup runs one after the other", FromOne, "cases",
             {"cases-run", "hit-shader"}, showDivergence),
        view("branches", "optional features that the shading runs for the pixel's subgroup", FromZero,
             "features", {"branches"}, showBranches),
        view("rays", "rays that are traced for the pixel", FromZero, "rays a sample", {"rays"}, showCount),
        view("candidates", "triangles whose alpha these rays test", FromZero, "tests a sample",
             {"candidates"}, showCount),
        view("cost", "instructions that shade the surface and what its rays hit, by the cost model", FromZero,
             "instructions", {"material"}, showCost, false, "hit-shader"),
        view("clocks", "ticks of the device's clock for shading and tracing", Logarithmic, "ticks a sample",
             {"clocks"}, showCount),
        view("texture-level", "finest level of the surface's textures; below 0 they are magnified", Linear,
             "levels", {"texture-level", "footprint"}, showTextureLevel),
        view("footprint", "width of the pixel on the surface", Logarithmic, "metres", {"footprint"},
             showFootprint),
        view("hit-distance", "distance that the ray travels", Logarithmic, "metres", {"distance"},
             showDistance),
        view("non-finite", "samples that are not a number or infinite, and count as black", Categories,
             "pixels", {"non-finite"}, showNonFinite),
        view("difference", "relative error against the picture of --view-reference", Logarithmic,
             "relative error", {}, showDifference, true),
    };
    return kRows;
}

}  // namespace

std::span<const ViewInfo> viewTable() {
    return rows();
}

const ViewInfo* findView(std::string_view name) {
    const auto found = std::ranges::find(rows(), name, &ViewInfo::name);
    return found == rows().end() ? nullptr : &*found;
}

bool isOfRays(const ViewInfo& info) {
    return std::ranges::any_of(
        info.layers, [](std::string_view layer) { return package::hasSources(*package::findLayer(layer)); });
}

}  // namespace glint::measure
