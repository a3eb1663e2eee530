#include "gltf/motion/animatable.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

namespace glint::gltf {

namespace {

constexpr double kMax = std::numeric_limits<float>::max();

using LightProperty = AnimatableProperty<Light, float>;
using CameraProperty = AnimatableProperty<Camera, double>;

constexpr LightProperty kLightValues[] = {
    {"color", 3, 0.0, kMax, [](Light& light) { return light.color.data(); }},
    {"intensity", 1, 0.0, kMax, [](Light& light) { return &light.intensity; }},
    {"range", 1, 0.0, kMax, [](Light& light) { return &light.range; }},
    {"spot/innerConeAngle", 1, 0.0, std::numbers::pi / 2, [](Light& light) { return &light.innerConeAngle; }},
    {"spot/outerConeAngle", 1, 0.0, std::numbers::pi / 2, [](Light& light) { return &light.outerConeAngle; }},
};

// The importer refuses lenses beyond these bounds, and an animation stops at them. A length may be small,
// because scenes may be.
constexpr double kLeastLens = 1e-4;  // radians
constexpr double kLeastLength = 1e-12;
constexpr CameraProperty kCameras[] = {
    {"perspective/yfov", 1, kLeastLens, std::numbers::pi - kLeastLens, [](Camera& c) { return &c.yfov; }},
    {"perspective/znear", 1, kLeastLength, kMax, [](Camera& c) { return &c.znear; }},
    {"perspective/zfar", 1, kLeastLength, kMax, [](Camera& c) { return &c.zfar; }},
    {"orthographic/xmag", 1, kLeastLength, kMax, [](Camera& c) { return &c.xmag; },
     [](double v) { return std::abs(v); }},
    {"orthographic/ymag", 1, kLeastLength, kMax, [](Camera& c) { return &c.ymag; },
     [](double v) { return std::abs(v); }},
    {"orthographic/znear", 1, 0.0, kMax, [](Camera& c) { return &c.znear; }},
    {"orthographic/zfar", 1, 0.0, kMax, [](Camera& c) { return &c.zfar; }},
};

template <typename Object, typename Number, std::size_t Count>
std::optional<int> findByName(const AnimatableProperty<Object, Number> (&table)[Count],
                              std::string_view name) {
    const auto found = std::ranges::find(table, name, &AnimatableProperty<Object, Number>::name);
    return found == std::end(table) ? std::nullopt
                                    : std::optional(static_cast<int>(found - std::begin(table)));
}

// Each place of a texture has three properties of KHR_texture_transform. They come after the parameters.
enum TransformPart : int { kOffset = 0, kRotation = 1, kScale = 2 };
constexpr std::string_view kTransformParts[] = {"offset", "rotation", "scale"};
constexpr int kPartCount = 3;

// A texture's place in the JSON of a material.
struct TexturePlace {
    int texture = 0;
    const materials::MaterialTexture::Place* place = nullptr;
};

std::vector<TexturePlace> texturePlaces(const materials::MaterialModel& model) {
    std::vector<TexturePlace> places;
    for (std::size_t i = 0; i < model.textures.size(); ++i) {
        for (const materials::MaterialTexture::Place& place : model.textures[i].places) {
            places.push_back({static_cast<int>(i), &place});
        }
    }
    return places;
}

int parameterCount(const materials::MaterialModel& model) {
    return static_cast<int>(model.parameters.size());
}

// Returns the parameter, or null if the property is a transform.
const materials::Parameter* parameterOf(const materials::MaterialModel& model, int property) {
    return property < parameterCount(model) ? &model.parameters[static_cast<std::size_t>(property)] : nullptr;
}

int partOf(const materials::MaterialModel& model, int property) {
    return (property - parameterCount(model)) % kPartCount;
}

TexturePlace placeOf(const materials::MaterialModel& model, int property) {
    return texturePlaces(model)[static_cast<std::size_t>((property - parameterCount(model)) / kPartCount)];
}

std::string pathOf(const materials::MaterialModel& model, int object, std::string_view place) {
    const materials::MaterialObject& row = model.objects[static_cast<std::size_t>(object)];
    return fmt::format("{}{}{}{}", row.isExtension ? "extensions/" : "", row.name,
                       row.name.empty() ? "" : "/", place);
}

std::string propertyPath(const materials::MaterialModel& model, int property) {
    if (const materials::Parameter* parameter = parameterOf(model, property)) {
        return pathOf(model, parameter->object, parameter->place);
    }
    const materials::MaterialTexture::Place& place = *placeOf(model, property).place;
    return pathOf(model, place.object,
                  fmt::format("{}/extensions/KHR_texture_transform/{}", place.member,
                              kTransformParts[partOf(model, property)]));
}

// Returns the first number of a texture's transform.
float* firstOfTransform(materials::Material& material, int property) {
    const materials::MaterialModel& model = material.model();
    materials::TextureTransform& transform =
        material.textures[static_cast<std::size_t>(placeOf(model, property).texture)].transform;
    switch (partOf(model, property)) {
        case kOffset:
            return transform.offset.data();
        case kRotation:
            return &transform.rotation;
        default:
            return transform.scale.data();
    }
}

template <typename Object, typename Number>
double settled(const AnimatableProperty<Object, Number>& row, double value) {
    const double converted = row.convert == nullptr ? value : row.convert(value);
    return std::clamp(converted, row.low, row.high);
}

// Returns the value as the material stores it while an animation plays, which never is Parameter::also.
double heldValue(const materials::Parameter& parameter, double value) {
    return parameter.hold(value == parameter.also ? std::clamp(value, parameter.low, parameter.high) : value);
}

// A material reads only one of the two base models.
bool isRead(const materials::Material& material, int property) {
    const materials::Parameter* const parameter = parameterOf(material.model(), property);
    return parameter == nullptr || material.reads(parameter->object);
}

}  // namespace

std::optional<int> findMaterialProperty(const materials::MaterialModel& model, std::string_view name) {
    for (int property = 0; property < materialPropertyCount(model); ++property) {
        if (propertyPath(model, property) == name) {
            return property;
        }
    }
    return std::nullopt;
}

std::optional<int> findLightProperty(std::string_view name) {
    return findByName(kLightValues, name);
}

std::optional<int> findCameraProperty(std::string_view name) {
    return findByName(kCameras, name);
}

int materialPropertyCount(const materials::MaterialModel& model) {
    return parameterCount(model) + kPartCount * static_cast<int>(texturePlaces(model).size());
}

std::string materialPropertyName(const materials::MaterialModel& model, int property) {
    const std::string name = propertyPath(model, property);
    constexpr std::string_view kExtensions = "extensions/";
    return name.starts_with(kExtensions) ? name.substr(kExtensions.size()) : name;
}

std::string notAnimated(const materials::MaterialModel& model, int property) {
    const materials::Parameter* const parameter = parameterOf(model, property);
    return parameter == nullptr || parameter->isVector()
               ? std::string()
               : fmt::format("has the type {}; animations change floats and vectors of them",
                             parameter->typeText());
}

bool isFixed(const materials::Material& material, int property) {
    const materials::Parameter* const parameter = parameterOf(material.model(), property);
    return parameter != nullptr && parameter->also && material.values.of(*parameter)[0] == *parameter->also;
}

bool takesMaterialValue(const materials::MaterialModel& model, int property, double value) {
    const materials::Parameter* const parameter = parameterOf(model, property);
    return parameter == nullptr || parameter->isAngle ||
           (value >= parameter->low && value <= parameter->high);
}

bool takesLightValue(int property, double value) {
    // A float rounds the right angle up.
    return std::abs(settled(kLightValues[property], value) - value) <= 1e-6;
}

bool takesCameraValue(int property, double value) {
    return settled(kCameras[property], value) ==
           (kCameras[property].convert == nullptr ? value : std::abs(value));
}

std::size_t materialPropertyWidth(const materials::MaterialModel& model, int property) {
    const materials::Parameter* const parameter = parameterOf(model, property);
    return parameter != nullptr                   ? static_cast<std::size_t>(parameter->numbers)
           : partOf(model, property) == kRotation ? 1U
                                                  : 2U;
}

std::size_t lightPropertyWidth(int property) {
    return kLightValues[property].width;
}

void setMaterialProperty(materials::Material& material, int property, std::span<const double> values) {
    if (!isRead(material, property)) {
        return;
    }
    const materials::Parameter* const parameter = parameterOf(material.model(), property);
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (parameter != nullptr) {
            material.values.of(*parameter)[i] = heldValue(*parameter, values[i]);
        } else {
            firstOfTransform(material, property)[i] = static_cast<float>(std::clamp(values[i], -kMax, kMax));
        }
    }
}

void setLightProperty(Light& light, int property, std::span<const double> values) {
    float* const numbers = kLightValues[property].first(light);
    for (std::size_t i = 0; i < values.size(); ++i) {
        numbers[i] = static_cast<float>(settled(kLightValues[property], values[i]));
    }
}

void setCameraProperty(Camera& camera, int property, double value) {
    *kCameras[property].first(camera) = settled(kCameras[property], value);
}

void settleLight(Light& light) {
    light.innerConeAngle = std::min(light.innerConeAngle, light.outerConeAngle);
}

void settleCamera(Camera& camera) {
    // This leaves a little depth, because 0 would mean an infinite distance.
    constexpr double kLeastDepth = 1.001;
    if (camera.zfar > 0.0 || camera.orthographic) {
        camera.zfar = std::max({camera.zfar, kLeastDepth * camera.znear, camera.znear + kLeastLength});
    }
}

double materialPropertyValue(const materials::Material& material, int property, std::size_t number) {
    if (const materials::Parameter* const parameter = parameterOf(material.model(), property)) {
        return material.values.of(*parameter)[number];
    }
    materials::Material copy = material;
    return firstOfTransform(copy, property)[number];
}

bool setPropertyRange(materials::Material& material, int property, std::size_t number, ValueRange range) {
    if (!isRead(material, property)) {
        return false;
    }
    const materials::MaterialModel& model = material.model();
    const bool varies = range.low != range.high;
    const materials::Parameter* const parameter = parameterOf(model, property);
    if (parameter == nullptr) {
        materials::TextureInfo& info =
            material.textures[static_cast<std::size_t>(placeOf(model, property).texture)];
        const int part = partOf(model, property);
        info.moves = info.moves || varies;
        info.turns = info.turns || (varies && (part == kRotation || (part == kScale && range.low < 0.0)));
        return varies;
    }
    if (material.ranges.empty()) {
        material.ranges = rangesOf(material);
    }
    const bool turns = parameter->isAngle && varies;
    const materials::ValueInterval held{heldValue(*parameter, range.low), heldValue(*parameter, range.high)};
    material.ranges[static_cast<std::size_t>(parameter->first) + number] =
        turns ? materials::ValueInterval{-std::numbers::pi, std::numbers::pi}
              : materials::hull({held.low, held.low}, {held.high, held.high});
    // Values that are clamped to one are always the same.
    return turns || held.low != held.high;
}

// ---- The values that animations can give a scene over all times ----

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
