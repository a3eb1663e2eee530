#include "gltf/motion/animation_pointers.h"

#include "gltf/motion/animatable.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

namespace glint::gltf {

namespace {

using Verdict = PointerTarget::Verdict;
using Tokens = std::span<const std::string>;

PointerTarget unknown() {
    return {};
}

PointerTarget wrong(std::string why) {
    PointerTarget target;
    target.verdict = Verdict::Wrong;
    target.why = std::move(why);
    return target;
}

PointerTarget known(AnimationPath path, std::size_t width, std::vector<int> targets, int property = 0,
                    ValueKind kind = ValueKind::Vector) {
    PointerTarget target;
    target.verdict = Verdict::Known;
    target.path = path;
    target.property = property;
    target.targets = std::move(targets);
    target.width = width;
    target.kind = kind;
    return target;
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

std::string nameOf(Tokens tokens) {
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
        const std::string name = nameOf(rest);
        if (name == "extensions/KHR_node_visibility/visible") {
            return file_.nodes[index].extensions.contains("KHR_node_visibility")
                       ? known(AnimationPath::Visible, 1, targets, 0, ValueKind::Bool)
                       : undefined();
        }
        if (name == "matrix" || name == "globalMatrix") {
            return wrong("is a matrix, which can only be read");
        }
        const bool isTransform = name == "translation" || name == "rotation" || name == "scale";
        if (!isTransform) {
            return unknown();
        }
        if (!file_.nodes[index].matrix.empty()) {
            return wrong("animates a node whose transform is a matrix, which glTF forbids");
        }
        return name == "rotation"
                   ? known(AnimationPath::Rotation, 4, targets)
                   : known(name == "scale" ? AnimationPath::Scale : AnimationPath::Translation, 3, targets);
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
        const std::optional<int> property = findMaterialProperty(model_, nameOf(rest));
        if (!property) {
            return unknown();
        }
        if (!hasOwner()) {
            return undefined();
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
        const std::optional<int> property = findCameraProperty(nameOf(rest));
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
        const std::optional<int> property = findLightProperty(nameOf(rest));
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

}  // namespace

PointerTarget resolvePointer(const Document& document, const Scene& scene, const NodeNumbers& numbers,
                             const std::string& pointer) {
    const std::optional<std::vector<std::string>> tokens = tokensOf(pointer);
    if (!tokens) {
        return wrong("is no JSON pointer");
    }
    return PointerResolver(document, scene, numbers, *tokens).resolve();
}

}  // namespace glint::gltf
