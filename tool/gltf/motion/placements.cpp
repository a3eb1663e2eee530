// Imports cameras and lights where a node places them.
#include "gltf/motion/nodes.h"
#include "gltf/motion/transform.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace glint::gltf {

namespace {

// Warns if a light's value is out of range. Returns the value to use.
double clampLight(Document& document, const std::string& pointer, double value, double low, double high) {
    const double clamped = std::clamp(value, low, high);
    if (clamped != value) {
        document.warn("light-range", pointer, fmt::format("is {}; {} is used", value, clamped),
                      "correct the light's value");
    }
    return clamped;
}

double numberOr(const Json& object, std::string_view name, double fallback) {
    const Json* member = find(object, name);
    return member == nullptr ? fallback : member->get<double>();
}

Matrix4 poseOf(Document& document, const std::string& pointer, const Matrix4& world) {
    if (const auto rigid = rigidPart(world)) {
        return *rigid;
    }
    document.warn("pose-degenerate", pointer,
                  "its node's scale leaves no direction; the world's axes are used",
                  "give the node a scale that is not zero");
    Matrix4 pose = identity();
    std::copy(world.begin() + 12, world.begin() + 15, pose.begin() + 12);
    return pose;
}

void readSpot(Document& document, const Json& json, const std::string& pointer, Light& light) {
    constexpr double kRightAngle = std::numbers::pi / 2;
    const Json* spot = find(json, "spot");
    if (spot == nullptr) {
        document.warn("light-range", pointer, "is a spot light without \"spot\"; its angles are the defaults",
                      "give the light its angles");
    }
    const Json empty = Json::object();
    const Json& angles = spot == nullptr ? empty : *spot;
    const double outer =
        clampLight(document, pointer + "/spot/outerConeAngle",
                   numberOr(angles, "outerConeAngle", std::numbers::pi / 4), 0.0, kRightAngle);
    const double given = numberOr(angles, "innerConeAngle", 0.0);
    const double inner = clampLight(document, pointer + "/spot/innerConeAngle", given, 0.0, outer);
    light.outerConeAngle = static_cast<float>(outer);
    light.innerConeAngle = static_cast<float>(inner);
    if (given == outer) {
        document.warn("light-range", pointer + "/spot",
                      "the inner angle is no smaller than the outer one: the cone has a sharp edge",
                      "make innerConeAngle smaller than outerConeAngle");
    }
}

// Returns the range in metres. 0 means unlimited: the file gives none, or none that is above 0.
float readRange(Document& document, const Json& json, const std::string& pointer) {
    const Json* range = find(json, "range");
    const double metres = range == nullptr ? 0.0 : range->get<double>();
    if (range != nullptr && metres <= 0.0) {
        document.warn("light-range", pointer, fmt::format("is {}; the light's range is unlimited", metres),
                      "use more than 0, or leave it out");
    }
    return static_cast<float>(std::max(metres, 0.0));
}

// Values above 1 stay, because a clamped channel would change the hue.
float readChannel(Document& document, const std::string& pointer, double value) {
    if (value > 1.0) {
        document.warn("light-range", pointer, fmt::format("is {}, above 1; it is used as it is", value),
                      "scale the colour down and the intensity up");
        return static_cast<float>(value);
    }
    return static_cast<float>(clampLight(document, pointer, value, 0.0, 1.0));
}

}  // namespace

Result<Camera> importCamera(Document& document, int index, const Matrix4& world) {
    const Json& source = document.json()["cameras"][static_cast<std::size_t>(index)];
    const std::string type = textMember(source, "type");
    const Json& lens = source[type];
    const std::string pointer = fmt::format("/cameras/{}/{}", index, type);
    const auto fail = [&](const char* member, const char* rule, double value) {
        return document.error("camera-range", fmt::format("{}/{}", pointer, member),
                              fmt::format("is {}; it must be {}", value, rule), "correct the camera");
    };
    Camera camera;
    camera.name = textMember(source, "name");
    camera.world = poseOf(document, fmt::format("/cameras/{}", index), world);
    camera.orthographic = type == "orthographic";
    camera.znear = lens["znear"].get<double>();
    const Json* const zfar = find(lens, "zfar");
    camera.zfar = zfar == nullptr ? 0.0 : zfar->get<double>();
    if (camera.orthographic) {
        const auto xmag = lens["xmag"].get<double>();
        const auto ymag = lens["ymag"].get<double>();
        camera.xmag = std::abs(xmag);
        camera.ymag = std::abs(ymag);
        if (camera.xmag == 0.0 || camera.ymag == 0.0) {
            return fail(camera.xmag == 0.0 ? "xmag" : "ymag", "other than 0", 0.0);
        }
        if (xmag < 0.0 || ymag < 0.0) {
            document.warn("camera-range", pointer, "has a negative magnification; its size is used");
        }
        if (camera.znear < 0.0) {
            return fail("znear", "0 or more", camera.znear);
        }
    } else {
        camera.yfov = lens["yfov"].get<double>();
        if (camera.yfov <= 0.0 || camera.yfov >= std::numbers::pi) {
            return fail("yfov", "between 0 and pi", camera.yfov);
        }
        if (camera.znear <= 0.0) {
            return fail("znear", "above 0", camera.znear);
        }
    }
    if (zfar != nullptr && camera.zfar <= camera.znear) {
        return fail("zfar", "above znear", camera.zfar);
    }
    return camera;
}

Result<Light> importLight(Document& document, int index, const Matrix4& world) {
    const std::string pointer = fmt::format("/extensions/KHR_lights_punctual/lights/{}", index);
    const Json& json =
        document.json()["extensions"]["KHR_lights_punctual"]["lights"][static_cast<std::size_t>(index)];
    Light light;
    light.name = textMember(json, "name");
    const std::string& type = json["type"].get_ref<const std::string&>();
    if (type == "spot") {
        light.type = LightType::Spot;
        readSpot(document, json, pointer, light);
    } else if (type == "point") {
        light.type = LightType::Point;
    } else if (type != "directional") {
        return document.error("light-type", pointer + "/type",
                              fmt::format("\"{}\" is no type of light", type),
                              "use directional, point or spot");
    }
    constexpr double kLargest = std::numeric_limits<float>::max();
    light.intensity = static_cast<float>(
        clampLight(document, pointer + "/intensity", numberOr(json, "intensity", 1.0), 0.0, kLargest));
    light.range = readRange(document, json, pointer + "/range");
    if (light.type == LightType::Directional && light.range > 0.0F) {
        document.warn("light-range", pointer + "/range", "a directional light has no range; it is ignored",
                      "leave the range out, or use a point or spot light");
        light.range = 0.0F;
    }
    if (const Json* color = find(json, "color")) {
        for (std::size_t i = 0; i < 3; ++i) {
            light.color[i] =
                readChannel(document, fmt::format("{}/color/{}", pointer, i), (*color)[i].get<double>());
        }
    }
    light.position = {world[12], world[13], world[14]};
    if (light.type != LightType::Point) {
        const auto axis = normalized({-world[8], -world[9], -world[10]});
        if (!axis) {
            document.warn("pose-degenerate", pointer, "its node's scale leaves no direction; -Z is used",
                          "give the node a scale that is not zero");
        }
        const glm::dvec3 direction = axis.value_or(glm::dvec3{0.0, 0.0, -1.0});
        light.direction = {static_cast<float>(direction[0]), static_cast<float>(direction[1]),
                           static_cast<float>(direction[2])};
    }
    return light;
}

}  // namespace glint::gltf
