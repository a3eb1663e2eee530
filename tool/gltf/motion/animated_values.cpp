#include "gltf/motion/animated_values.h"

#include "gltf/import.h"
#include "gltf/motion/animatable.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace glint::gltf {

namespace {

void extend(ValueRange& range, double value) {
    range.low = std::min(range.low, value);
    range.high = std::max(range.high, value);
}

// Extends the range by every value of one number of a sampler. A cubic spline exceeds the values of its
// keyframes by at most 4/27 of each tangent times the seconds between them, because 4/27 is the largest value
// of t (1 - t)^2.
void extend(ValueRange& range, const AnimationSampler& sampler, std::size_t number) {
    const bool cubic = sampler.interpolation == Interpolation::CubicSpline;
    const std::size_t parts = cubic ? 3 : 1;
    double seconds = 0.0;
    for (std::size_t i = 0; cubic && i + 1 < sampler.times.size(); ++i) {
        seconds = std::max<double>(seconds, sampler.times[i + 1] - sampler.times[i]);
    }
    double overshoot = 0.0;
    ValueRange values = range;
    for (std::size_t i = 0; i < sampler.times.size(); ++i) {
        const float* const keyframe = &sampler.values[parts * i * sampler.width];
        extend(values, keyframe[(cubic ? 1 : 0) * sampler.width + number]);
        if (cubic) {
            overshoot = std::max({overshoot, std::abs(double{keyframe[number]}),
                                  std::abs(double{keyframe[2 * sampler.width + number]})});
        }
    }
    const double beyond = 2.0 * 4.0 / 27.0 * overshoot * seconds;
    range = {values.low - beyond, values.high + beyond};
}

const AnimationSampler& samplerOf(const Animation& animation, const AnimationChannel& channel) {
    return animation.samplers[static_cast<std::size_t>(channel.sampler)];
}

// Calls `use(channel, sampler)` for each channel of that path.
template <typename Use>
void forEachChannel(const Scene& scene, AnimationPath path, const Use& use) {
    for (const Animation& animation : scene.animations) {
        for (const AnimationChannel& channel : animation.channels) {
            if (channel.path == path) {
                use(channel, samplerOf(animation, channel));
            }
        }
    }
}

bool drives(const Scene& scene, AnimationPath path) {
    bool found = false;
    forEachChannel(scene, path, [&](const AnimationChannel&, const AnimationSampler&) { found = true; });
    return found;
}

// The key is (index into Scene::animatedMaterials, property). The value has a range for each number of the
// property.
using MaterialRanges = std::map<std::pair<int, int>, std::vector<ValueRange>>;

MaterialRanges materialRanges(const Scene& scene) {
    MaterialRanges all;
    forEachChannel(scene, AnimationPath::Material,
                   [&](const AnimationChannel& channel, const AnimationSampler& sampler) {
                       std::vector<ValueRange>& ranges = all[{channel.target, channel.property}];
                       const materials::Material& rest =
                           scene.animatedMaterials[static_cast<std::size_t>(channel.target)].rest;
                       for (std::size_t i = ranges.size(); i < sampler.width; ++i) {
                           const double value = materialPropertyValue(rest, channel.property, i);
                           ranges.push_back({value, value});
                       }
                       for (std::size_t i = 0; i < sampler.width; ++i) {
                           extend(ranges[i], sampler, i);
                       }
                   });
    return all;
}

std::string describe(const materials::MaterialModel& model, int property,
                     const std::vector<ValueRange>& ranges) {
    std::string text = materialPropertyName(model, property);
    for (const ValueRange& range : ranges) {
        text +=
            fmt::format("{}{:.4g} to {:.4g}", &range == ranges.data() ? " " : ", ", range.low, range.high);
    }
    return text;
}

void settleMaterials(Scene& scene) {
    for (AnimatedMaterial& animated : scene.animatedMaterials) {
        animated.planned = animated.rest;
    }
    for (const auto& [place, ranges] : materialRanges(scene)) {
        AnimatedMaterial& animated = scene.animatedMaterials[static_cast<std::size_t>(place.first)];
        bool varies = false;
        for (std::size_t i = 0; i < ranges.size(); ++i) {
            varies = setPropertyRange(animated.planned, place.second, i, ranges[i]) || varies;
        }
        if (varies) {
            animated.changes.push_back(describe(animated.rest.model(), place.second, ranges));
        }
    }
}

void settleVisibility(Scene& scene) {
    std::vector<bool> canBeVisible;
    canBeVisible.reserve(scene.nodes.size());
    for (const Node& node : scene.nodes) {
        canBeVisible.push_back(node.visible);
    }
    forEachChannel(
        scene, AnimationPath::Visible, [&](const AnimationChannel& channel, const AnimationSampler& sampler) {
            const bool shows = std::ranges::any_of(sampler.values, [](float value) { return value != 0.0F; });
            const auto node = static_cast<std::size_t>(channel.target);
            canBeVisible[node] = canBeVisible[node] || shows;
        });
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        Node& node = scene.nodes[i];
        const Node* const parent =
            node.parent < 0 ? nullptr : &scene.nodes[static_cast<std::size_t>(node.parent)];
        node.shown = node.visible && (parent == nullptr || parent->shown);
        node.canShow = canBeVisible[i] && (parent == nullptr || parent->canShow);
    }
}

// A light can shine if its intensity and its colour are above 0 at some time, not necessarily at the same
// time.
void settleLights(Scene& scene) {
    std::vector<std::array<bool, 2>> positive;  // intensity, colour
    for (const Light& light : scene.lights) {
        positive.push_back({light.intensity > 0.0F,
                            std::ranges::any_of(light.color, [](float channel) { return channel > 0.0F; })});
    }
    const std::optional<int> intensity = findLightProperty("intensity");
    const std::optional<int> color = findLightProperty("color");
    forEachChannel(scene, AnimationPath::Light,
                   [&](const AnimationChannel& channel, const AnimationSampler& sampler) {
                       const bool isColor = channel.property == *color;
                       if (isColor || channel.property == *intensity) {
                           ValueRange range;
                           for (std::size_t i = 0; i < sampler.width; ++i) {
                               extend(range, sampler, i);
                           }
                           bool& known = positive[static_cast<std::size_t>(channel.target)][isColor ? 1 : 0];
                           known = known || range.high > 0.0;
                       }
                   });
    for (const Node& node : scene.nodes) {
        if (node.light >= 0) {
            const auto index = static_cast<std::size_t>(node.light);
            scene.lights[index].shown = node.shown;
            scene.lights[index].canShine = node.canShow && positive[index][0] && positive[index][1];
        }
    }
}

}  // namespace

std::vector<materials::Material> planningMaterials(const Scene& scene) {
    std::vector<materials::Material> materials = scene.materials;
    for (const AnimatedMaterial& animated : scene.animatedMaterials) {
        materials[static_cast<std::size_t>(animated.material)] = animated.planned;
    }
    return materials;
}

void settleAnimatedValues(Scene& scene) {
    settleMaterials(scene);
    settleVisibility(scene);
    settleLights(scene);
    if (drives(scene, AnimationPath::Light)) {
        scene.restLights = scene.lights;
    }
    if (drives(scene, AnimationPath::Camera)) {
        scene.restCameras = scene.cameras;
    }
}

}  // namespace glint::gltf
