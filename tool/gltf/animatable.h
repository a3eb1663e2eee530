// What animations can change of materials, lights and cameras (KHR_animation_pointer): tables of properties
// by the names that the glTF 2.0 Asset Object Model gives them.
#pragma once

#include "gltf/scene.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace glint {

// A property's numbers lie one after the other in its object; values outside of [low, high] are clamped.
template <typename Object, typename Number>
struct AnimatableProperty {
    std::string_view name;  // below the object: "pbrMetallicRoughness/metallicFactor"
    std::size_t width = 1;
    double low = 0.0;
    double high = 1.0;
    Number* (*first)(Object&) = nullptr;
    // Of a value that is not to be clamped alone; null: as it is.
    double (*convert)(double value) = nullptr;
};

// Numbers of the properties below are AnimationChannel::property. Those of materials go from the factors on
// to the texture transforms, of which each slot has three in this order: offset, rotation, scale.

std::optional<int> findMaterialProperty(std::string_view name);
std::optional<int> findLightProperty(std::string_view name);
// `name` starts with the camera's type: "perspective/yfov".
std::optional<int> findCameraProperty(std::string_view name);

// Properties of a material are numbered below this.
int materialPropertyCount();
// Without the "extensions/" at its start.
std::string materialPropertyName(int property);

std::size_t materialPropertyWidth(int property);
std::size_t lightPropertyWidth(int property);

// `values`: as many as the property is wide. A material keeps what KHR_materials_pbrSpecularGlossiness or its
// absence leaves unread.
void setMaterialProperty(Material& material, int property, std::span<const double> values);
void setLightProperty(Light& light, int property, std::span<const double> values);
void setCameraProperty(Camera& camera, int property, double value);

// Makes values agree that are animated apart: the inner angle of a cone with the outer one, the planes of a
// camera.
void settleLight(Light& light);
void settleCamera(Camera& camera);

// The least and the greatest value of one number of a property.
struct ValueRange {
    double low = 0.0;
    double high = 0.0;
};

// The number that the material has. An infinite attenuation distance is the largest float.
double materialPropertyValue(const Material& material, int property, std::size_t number);

// Sets a number that takes all values of the range to one between its ends at which no feature is neutral, or
// to the value that it always has. Returns false where it is always the same.
bool setGenericValue(Material& material, int property, std::size_t number, ValueRange range);
// Roughness to its least, glossiness to its greatest; other properties stay.
void setSmoothestValue(Material& material, int property, ValueRange range);

}  // namespace glint
