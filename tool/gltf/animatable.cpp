#include "gltf/animatable.h"

#include "gltf/texture_places.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace glint {

namespace {

constexpr double kMax = std::numeric_limits<float>::max();

// 0 stands for an infinite index; nothing lies between it and 1.
double convertIor(double value) {
    return value == 0.0 ? 0.0 : std::max(value, 1.0);
}

// The importer reads distances in the same way: 0 means infinite, and a distance that is not above 0 becomes
// a micrometre.
double convertDistance(double value) {
    constexpr double kLeast = 1e-6;
    return value >= kMax ? 0.0 : std::max(value, kLeast);
}

double convertAngle(double value) {
    return std::remainder(value, 2.0 * std::numbers::pi);
}

using MaterialProperty = AnimatableProperty<Material, float>;
using LightProperty = AnimatableProperty<Light, float>;
using CameraProperty = AnimatableProperty<Camera, double>;

// The factors of the core and of the extensions that Glint shades.
constexpr MaterialProperty kFactors[] = {
    {"alphaCutoff", 1, 0.0, kMax, [](Material& m) { return &m.alphaCutoff; }},
    {"emissiveFactor", 3, 0.0, 1.0, [](Material& m) { return m.emissiveFactor.data(); }},
    {"normalTexture/scale", 1, -kMax, kMax, [](Material& m) { return &m.normalScale; }},
    {"occlusionTexture/strength", 1, 0.0, 1.0, [](Material& m) { return &m.occlusionStrength; }},
    {"pbrMetallicRoughness/baseColorFactor", 4, 0.0, 1.0,
     [](Material& m) { return m.baseColorFactor.data(); }},
    {"pbrMetallicRoughness/metallicFactor", 1, 0.0, 1.0, [](Material& m) { return &m.metallicFactor; }},
    {"pbrMetallicRoughness/roughnessFactor", 1, 0.0, 1.0, [](Material& m) { return &m.roughnessFactor; }},
    {"extensions/KHR_materials_anisotropy/anisotropyStrength", 1, 0.0, 1.0,
     [](Material& m) { return &m.anisotropy.strength; }},
    {"extensions/KHR_materials_anisotropy/anisotropyRotation", 1, -kMax, kMax,
     [](Material& m) { return &m.anisotropy.rotation; }, convertAngle},
    {"extensions/KHR_materials_clearcoat/clearcoatFactor", 1, 0.0, 1.0,
     [](Material& m) { return &m.clearcoat.factor; }},
    {"extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor", 1, 0.0, 1.0,
     [](Material& m) { return &m.clearcoat.roughnessFactor; }},
    {"extensions/KHR_materials_clearcoat/clearcoatNormalTexture/scale", 1, -kMax, kMax,
     [](Material& m) { return &m.clearcoat.normalScale; }},
    {"extensions/KHR_materials_diffuse_transmission/diffuseTransmissionFactor", 1, 0.0, 1.0,
     [](Material& m) { return &m.diffuseTransmission.factor; }},
    {"extensions/KHR_materials_diffuse_transmission/diffuseTransmissionColorFactor", 3, 0.0, 1.0,
     [](Material& m) { return m.diffuseTransmission.colorFactor.data(); }},
    {"extensions/KHR_materials_dispersion/dispersion", 1, 0.0, kMax,
     [](Material& m) { return &m.dispersion.dispersion; }},
    {"extensions/KHR_materials_emissive_strength/emissiveStrength", 1, 0.0, kMax,
     [](Material& m) { return &m.emissiveStrength; }},
    {"extensions/KHR_materials_ior/ior", 1, 0.0, kMax, [](Material& m) { return &m.ior.ior; }, convertIor},
    {"extensions/KHR_materials_iridescence/iridescenceFactor", 1, 0.0, 1.0,
     [](Material& m) { return &m.iridescence.factor; }},
    {"extensions/KHR_materials_iridescence/iridescenceIor", 1, 1.0, kMax,
     [](Material& m) { return &m.iridescence.ior; }},
    {"extensions/KHR_materials_iridescence/iridescenceThicknessMinimum", 1, 0.0, kMax,
     [](Material& m) { return &m.iridescence.thicknessMinimum; }},
    {"extensions/KHR_materials_iridescence/iridescenceThicknessMaximum", 1, 0.0, kMax,
     [](Material& m) { return &m.iridescence.thicknessMaximum; }},
    {"extensions/KHR_materials_pbrSpecularGlossiness/diffuseFactor", 4, 0.0, 1.0,
     [](Material& m) { return m.baseColorFactor.data(); }},
    {"extensions/KHR_materials_pbrSpecularGlossiness/specularFactor", 3, 0.0, 1.0,
     [](Material& m) { return m.specularGlossiness.specularFactor.data(); }},
    {"extensions/KHR_materials_pbrSpecularGlossiness/glossinessFactor", 1, 0.0, 1.0,
     [](Material& m) { return &m.specularGlossiness.glossinessFactor; }},
    {"extensions/KHR_materials_sheen/sheenColorFactor", 3, 0.0, 1.0,
     [](Material& m) { return m.sheen.colorFactor.data(); }},
    {"extensions/KHR_materials_sheen/sheenRoughnessFactor", 1, 0.0, 1.0,
     [](Material& m) { return &m.sheen.roughnessFactor; }},
    {"extensions/KHR_materials_specular/specularFactor", 1, 0.0, 1.0,
     [](Material& m) { return &m.specular.factor; }},
    {"extensions/KHR_materials_specular/specularColorFactor", 3, 0.0, kMax,
     [](Material& m) { return m.specular.colorFactor.data(); }},
    {"extensions/KHR_materials_transmission/transmissionFactor", 1, 0.0, 1.0,
     [](Material& m) { return &m.transmission.factor; }},
    {"extensions/KHR_materials_volume/thicknessFactor", 1, 0.0, kMax,
     [](Material& m) { return &m.volume.thicknessFactor; }},
    {"extensions/KHR_materials_volume/attenuationDistance", 1, 0.0, kMax,
     [](Material& m) { return &m.volume.attenuationDistance; }, convertDistance},
    {"extensions/KHR_materials_volume/attenuationColor", 3, 0.0, 1.0,
     [](Material& m) { return m.volume.attenuationColor.data(); }},
};
constexpr int kFactorCount = static_cast<int>(std::size(kFactors));

constexpr LightProperty kLightValues[] = {
    {"color", 3, 0.0, kMax, [](Light& light) { return light.color.data(); }},
    {"intensity", 1, 0.0, kMax, [](Light& light) { return &light.intensity; }},
    {"range", 1, 0.0, kMax, [](Light& light) { return &light.range; }},
    {"spot/innerConeAngle", 1, 0.0, std::numbers::pi / 2, [](Light& light) { return &light.innerConeAngle; }},
    {"spot/outerConeAngle", 1, 0.0, std::numbers::pi / 2, [](Light& light) { return &light.outerConeAngle; }},
};

// The importer refuses lenses beyond these bounds, and an animation stops at them.
constexpr double kLeastLens = 1e-4;
constexpr CameraProperty kCameras[] = {
    {"perspective/yfov", 1, kLeastLens, std::numbers::pi - kLeastLens, [](Camera& c) { return &c.yfov; }},
    {"perspective/znear", 1, kLeastLens, kMax, [](Camera& c) { return &c.znear; }},
    {"perspective/zfar", 1, kLeastLens, kMax, [](Camera& c) { return &c.zfar; }},
    {"orthographic/xmag", 1, kLeastLens, kMax, [](Camera& c) { return &c.xmag; },
     [](double v) { return std::abs(v); }},
    {"orthographic/ymag", 1, kLeastLens, kMax, [](Camera& c) { return &c.ymag; },
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

// Each slot has three properties of KHR_texture_transform. They come after the factors.
enum TransformPart : int { kOffset = 0, kRotation = 1, kScale = 2 };
constexpr std::string_view kTransformParts[] = {"offset", "rotation", "scale"};
constexpr int kPartCount = 3;

bool isFactor(int property) {
    return property < kFactorCount;
}

int partOf(int property) {
    return (property - kFactorCount) % kPartCount;
}

const gltf::TexturePlace& placeOf(int property) {
    return gltf::texturePlaces()[static_cast<std::size_t>((property - kFactorCount) / kPartCount)];
}

std::string transformName(const gltf::TexturePlace& place, std::string_view part) {
    const std::string_view owner = place.owner;
    const std::string_view prefix = owner.starts_with("KHR_") ? "extensions/" : "";
    return fmt::format("{}{}{}{}/extensions/KHR_texture_transform/{}", prefix, owner,
                       owner.empty() ? "" : "/", place.member, part);
}

// Returns the first number of a material property.
float* firstOf(Material& material, int property) {
    if (isFactor(property)) {
        return kFactors[property].first(material);
    }
    TextureTransform& transform = material.texture(placeOf(property).slot).transform;
    switch (partOf(property)) {
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

// Returns the value as the material stores it.
float heldValue(int property, double value) {
    return static_cast<float>(isFactor(property) ? settled(kFactors[property], value)
                                                 : std::clamp(value, -kMax, kMax));
}

bool isNamed(int property, std::string_view name) {
    return isFactor(property) && kFactors[property].name == name;
}

// A material reads only one of the two base models.
bool isRead(const Material& material, int property) {
    if (!isFactor(property)) {
        return true;
    }
    const std::string_view name = kFactors[property].name;
    const bool glossy = material.specularGlossiness.given && !material.unlit;
    return name.starts_with("pbrMetallicRoughness/")                             ? !glossy
           : name.starts_with("extensions/KHR_materials_pbrSpecularGlossiness/") ? glossy
                                                                                 : true;
}

}  // namespace

std::optional<int> findMaterialProperty(std::string_view name) {
    if (const std::optional<int> factor = findByName(kFactors, name)) {
        return factor;
    }
    const auto places = gltf::texturePlaces();
    for (std::size_t place = 0; place < places.size(); ++place) {
        for (int part = 0; part < kPartCount; ++part) {
            if (transformName(places[place], kTransformParts[part]) == name) {
                return kFactorCount + kPartCount * static_cast<int>(place) + part;
            }
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

int materialPropertyCount() {
    return kFactorCount + kPartCount * static_cast<int>(gltf::texturePlaces().size());
}

std::string materialPropertyName(int property) {
    const std::string name = isFactor(property)
                                 ? std::string(kFactors[property].name)
                                 : transformName(placeOf(property), kTransformParts[partOf(property)]);
    constexpr std::string_view kExtensions = "extensions/";
    return name.starts_with(kExtensions) ? name.substr(kExtensions.size()) : name;
}

std::size_t materialPropertyWidth(int property) {
    return isFactor(property) ? kFactors[property].width : partOf(property) == kRotation ? 1 : 2;
}

std::size_t lightPropertyWidth(int property) {
    return kLightValues[property].width;
}

void setMaterialProperty(Material& material, int property, std::span<const double> values) {
    if (!isRead(material, property)) {
        return;
    }
    float* const numbers = firstOf(material, property);
    for (std::size_t i = 0; i < values.size(); ++i) {
        numbers[i] = heldValue(property, values[i]);
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
        camera.zfar = std::max({camera.zfar, kLeastDepth * camera.znear, camera.znear + kLeastLens});
    }
}

double materialPropertyValue(const Material& material, int property, std::size_t number) {
    Material copy = material;
    const float value = firstOf(copy, property)[number];
    const bool infinite =
        value == 0.0F && isNamed(property, "extensions/KHR_materials_volume/attenuationDistance");
    return infinite ? kMax : value;
}

bool setGenericValue(Material& material, int property, std::size_t number, ValueRange range) {
    const float low = heldValue(property, range.low);
    const float high = heldValue(property, range.high);
    if (range.low == range.high || !isRead(material, property)) {
        return false;
    }
    float& target = firstOf(material, property)[number];
    const bool isIor = isNamed(property, "extensions/KHR_materials_ior/ior");
    if (low == high && !isIor) {
        target = low;
        return false;
    }
    // The alpha is compared with the cut-off. The highest cut-off and the lowest alpha cut most.
    if (isNamed(property, "alphaCutoff")) {
        target = high;
        return true;
    }
    if (number == 3) {
        target = low;
        return true;
    }
    // Each number has a fraction of its own, so that two numbers that vary are not taken for equal. The
    // normal textures of base and coat would be otherwise. No value may be 0, 1 or 1.5, at which rules call
    // features neutral.
    double fraction = 0.437 + 0.001 * property + 0.0001 * static_cast<double>(number);
    const double from = isIor ? std::max<double>(low, 1.0) : low;
    const double to = isIor ? std::max<double>(high, from + 1.0) : high;
    float value = static_cast<float>(from + fraction * (to - from));
    while (value == 0.0F || value == 1.0F || value == 1.5F) {
        fraction *= 0.9;
        value = static_cast<float>(from + fraction * (to - from));
    }
    target = value;
    return true;
}

void setSmoothestValue(Material& material, int property, ValueRange range) {
    if (!isRead(material, property)) {
        return;
    }
    if (isNamed(property, "pbrMetallicRoughness/roughnessFactor") ||
        isNamed(property, "extensions/KHR_materials_clearcoat/clearcoatRoughnessFactor")) {
        *firstOf(material, property) = heldValue(property, range.low);
    }
    if (isNamed(property, "extensions/KHR_materials_pbrSpecularGlossiness/glossinessFactor")) {
        *firstOf(material, property) = heldValue(property, range.high);
    }
}

}  // namespace glint
