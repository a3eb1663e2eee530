#define TINYGLTF_IMPLEMENTATION
#include <nlohmann/json.hpp>

#include <fstream>  // tinygltf forgets it

#define tinygltf glint_tinygltf

namespace tinygltf {

// tinygltf calls a function of this name to parse its text. The function that this declares is found first,
// so that the document that Glint has parsed and checked is not parsed again: the text is a pointer to it.
// NOLINTNEXTLINE(readability-identifier-naming)
void JsonParse(nlohmann::json& document, const char* checked, unsigned length, bool throws);

// tinygltf 2.8 and later look for the function here.
namespace detail {
using tinygltf::JsonParse;  // NOLINT(misc-unused-using-decls)
}

}  // namespace tinygltf

#undef tinygltf
#include "gltf/document/model.h"
#include "gltf/document/validate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

void tinygltf::JsonParse(nlohmann::json& document, const char* checked, unsigned /*length*/,
                         bool /*throws*/) {
    document = std::move(*reinterpret_cast<nlohmann::json*>(const_cast<char*>(checked)));
}

namespace glint::gltf {

namespace {

// Members of the document that stay JSON:
// - buffers and images: tinygltf reads all of them at once, and refuses a scene for one that is missing, is
//   longer than announced, has a data URI of a media type or a spelling that it does not know, or has no data
//   of its own, such as the fallback of a compressed buffer. Glint reads those that a picture needs.
// - materials: packs declare the names of members, and for a base model it matters which objects are given.
//   tinygltf fills in defaults, drops empty objects of extensions and cuts integers to 32 bits.
// - extensions: tinygltf refuses a scene for a spot light without "spot".
constexpr const char* kUntrusted[] = {"buffers", "images", "materials", "extensions"};

// Returns the member of that name, or an empty array.
Json& memberOf(Json& object, const char* name) {
    static Json none = Json::array();
    const auto member = object.find(name);
    return member == object.end() ? none : *member;
}

// tinygltf takes ten times the memory of JSON for an extension's values, so it gets only those that the
// importer reads from its model.
bool isInModel(std::string_view extension) {
    const auto* const known = std::ranges::find(kKnownExtensions, extension, &KnownExtension::name);
    return known != std::end(kKnownExtensions) && known->isInModel;
}

// Leaves out other extensions, and extras, which are an application's own.
void leaveOutUnread(Json& object) {
    object.erase("extras");
    Json& extensions = memberOf(object, "extensions");
    for (auto extension = extensions.begin(); extension != extensions.end(); ++extension) {
        if (!extensions.is_object() || !isInModel(extension.key())) {
            *extension = Json::object();
        }
    }
}

// Values that tinygltf refuses, and that are put into the model afterwards.
struct Withheld {
    std::vector<std::size_t> strides;  // of buffer views
    int noView = 0;                    // the number of a buffer view that stands for none
};

Withheld fitViews(Json& root) {
    Withheld withheld;
    for (Json& view : memberOf(root, "bufferViews")) {
        // tinygltf refuses a scene for a stride that is no multiple of 4, which small indices have.
        const auto stride = view.find("byteStride");
        withheld.strides.push_back(stride == view.end() ? 0 : stride->get<std::size_t>());
        view.erase("byteStride");
        // tinygltf cuts integers of extensions to 32 bits, which the places of compressed data may exceed.
        for (Json& extension : memberOf(view, "extensions")) {
            for (Json& member : extension) {
                if (member.is_number_unsigned() &&
                    member.get<std::uint64_t>() > std::numeric_limits<int>::max()) {
                    member = member.get<double>();
                }
            }
        }
    }
    withheld.noView = static_cast<int>(withheld.strides.size());
    root["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 0U}});
    return withheld;
}

void fitAccessors(Json& accessors, const std::vector<bool>& used, int noView) {
    for (std::size_t i = 0; i < accessors.size(); ++i) {
        if (!used[i]) {
            // Its members have not been checked, and tinygltf refuses a scene for an unknown type.
            accessors[i] = {{"componentType", static_cast<unsigned>(TINYGLTF_COMPONENT_TYPE_FLOAT)},
                            {"count", 1U},
                            {"type", "SCALAR"}};
        } else if (!accessors[i].contains("bufferView")) {
            // tinygltf 2.7 refuses a scene for such indices, which primitives with Draco data have.
            accessors[i]["bufferView"] = noView;
        }
    }
}

// tinygltf leaves out a primitive whose attributes are not all numbers. Glint has checked those that it
// reads.
void fitMeshes(Json& meshes) {
    for (Json& mesh : meshes) {
        for (Json& primitive : memberOf(mesh, "primitives")) {
            leaveOutUnread(primitive);
            Json& attributes = primitive["attributes"];
            for (auto attribute = attributes.begin(); attribute != attributes.end();) {
                attribute =
                    attribute->is_number_integer() ? std::next(attribute) : attributes.erase(attribute);
            }
        }
    }
}

void fitAnimations(Json& animations) {
    for (Json& animation : animations) {
        // tinygltf 2.7 gives each sampler a copy of these.
        animation.erase("extensions");
        for (Json& channel : animation["channels"]) {
            leaveOutUnread(channel);
            leaveOutUnread(channel["target"]);
            // tinygltf 2.7 leaves out a channel without a node, as those of KHR_animation_pointer are.
            channel["target"].emplace("node", -1);
        }
    }
}

// For tinygltf, 0 is a far plane that is not given. -0 is one that the file gives as 0.
void fitCameras(Json& cameras) {
    for (Json& camera : cameras) {
        Json& lens = camera[camera["type"].get_ref<const std::string&>()];
        leaveOutUnread(lens);
        if (const auto zfar = lens.find("zfar"); zfar != lens.end() && *zfar == 0) {
            *zfar = -0.0;
        }
    }
}

// Moves a member into another document if there is one.
void moveMember(Json& from, const char* name, Json& to) {
    if (const auto member = from.find(name); member != from.end()) {
        to[name] = std::move(*member);
        from.erase(member);
    }
}

// Lets tinygltf read a document, which is gone afterwards. Returns why tinygltf refuses it, or an empty text.
std::string consume(Json& document, tinygltf::Model& model) {
    std::string error;
    std::string warning;
    const bool isRead = tinygltf::TinyGLTF().LoadASCIIFromString(&model, &error, &warning,
                                                                 reinterpret_cast<const char*>(&document),
                                                                 sizeof document, "", tinygltf::NO_REQUIRE);
    return isRead ? "" : error.empty() ? "tinygltf does not read it" : error;
}

}  // namespace

std::string readModel(Json& root, const std::vector<bool>& used, tinygltf::Model& model) {
    Json untrusted = Json::object();
    for (const char* const name : kUntrusted) {
        moveMember(root, name, untrusted);
    }
    leaveOutUnread(root);
    for (const char* const name : {"accessors", "animations", "bufferViews", "cameras", "meshes", "nodes",
                                   "samplers", "scenes", "skins", "textures"}) {
        for (Json& element : memberOf(root, name)) {
            leaveOutUnread(element);
        }
    }
    const Withheld withheld = fitViews(root);
    fitAccessors(memberOf(root, "accessors"), used, withheld.noView);
    fitMeshes(memberOf(root, "meshes"));
    fitAnimations(memberOf(root, "animations"));
    fitCameras(memberOf(root, "cameras"));

    // Nodes are read by themselves, so that the JSON of all else is gone before they take memory.
    Json nodes = Json::object();
    moveMember(root, "nodes", nodes);
    tinygltf::Model nodesAlone;
    nodesAlone.nodes.reserve(memberOf(nodes, "nodes").size());
    model.accessors.reserve(used.size());
    model.meshes.reserve(memberOf(root, "meshes").size());
    std::string problem = consume(root, model);
    problem = problem.empty() ? consume(nodes, nodesAlone) : problem;
    root = std::move(untrusted);
    if (!problem.empty()) {
        return problem;
    }
    model.nodes = std::move(nodesAlone.nodes);
    model.bufferViews.pop_back();
    for (std::size_t i = 0; i < model.bufferViews.size(); ++i) {
        model.bufferViews[i].byteStride = withheld.strides[i];
    }
    for (tinygltf::Accessor& accessor : model.accessors) {
        accessor.bufferView = accessor.bufferView == withheld.noView ? -1 : accessor.bufferView;
    }
    return {};
}

std::size_t componentsOf(const tinygltf::Accessor& accessor) {
    return static_cast<std::size_t>(
        tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)));
}

std::size_t componentSizeOf(int componentType) {
    return static_cast<std::size_t>(
        tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(componentType)));
}

bool isMatrix(const tinygltf::Accessor& accessor) {
    return accessor.type == TINYGLTF_TYPE_MAT2 || accessor.type == TINYGLTF_TYPE_MAT3 ||
           accessor.type == TINYGLTF_TYPE_MAT4;
}

const Value* extensionOf(const tinygltf::ExtensionMap& extensions, const std::string& name) {
    const auto extension = extensions.find(name);
    return extension == extensions.end() ? nullptr : &extension->second;
}

std::optional<double> farPlane(const tinygltf::Camera& camera) {
    const double zfar = camera.type == "orthographic" ? camera.orthographic.zfar : camera.perspective.zfar;
    return zfar == 0.0 && !std::signbit(zfar) ? std::nullopt : std::optional(zfar + 0.0);
}

int accessorOf(const std::map<std::string, int>& attributes, const std::string& name) {
    const auto attribute = attributes.find(name);
    return attribute == attributes.end() ? -1 : attribute->second;
}

}  // namespace glint::gltf
