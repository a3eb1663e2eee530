#include "gltf/animations.h"

#include "gltf/accessor.h"
#include "gltf/node_numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace glint::gltf {

namespace {

constexpr const char* kExportAnimation = "export the animation again";

std::optional<AnimationPath> pathOf(const std::string& name) {
    if (name == "translation") {
        return AnimationPath::Translation;
    }
    if (name == "rotation") {
        return AnimationPath::Rotation;
    }
    if (name == "scale") {
        return AnimationPath::Scale;
    }
    return name == "weights" ? std::optional(AnimationPath::Weights) : std::nullopt;
}

std::optional<Interpolation> interpolationOf(const Json& sampler) {
    const Json* name = find(sampler, "interpolation");
    if (name == nullptr || *name == "LINEAR") {
        return Interpolation::Linear;
    }
    if (*name == "STEP") {
        return Interpolation::Step;
    }
    return *name == "CUBICSPLINE" ? std::optional(Interpolation::CubicSpline) : std::nullopt;
}

bool areFinite(const std::vector<float>& values) {
    return std::ranges::all_of(values, [](float value) { return std::isfinite(value); });
}

// What the keyframe times break of what AnimationSampler promises; empty: nothing.
std::string flawOfTimes(const FloatElements& times) {
    if (times.components != 1 || times.count == 0) {
        return "its times are no list of numbers";
    }
    if (!areFinite(times.values) || times.values.front() < 0.0F) {
        return "its times are negative or not finite";
    }
    return std::ranges::is_sorted(times.values, std::less_equal<>{}) ? "" : "its times do not ascend";
}

class AnimationReader {
public:
    AnimationReader(Document& document, const Scene& scene, const NodeNumbers& numbers, std::size_t index)
        : document_(document),
          scene_(scene),
          numbers_(numbers),
          json_(document.json()["animations"][index]),
          pointer_(fmt::format("/animations/{}", index)) {}

    Animation read() {
        if (const Json* name = find(json_, "name")) {
            animation_.name = name->get<std::string>();
        }
        const Json& channels = json_["channels"];
        for (std::size_t i = 0; i < channels.size(); ++i) {
            readChannel(channels[i], fmt::format("{}/channels/{}", pointer_, i));
        }
        for (const AnimationChannel& channel : animation_.channels) {
            const AnimationSampler& sampler = animation_.samplers[static_cast<std::size_t>(channel.sampler)];
            animation_.duration = std::max<double>(animation_.duration, sampler.times.back());
        }
        return std::move(animation_);
    }

private:
    void leaveOut(const std::string& pointer, const std::string& why) {
        document_.warn("animation-channel", pointer, why + "; the channel is not played", kExportAnimation);
    }

    // Values of a keyframe of that property; 0 where the node has no such property to animate.
    std::size_t widthOf(AnimationPath path, const Node& node, const std::string& pointer) {
        if (path == AnimationPath::Weights) {
            if (node.restWeights.empty()) {
                leaveOut(pointer, "animates the weights of a node whose mesh has no morph targets");
            }
            return node.restWeights.size();
        }
        if (node.matrix) {
            leaveOut(pointer, "animates a node whose transform is a matrix, which glTF forbids");
            return 0;
        }
        return path == AnimationPath::Rotation ? 4 : 3;
    }

    void readChannel(const Json& json, const std::string& pointer) {
        const Json& target = json["target"];
        const std::string& pathName = target["path"].get_ref<const std::string&>();
        if (pathName == "pointer" || findExtension(target, "KHR_animation_pointer") != nullptr) {
            if (!std::exchange(warnedOfPointer_, true)) {
                document_.warn("animation-pointer", pointer,
                               "what KHR_animation_pointer animates stays as it is",
                               "animate nodes or morph weights instead");
            }
            return;
        }
        const Json* inFile = find(target, "node");
        const int node = inFile == nullptr ? -1 : numbers_.inScene(inFile->get<int>());
        if (node < 0) {
            return;  // of an extension, or of a node that this scene does not draw
        }
        const std::optional<AnimationPath> path = pathOf(pathName);
        if (!path) {
            leaveOut(pointer + "/target/path", fmt::format("\"{}\" is no property of a node", pathName));
            return;
        }
        const std::size_t width = widthOf(*path, scene_.nodes[static_cast<std::size_t>(node)], pointer);
        const int sampler = width == 0 ? -1 : samplerOf(json, pointer, width);
        if (sampler >= 0) {
            animation_.channels.push_back({node, *path, sampler});
        }
    }

    // Index into animation_.samplers; -1 where there is none that can be used.
    int samplerOf(const Json& channel, const std::string& pointer, std::size_t width) {
        const auto inFile = channel["sampler"].get<std::size_t>();
        const Json& samplers = json_["samplers"];
        if (inFile >= samplers.size()) {
            leaveOut(pointer + "/sampler",
                     fmt::format("is {}, but the animation has {} samplers", inFile, samplers.size()));
            return -1;
        }
        const auto [known, isNew] = samplers_.try_emplace(std::pair(inFile, width), -1);
        if (!isNew) {
            return known->second;
        }
        std::optional<AnimationSampler> read =
            readSampler(samplers[inFile], fmt::format("{}/samplers/{}", pointer_, inFile), width);
        if (read) {
            known->second = static_cast<int>(animation_.samplers.size());
            animation_.samplers.push_back(std::move(*read));
        }
        return known->second;
    }

    std::nullopt_t refuse(const std::string& pointer, const std::string& why) {
        document_.warn("animation-keyframes", pointer, why + "; its channels are not played",
                       kExportAnimation);
        return std::nullopt;
    }

    std::optional<AnimationSampler> readSampler(const Json& json, const std::string& pointer,
                                                std::size_t width) {
        const std::optional<Interpolation> interpolation = interpolationOf(json);
        if (!interpolation) {
            return refuse(pointer, fmt::format("{} is no interpolation", json["interpolation"].dump()));
        }
        Result<FloatElements> times = readFloats(document_, json["input"].get<int>());
        if (!times) {
            return refuse(pointer, times.error().where + " " + times.error().message);
        }
        if (const std::string flaw = flawOfTimes(*times); !flaw.empty()) {
            return refuse(pointer, flaw);
        }
        // Integers stand for fractions whether they are marked as normalised or not: glTF has no others here.
        Result<FloatElements> values = readFloats(document_, json["output"].get<int>(), Integers::Normalized);
        if (!values) {
            return refuse(pointer, values.error().where + " " + values.error().message);
        }
        const std::size_t perKeyframe = *interpolation == Interpolation::CubicSpline ? 3 : 1;
        const std::size_t expected = times->count * width * perKeyframe;
        if (values->values.size() != expected) {
            return refuse(pointer, fmt::format("has {} numbers for {} keyframes, not {}",
                                               values->values.size(), times->count, expected));
        }
        if (!areFinite(values->values)) {
            return refuse(pointer, "has values that are not finite");
        }
        return AnimationSampler{*interpolation, std::move(times->values), width, std::move(values->values)};
    }

    Document& document_;
    const Scene& scene_;
    const NodeNumbers& numbers_;
    const Json& json_;
    std::string pointer_;
    Animation animation_;
    std::map<std::pair<std::size_t, std::size_t>, int> samplers_;  // by number in the file and width
    bool warnedOfPointer_ = false;
};

}  // namespace

void importAnimations(Document& document, Scene& scene) {
    const NodeNumbers numbers(document, scene);
    const std::size_t count = arrayMember(document.json(), "animations").size();
    for (std::size_t i = 0; i < count; ++i) {
        scene.animations.push_back(AnimationReader(document, scene, numbers, i).read());
    }
}

}  // namespace glint::gltf
