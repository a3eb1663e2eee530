#include "gltf/motion/animatable.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
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

// Returns the first number of a material property.
float* firstOf(materials::Material& material, int property) {
    const materials::MaterialModel& model = material.model();
    if (const materials::Parameter* parameter = parameterOf(model, property)) {
        return &material.values[static_cast<std::size_t>(parameter->first)];
    }
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
float heldValue(const materials::Parameter* parameter, double value) {
    if (parameter == nullptr) {
        return static_cast<float>(std::clamp(value, -kMax, kMax));
    }
    return parameter->hold(value == parameter->also ? std::clamp(value, parameter->low, parameter->high)
                                                    : value);
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

bool isFixed(const materials::Material& material, int property) {
    const materials::Parameter* const parameter = parameterOf(material.model(), property);
    return parameter != nullptr && parameter->also &&
           material.values[static_cast<std::size_t>(parameter->first)] == *parameter->also;
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
    return parameter != nullptr                   ? static_cast<std::size_t>(parameter->channels)
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
    float* const numbers = firstOf(material, property);
    for (std::size_t i = 0; i < values.size(); ++i) {
        numbers[i] = heldValue(parameterOf(material.model(), property), values[i]);
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
    materials::Material copy = material;
    return firstOf(copy, property)[number];
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
        for (const float value : material.values) {
            material.ranges.push_back({value, value});
        }
    }
    const bool turns = parameter->isAngle && varies;
    const materials::ValueInterval held{heldValue(parameter, range.low), heldValue(parameter, range.high)};
    material.ranges[static_cast<std::size_t>(parameter->first) + number] =
        turns ? materials::ValueInterval{-std::numbers::pi, std::numbers::pi}
              : materials::hull({held.low, held.low}, {held.high, held.high});
    // Values that are clamped to one are always the same.
    return turns || held.low != held.high;
}

}  // namespace glint::gltf
