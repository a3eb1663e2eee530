// Imports animations: samplers, the channels that they drive, and the properties that channels name.
#include "gltf/document/accessor.h"
#include "gltf/motion/animatable.h"
#include "gltf/steps.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glint::gltf {

constexpr Named<AnimationPath> kPathNames[] = {{AnimationPath::Translation, "translation"},
                                               {AnimationPath::Rotation, "rotation"},
                                               {AnimationPath::Scale, "scale"},
                                               {AnimationPath::Weights, "weights"}};
constexpr std::span<const Named<AnimationPath>> namesOf(AnimationPath /*of*/) {
    return kPathNames;
}
constexpr Named<Interpolation> kInterpolationNames[] = {{Interpolation::Linear, "LINEAR"},
                                                        {Interpolation::Step, "STEP"},
                                                        {Interpolation::CubicSpline, "CUBICSPLINE"}};
constexpr std::span<const Named<Interpolation>> namesOf(Interpolation /*of*/) {
    return kInterpolationNames;
}

namespace {

// ---- Properties that JSON pointers name (KHR_animation_pointer) ----

// The form that the accessor of the keyframes must have.
enum class ValueKind : std::uint8_t {
    Vector,  // one element for each keyframe, as wide as the property
    Array,   // scalars; each keyframe has as many as the property has numbers
    Bool     // unsigned bytes, with STEP interpolation
};

struct PointerTarget {
    enum class Verdict : std::uint8_t {
        Known,
        Unknown,  // Glint has no data for it
        Wrong     // the pointer breaks a rule, which `why` names
    };
    Verdict verdict = Verdict::Unknown;
    std::string why{};
    AnimationPath path = AnimationPath::Translation;
    int property = 0;            // as AnimationChannel::property
    std::vector<int> targets{};  // as AnimationChannel::target; empty if the scene shows none
    std::size_t width = 0;
    ValueKind kind = ValueKind::Vector;
};

using Verdict = PointerTarget::Verdict;
using Tokens = std::span<const std::string>;

// Returns how many numbers a part of a transform has.
std::size_t numbersOf(AnimationPath path) {
    return path == AnimationPath::Rotation ? 4 : 3;
}

PointerTarget unknown() {
    return {};
}

PointerTarget wrong(std::string why) {
    return {.verdict = Verdict::Wrong, .why = std::move(why)};
}

PointerTarget known(AnimationPath path, std::size_t width, std::vector<int> targets, int property = 0,
                    ValueKind kind = ValueKind::Vector) {
    return {.verdict = Verdict::Known,
            .path = path,
            .property = property,
            .targets = std::move(targets),
            .width = width,
            .kind = kind};
}

// Splits "/a/b~1c" into "a" and "b/c" (RFC 6901). Returns nothing if the text does not start with a slash or
// has an unknown escape.
std::optional<std::vector<std::string>> tokensOf(const std::string& pointer) {
    if (!pointer.starts_with('/')) {
        return std::nullopt;
    }
    std::vector<std::string> tokens;
    for (std::size_t i = 0; i < pointer.size(); ++i) {
        if (pointer[i] == '/') {
            tokens.emplace_back();
        } else if (pointer[i] != '~') {
            tokens.back() += pointer[i];
        } else if (i + 1 < pointer.size() && (pointer[i + 1] == '0' || pointer[i + 1] == '1')) {
            tokens.back() += pointer[++i] == '0' ? '~' : '/';
        } else {
            return std::nullopt;
        }
    }
    return tokens;
}

// Parses a number without leading zeros.
std::optional<std::size_t> indexOf(const std::string& token) {
    std::size_t index = 0;
    const char* const end = token.data() + token.size();
    const auto parsed = std::from_chars(token.data(), end, index);
    const bool whole =
        parsed.ec == std::errc() && parsed.ptr == end && (token.size() == 1 || token[0] != '0');
    return whole ? std::optional(index) : std::nullopt;
}

// Follows a chain of members and indices. Returns null if one of them is missing.
const Json* follow(const Json& from, Tokens tokens) {
    const Json* at = &from;
    for (const std::string& token : tokens) {
        if (at->is_array()) {
            const std::optional<std::size_t> index = indexOf(token);
            at = index && *index < at->size() ? &(*at)[*index] : nullptr;
        } else {
            at = find(*at, token);
        }
        if (at == nullptr) {
            return nullptr;
        }
    }
    return at;
}

std::string joined(Tokens tokens) {
    return fmt::format("{}", fmt::join(tokens, "/"));
}

class PointerResolver {
public:
    PointerResolver(const Document& document, const Scene& scene, const NodeNumbers& numbers, Tokens tokens)
        : json_(document.json()),
          file_(document.model()),
          model_(*document.options().materialModel),
          scene_(scene),
          numbers_(numbers),
          tokens_(tokens) {}

    PointerTarget resolve() const {
        if (tokens_[0] == "extensions" && tokens_.size() >= 3 && tokens_[1] == "KHR_lights_punctual" &&
            tokens_[2] == "lights") {
            return element(3, &PointerResolver::light);
        }
        if (tokens_[0] == "nodes") {
            return element(1, &PointerResolver::node);
        }
        if (tokens_[0] == "meshes") {
            return element(1, &PointerResolver::mesh);
        }
        if (tokens_[0] == "materials") {
            return element(1, &PointerResolver::material);
        }
        return tokens_[0] == "cameras" ? element(1, &PointerResolver::camera) : unknown();
    }

private:
    // The token at tokens_[place] is an index into the array that the tokens before it name. `member` gets
    // the rest of the tokens.
    PointerTarget element(std::size_t place,
                          PointerTarget (PointerResolver::*member)(std::size_t index, Tokens rest)
                              const) const {
        if (tokens_.size() <= place + 1) {
            return unknown();
        }
        const std::optional<std::size_t> index = indexOf(tokens_[place]);
        if (!index) {
            return wrong(fmt::format("has \"{}\" where a number should be", tokens_[place]));
        }
        if (*index >= count(place)) {
            return wrong("leads to an element that the file does not have");
        }
        return (this->*member)(*index, tokens_.subspan(place + 1));
    }

    // Returns how many elements the array has that the tokens before `place` name.
    std::size_t count(std::size_t place) const {
        if (tokens_[0] == "nodes") {
            return file_.nodes.size();
        }
        if (tokens_[0] == "meshes") {
            return file_.meshes.size();
        }
        if (tokens_[0] == "cameras") {
            return file_.cameras.size();
        }
        const Json* const array = follow(json_, tokens_.first(place));
        return array == nullptr || !array->is_array() ? 0 : array->size();
    }

    // Returns whether the material or light has the object that holds the property. A property with a default
    // value is then defined.
    bool hasOwner() const {
        const Json* const owner = follow(json_, tokens_.first(tokens_.size() - 1));
        return owner != nullptr && owner->is_object();
    }

    bool isDefined() const {
        return follow(json_, tokens_) != nullptr;
    }

    static PointerTarget undefined() {
        return wrong("leads to a property that the file does not define");
    }

    PointerTarget weights(std::vector<int> nodes, std::size_t targets, Tokens rest) const {
        if (targets == 0) {
            return wrong("animates the weights of a mesh that has no morph targets");
        }
        if (rest.empty()) {
            return known(AnimationPath::Weights, targets, std::move(nodes), 0, ValueKind::Array);
        }
        const std::optional<std::size_t> target = indexOf(rest[0]);
        if (!target || *target >= targets || rest.size() > 1) {
            return wrong(fmt::format("names no weight: there are {} morph targets", targets));
        }
        return known(AnimationPath::Weight, 1, std::move(nodes), static_cast<int>(*target));
    }

    PointerTarget node(std::size_t index, Tokens rest) const {
        const int placed = numbers_.inScene(static_cast<int>(index));
        const std::vector<int> targets = placed < 0 ? std::vector<int>() : std::vector{placed};
        if (rest[0] == "weights") {
            if (placed < 0) {
                return known(AnimationPath::Weights, 0, {});
            }
            return weights(targets, scene_.nodes[static_cast<std::size_t>(placed)].restWeights.size(),
                           rest.subspan(1));
        }
        const std::string name = joined(rest);
        if (name == "extensions/KHR_node_visibility/visible") {
            return file_.nodes[index].extensions.contains("KHR_node_visibility")
                       ? known(AnimationPath::Visible, 1, targets, 0, ValueKind::Bool)
                       : undefined();
        }
        if (name == "matrix" || name == "globalMatrix") {
            return wrong("is a matrix, which can only be read");
        }
        const std::optional<AnimationPath> path = valueNamed<AnimationPath>(name);
        if (!path || !drivesTransform(*path)) {
            return unknown();
        }
        if (!file_.nodes[index].matrix.empty()) {
            return wrong("animates a node whose transform is a matrix, which glTF forbids");
        }
        return known(*path, numbersOf(*path), targets);
    }

    // These are the default weights. They apply to the nodes that have no weights of their own.
    PointerTarget mesh(std::size_t index, Tokens rest) const {
        if (rest[0] != "weights") {
            return unknown();
        }
        std::vector<int> nodes;
        for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
            const Node& node = scene_.nodes[i];
            if (node.mesh == static_cast<int>(index) &&
                file_.nodes[static_cast<std::size_t>(node.source)].weights.empty()) {
                nodes.push_back(static_cast<int>(i));
            }
        }
        return weights(std::move(nodes), scene_.meshes[index].weights.size(), rest.subspan(1));
    }

    PointerTarget material(std::size_t index, Tokens rest) const {
        const std::optional<int> property = findMaterialProperty(model_, joined(rest));
        if (!property) {
            return unknown();
        }
        if (!hasOwner()) {
            return undefined();
        }
        if (const std::string reason = notAnimated(model_, *property); !reason.empty()) {
            return wrong(reason);
        }
        if (isFixed(scene_.materials[index], *property)) {
            return wrong("has a value in the file that stands for a mode, which no animation changes");
        }
        return known(AnimationPath::Material, materialPropertyWidth(model_, *property),
                     {static_cast<int>(index)}, *property);
    }

    template <typename Object>
    static std::vector<int> placesOf(const std::vector<Object>& objects, std::size_t source) {
        std::vector<int> places;
        for (std::size_t i = 0; i < objects.size(); ++i) {
            if (objects[i].source == static_cast<int>(source)) {
                places.push_back(static_cast<int>(i));
            }
        }
        return places;
    }

    PointerTarget camera(std::size_t index, Tokens rest) const {
        const std::optional<int> property = findCameraProperty(joined(rest));
        if (!property) {
            return unknown();  // this includes aspectRatio, which the picture's size decides
        }
        const tinygltf::Camera& file = file_.cameras[index];
        // Every property of a camera is required, except zfar, which has no default.
        return file.type == rest[0] && (rest[1] != "zfar" || farPlane(file))
                   ? known(AnimationPath::Camera, 1, placesOf(scene_.cameras, index), *property)
                   : undefined();
    }

    PointerTarget light(std::size_t index, Tokens rest) const {
        const std::optional<int> property = findLightProperty(joined(rest));
        if (!property) {
            return unknown();
        }
        // The range has no default.
        return (rest[0] == "range" ? isDefined() : hasOwner())
                   ? known(AnimationPath::Light, lightPropertyWidth(*property),
                           placesOf(scene_.lights, index), *property)
                   : undefined();
    }

    const Json& json_;
    const tinygltf::Model& file_;
    const materials::MaterialModel& model_;
    const Scene& scene_;
    const NodeNumbers& numbers_;
    Tokens tokens_;
};

// If the pointer leads to a material, `targets` holds the index into Scene::materials.
PointerTarget resolvePointer(const Document& document, const Scene& scene, const NodeNumbers& numbers,
                             const std::string& pointer) {
    const std::optional<std::vector<std::string>> tokens = tokensOf(pointer);
    if (!tokens) {
        return wrong("is no JSON pointer");
    }
    return PointerResolver(document, scene, numbers, *tokens).resolve();
}

// ---- Animations ----

constexpr const char* kExportAnimation = "export the animation again";

bool areFinite(const std::vector<float>& values) {
    return std::ranges::all_of(values, [](float value) { return std::isfinite(value); });
}

// Returns which promise of AnimationSampler the keyframe times break, or an empty text if they break none.
std::string flawOfTimes(const FloatElements& times) {
    if (times.components != 1 || times.count == 0) {
        return "its times are no list of numbers";
    }
    if (!areFinite(times.values) || times.values.front() < 0.0F) {
        return "its times are negative or not finite";
    }
    return std::ranges::is_sorted(times.values, std::less_equal<>{}) ? "" : "its times do not ascend";
}

// How a property reads the keyframes of a sampler.
struct KeyframeForm {
    std::size_t width = 0;
    // This is empty for a property of a node. Its integers are fractions, and its elements may have any
    // width.
    std::optional<ValueKind> kind{};

    // The compiler generates a comparison with 0 here. NOLINTNEXTLINE(modernize-use-nullptr)
    auto operator<=>(const KeyframeForm&) const = default;
};

class AnimationReader {
public:
    AnimationReader(Document& document, Scene& scene, const NodeNumbers& numbers, std::size_t index)
        : document_(document),
          scene_(scene),
          numbers_(numbers),
          file_(document.model().animations[index]),
          pointer_(fmt::format("/animations/{}", index)) {}

    Animation read() {
        animation_.name = file_.name;
        for (std::size_t i = 0; i < file_.channels.size(); ++i) {
            readChannel(file_.channels[i], fmt::format("{}/channels/{}", pointer_, i));
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

    // Returns how many values a keyframe of that property has, or 0 if the node has no such property to
    // animate.
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
        return numbersOf(path);
    }

    void readChannel(const tinygltf::AnimationChannel& channel, const std::string& pointer) {
        const std::string& pathName = channel.target_path;
        const Value* const extension = extensionOf(channel.target_extensions, "KHR_animation_pointer");
        if (pathName == "pointer" || extension != nullptr) {
            readPointer(channel, pointer,
                        extension == nullptr ? "" : memberOr<std::string>(*extension, "pointer", ""));
            return;
        }
        const int node = channel.target_node < 0 ? -1 : numbers_.inScene(channel.target_node);
        if (node < 0) {
            return;  // an extension's channel, or one of a node that this scene does not draw
        }
        const std::optional<AnimationPath> path = valueNamed<AnimationPath>(pathName);
        if (!path) {
            leaveOut(pointer + "/target/path", fmt::format("\"{}\" is no property of a node", pathName));
            return;
        }
        const std::size_t width = widthOf(*path, scene_.nodes[static_cast<std::size_t>(node)], pointer);
        const int sampler = width == 0 ? -1 : samplerOf(channel, pointer, {width});
        if (sampler >= 0) {
            checkOutput(channel, pointer, *path);
            append({node, *path, sampler}, pointer);
        }
    }

    // Appends the channel, and warns if an earlier one drives the same property, which glTF forbids.
    void append(const AnimationChannel& channel, const std::string& pointer) {
        const auto isWeights = [](const AnimationChannel& one) { return one.path == AnimationPath::Weights; };
        const auto isOfWeights = [&](const AnimationChannel& one) {
            return isWeights(one) || one.path == AnimationPath::Weight;
        };
        const bool isDriven = std::ranges::any_of(animation_.channels, [&](const AnimationChannel& other) {
            const bool drivesWeights = isOfWeights(other) && isOfWeights(channel);
            return other.target == channel.target &&
                   ((drivesWeights && (isWeights(other) || isWeights(channel))) ||
                    (other.path == channel.path && other.property == channel.property));
        });
        if (isDriven) {
            document_.warn("animation-channel", pointer,
                           "drives what an earlier channel of the animation drives; the later one holds",
                           kExportAnimation);
        }
        animation_.channels.push_back(channel);
    }

    // The form of a node's keyframes, of which only the number of values matters to Glint.
    void checkOutput(const tinygltf::AnimationChannel& channel, const std::string& pointer,
                     AnimationPath path) {
        const int output = file_.samplers[static_cast<std::size_t>(channel.sampler)].output;
        const tinygltf::Accessor& values = document_.accessor(output);
        const std::size_t components = path == AnimationPath::Weights ? 1 : numbersOf(path);
        const bool mayBeFractions = path == AnimationPath::Weights || path == AnimationPath::Rotation;
        if (componentsOf(values) != components || isMatrix(values) ||
            (values.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT &&
             !(mayBeFractions && values.normalized))) {
            document_.warn(
                "accessor-form", pointer,
                fmt::format("/accessors/{} has a type or a component type that glTF does not allow "
                            "for this property; its numbers are read in their order",
                            output),
                kExportAnimation);
        }
    }

    void readPointer(const tinygltf::AnimationChannel& channel, const std::string& place,
                     const std::string& pointer) {
        const std::string where = place + "/target/extensions/KHR_animation_pointer/pointer";
        if (channel.target_path != "pointer" || channel.target_node >= 0) {
            document_.warn(
                "animation-pointer", place + "/target",
                "must have the path \"pointer\" and no node beside KHR_animation_pointer; the pointer "
                "is followed",
                kExportAnimation);
        }
        const PointerTarget target = resolvePointer(document_, scene_, numbers_, pointer);
        if (target.verdict == PointerTarget::Verdict::Unknown) {
            if (noted_.insert(pointer).second) {
                document_.note(
                    "animation-pointer", where,
                    fmt::format("\"{}\" is nothing that Glint has data for; the channel is not played",
                                pointer));
            }
            return;
        }
        if (target.verdict == PointerTarget::Verdict::Wrong) {
            document_.warn("animation-pointer", where,
                           fmt::format("\"{}\" {}; the channel is not played", pointer, target.why),
                           kExportAnimation);
            return;
        }
        const int sampler =
            target.targets.empty() ? -1 : samplerOf(channel, place, {target.width, target.kind});
        if (sampler >= 0) {
            checkValues(target, animation_.samplers[static_cast<std::size_t>(sampler)], where);
        }
        for (const int found : target.targets) {
            if (sampler >= 0) {
                const int index = target.path == AnimationPath::Material ? animatedMaterial(found) : found;
                append({index, target.path, sampler, target.property}, where);
            }
        }
    }

    void checkValues(const PointerTarget& target, const AnimationSampler& sampler, const std::string& where) {
        const auto takes = [&](double value) {
            switch (target.path) {
                case AnimationPath::Material:
                    return takesMaterialValue(*document_.options().materialModel, target.property, value);
                case AnimationPath::Light:
                    return takesLightValue(target.property, value);
                case AnimationPath::Camera:
                    return takesCameraValue(target.property, value);
                default:
                    return true;
            }
        };
        const bool cubic = sampler.interpolation == Interpolation::CubicSpline;
        for (std::size_t i = 0; i < sampler.values.size(); ++i) {
            const bool isTangent = cubic && i / sampler.width % 3 != 1;
            if (!isTangent && !takes(sampler.values[i])) {
                document_.warn("animation-keyframes", where,
                               fmt::format("has the value {}, which the property does not take; values are "
                                           "clamped",
                                           sampler.values[i]),
                               "keep the values in the range of the property");
                return;
            }
        }
    }

    // Returns the material's index among the materials that animations change.
    int animatedMaterial(int material) {
        std::vector<AnimatedMaterial>& all = scene_.animatedMaterials;
        const auto found = std::ranges::find(all, material, &AnimatedMaterial::material);
        if (found != all.end()) {
            return static_cast<int>(found - all.begin());
        }
        AnimatedMaterial& added = all.emplace_back();
        added.material = material;
        added.rest = scene_.materials[static_cast<std::size_t>(material)];
        return static_cast<int>(all.size()) - 1;
    }

    // Returns an index into animation_.samplers, or -1 if there is no usable sampler.
    int samplerOf(const tinygltf::AnimationChannel& channel, const std::string& pointer,
                  const KeyframeForm& form) {
        const auto inFile = static_cast<std::size_t>(channel.sampler);
        const std::vector<tinygltf::AnimationSampler>& samplers = file_.samplers;
        if (inFile >= samplers.size()) {
            leaveOut(pointer + "/sampler",
                     fmt::format("is {}, but the animation has {} samplers", inFile, samplers.size()));
            return -1;
        }
        const auto [known, isNew] = samplers_.try_emplace(std::pair(inFile, form), -1);
        if (!isNew) {
            return known->second;
        }
        std::optional<AnimationSampler> read =
            readSampler(samplers[inFile], fmt::format("{}/samplers/{}", pointer_, inFile), form);
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

    // Returns which demand of a pointer's property the accessor does not meet, or an empty text if it meets
    // all.
    std::string flawOfForm(int accessor, const KeyframeForm& form, Interpolation interpolation) const {
        const tinygltf::Accessor& values = document_.accessor(accessor);
        const std::size_t expected = form.kind == ValueKind::Vector ? form.width : 1;
        if (componentsOf(values) != expected) {
            return fmt::format("/accessors/{} has elements of {} numbers, not {}", accessor,
                               componentsOf(values), expected);
        }
        const bool isByte = values.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE;
        if (form.kind == ValueKind::Bool && (!isByte || values.normalized)) {
            return fmt::format("/accessors/{} drives true and false, but holds no plain unsigned bytes",
                               accessor);
        }
        if (form.kind == ValueKind::Bool && interpolation != Interpolation::Step) {
            return "drives true and false, which takes the interpolation STEP";
        }
        return {};
    }

    std::optional<AnimationSampler> readSampler(const tinygltf::AnimationSampler& file,
                                                const std::string& pointer, const KeyframeForm& form) {
        const std::optional<Interpolation> interpolation = valueNamed<Interpolation>(file.interpolation);
        if (!interpolation) {
            return refuse(pointer, fmt::format("\"{}\" is no interpolation", file.interpolation));
        }
        Result<FloatElements> times = readFloats(document_, file.input);
        if (!times) {
            return refuse(pointer, times.error().where + " " + times.error().message);
        }
        if (const std::string flaw = flawOfTimes(*times); !flaw.empty()) {
            return refuse(pointer, flaw);
        }
        const int output = file.output;
        if (const std::string flaw = form.kind ? flawOfForm(output, form, *interpolation) : "";
            !flaw.empty()) {
            return refuse(pointer, flaw);
        }
        // For a property of a node, integers stand for fractions even if they are not marked as normalised,
        // because glTF allows no others there. For a property that a pointer names, the mark decides.
        Result<FloatElements> values =
            readFloats(document_, output, form.kind ? Integers::AsValues : Integers::Normalized);
        if (!values) {
            return refuse(pointer, values.error().where + " " + values.error().message);
        }
        if (*interpolation == Interpolation::CubicSpline && times->count < 2) {
            document_.warn("animation-keyframes", pointer,
                           "is a cubic spline of one keyframe, and 2 are the least; its value is held",
                           kExportAnimation);
        }
        const std::size_t perKeyframe = *interpolation == Interpolation::CubicSpline ? 3 : 1;
        const std::size_t expected = times->count * form.width * perKeyframe;
        if (values->values.size() != expected) {
            return refuse(pointer, fmt::format("has {} numbers for {} keyframes, not {}",
                                               values->values.size(), times->count, expected));
        }
        if (!areFinite(values->values)) {
            return refuse(pointer, "has values that are not finite");
        }
        return AnimationSampler{*interpolation, std::move(times->values), form.width,
                                std::move(values->values)};
    }

    Document& document_;
    Scene& scene_;
    const NodeNumbers& numbers_;
    const tinygltf::Animation& file_;
    std::string pointer_;
    Animation animation_;
    std::map<std::pair<std::size_t, KeyframeForm>, int> samplers_;  // by number in the file
    std::set<std::string> noted_;                                   // pointers that are unknown
};

}  // namespace

void importAnimations(Document& document, Scene& scene) {
    const NodeNumbers numbers(document, scene);
    const std::size_t count = document.model().animations.size();
    for (std::size_t i = 0; i < count; ++i) {
        scene.animations.push_back(AnimationReader(document, scene, numbers, i).read());
    }
    settleAnimatedValues(scene);
}

}  // namespace glint::gltf
