// Defines which properties of materials, lights and cameras animations can change (KHR_animation_pointer),
// and finds the values that they can have. Tables list them by the names that the glTF 2.0 Asset Object Model
// gives them.
#pragma once

#include "gltf/scene.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace glint::gltf {

// The numbers of a property are adjacent in its object. Values outside [low, high] are clamped.
template <typename Object, typename Number>
struct AnimatableProperty {
    std::string_view name;  // below the object: "pbrMetallicRoughness/metallicFactor"
    std::size_t width = 1;
    double low = 0.0;
    double high = 1.0;
    Number* (*first)(Object&) = nullptr;
    // Converts a value for which clamping is not enough. Null means that clamping is enough.
    double (*convert)(double value) = nullptr;
};

// AnimationChannel::property numbers the properties below. A material's parameters come first, in the order
// of its model, then its texture transforms. Each place of a texture has three of those, in this order:
// offset, rotation, scale.

std::optional<int> findMaterialProperty(const materials::MaterialModel& model, std::string_view name);
std::optional<int> findLightProperty(std::string_view name);
// `name` starts with the camera's type: "perspective/yfov".
std::optional<int> findCameraProperty(std::string_view name);

// All numbers of material properties are below this.
int materialPropertyCount(const materials::MaterialModel& model);
// Returns the name without "extensions/" at its start.
std::string materialPropertyName(const materials::MaterialModel& model, int property);

// Returns why no animation may change the property; empty if one may.
std::string notAnimated(const materials::MaterialModel& model, int property);

// Whether the property has the value outside of its range that its parameter takes, too. KHR_materials_ior
// calls that a mode, which no animation enters or leaves.
bool isFixed(const materials::Material& material, int property);

// Whether a keyframe may have the value. Others are clamped.
bool takesMaterialValue(const materials::MaterialModel& model, int property, double value);
bool takesLightValue(int property, double value);
bool takesCameraValue(int property, double value);

std::size_t materialPropertyWidth(const materials::MaterialModel& model, int property);
std::size_t lightPropertyWidth(int property);

// `values` has as many numbers as the property is wide. If the material does not read the base model of the
// property, the property stays as it is.
void setMaterialProperty(materials::Material& material, int property, std::span<const double> values);
void setLightProperty(Light& light, int property, std::span<const double> values);
void setCameraProperty(Camera& camera, int property, double value);

// These make values consistent that are animated separately: the inner and the outer angle of a cone, and the
// two clipping planes of a camera.
void settleLight(Light& light);
void settleCamera(Camera& camera);

// The least and the greatest value of one number of a property.
struct ValueRange {
    double low = 0.0;
    double high = 0.0;
};

// Returns the number that the material has.
double materialPropertyValue(const materials::Material& material, int property, std::size_t number);

// `range` bounds all values that the number takes. Planning reads the range in place of the value. Returns
// false if the number is always the same.
bool setPropertyRange(materials::Material& material, int property, std::size_t number, ValueRange range);

// Fills AnimatedMaterial::planned and changes, Node::canShow, Light::canShine, and the visibility
// of nodes and lights at rest. The animations must have been imported.
void settleAnimatedValues(Scene& scene);

}  // namespace glint::gltf
