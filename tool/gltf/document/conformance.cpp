#include "gltf/document/document.h"
#include "gltf/document/validate.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace glint::gltf {

namespace {

// Ratified or registered extensions whose data a renderer may ignore even if a file requires them.
constexpr auto kNoPicture = std::to_array<std::string_view>(
    {"AGI_stk_metadata", "EXT_instance_features", "EXT_mesh_features", "EXT_mesh_manifold",
     "EXT_mesh_opacity_micromap", "EXT_structural_metadata", "FB_geometry_metadata", "GODOT_single_root",
     "KHR_node_hoverability", "KHR_node_selectability", "KHR_xmp", "KHR_xmp_json_ld"});

std::string extensionHint(std::string_view name) {
    if (name == "EXT_texture_avif") {
        return "store the textures as PNG, JPEG or WebP";
    }
    if (name.starts_with("KHR_materials_")) {
        return fmt::format("move {} from extensionsRequired to extensionsUsed to render without it", name);
    }
    return "export the scene without this extension";
}

constexpr const char* kExport = "export the scene again";

// By component type, from TINYGLTF_COMPONENT_TYPE_BYTE on. glTF has no signed integers of 32 bits.
constexpr std::string_view kComponentNames[] = {"bytes", "unsigned bytes",    "shorts", "unsigned shorts",
                                                "",      "unsigned integers", "floats"};

// Returns how many numbers an element of a checked accessor has: "SCALAR", "VEC3", "MAT4".
std::size_t componentsOf(const Json& accessor) {
    const std::string& type = accessor["type"].get_ref<const std::string&>();
    const auto width = static_cast<std::size_t>(type.back() - '0');
    return type == "SCALAR" ? 1 : type.starts_with("MAT") ? width * width : width;
}

bool isIn(const Json& list, std::string_view name) {
    return std::ranges::any_of(list, [&](const Json& entry) { return entry == name; });
}

// ---- Extensions (glTF 2.0, section 3.12) ----

// Calls `visit(name, pointer)` for each extension of an object and of the objects in it. `pointer` is that of
// the object. The parser has bounded how deep objects nest.
template <typename Visit>
void visitExtensions(const Json& json, std::string& pointer, const Visit& visit) {
    const std::size_t length = pointer.size();
    std::size_t index = 0;
    for (auto member = json.begin(); member != json.end(); ++member, ++index) {
        if (!member->is_structured() || (json.is_object() && member.key() == "extras")) {
            continue;  // extras are an application's own
        }
        pointer += "/" + (json.is_object() ? member.key() : std::to_string(index));
        if (json.is_object() && member.key() == "extensions" && member->is_object()) {
            for (const auto& [name, ignored] : member->items()) {
                visit(name, fmt::format("{}/{}", pointer, name));
            }
        }
        visitExtensions(*member, pointer, visit);
        pointer.resize(length);
    }
}

void checkLists(Document& document, const Json& json) {
    const Json& used = arrayMember(json, "extensionsUsed");
    const Json& required = arrayMember(json, "extensionsRequired");
    for (std::size_t i = 0; i < required.size(); ++i) {
        if (!isIn(used, required[i].get_ref<const std::string&>())) {
            document.warn("extension-unlisted", fmt::format("/extensionsRequired/{}", i),
                          fmt::format("{} is missing in extensionsUsed", required[i].get<std::string>()),
                          kExport);
        }
    }
    std::set<std::string> listed;
    for (const Json* const list : {&used, &required}) {
        for (const Json& name : *list) {
            if (name.is_string()) {
                listed.insert(name.get<std::string>());
            }
        }
    }
    std::string root;
    visitExtensions(json, root, [&](const std::string& name, const std::string& pointer) {
        if (listed.insert(name).second) {
            document.warn("extension-unlisted", pointer,
                          fmt::format("{} is missing in extensionsUsed; it is read all the same", name),
                          kExport);
        }
    });
}

// Warns of objects that a reader without the extension can't read in a file that does not require it.
class RequiredExtensions {
public:
    RequiredExtensions(Document& document, const Json& root) : document_(document), root_(root) {}

    void check() {
        if (isIn(arrayMember(root_, "extensionsUsed"), kQuantization)) {
            demand(kQuantization, "/extensionsUsed");
        }
        demandOf("textures", "source", kImageExtensions);
        demandOf("buffers", "uri", kMeshoptExtensions);
        visitElements(root_, "bufferViews", "", [&](const Json& view, const std::string& pointer) {
            if (std::ranges::all_of(kMeshoptExtensions,
                                    [&](const char* name) { return findExtension(view, name); })) {
                document_.warn("meshopt-layout", pointer,
                               "has both EXT_meshopt_compression and KHR_meshopt_compression; the former is "
                               "read",
                               kExport);
            }
        });
        const Json& accessors = arrayMember(root_, "accessors");
        visitPrimitives(root_, [&](const Json& primitive, const std::string& pointer) {
            const Json* const position = find(primitive["attributes"], "POSITION");
            if (findExtension(primitive, kDracoExtension) != nullptr && position != nullptr &&
                find(accessors[position->get<std::size_t>()], "bufferView") == nullptr) {
                demand(kDracoExtension, pointer);
            }
        });
    }

    static constexpr const char* kQuantization = "KHR_mesh_quantization";

private:
    void demand(const char* name, const std::string& pointer) {
        if (!isIn(arrayMember(root_, "extensionsRequired"), name) && given_.insert(name).second) {
            document_.warn("extension-unlisted", pointer,
                           fmt::format("needs {}, which is missing in extensionsRequired", name), kExport);
        }
    }

    // Demands the extensions through which elements have what they lack themselves.
    template <std::size_t N>
    void demandOf(const char* array, const char* member, const char* const (&names)[N]) {
        visitElements(root_, array, "", [&](const Json& element, const std::string& pointer) {
            for (const char* const name : names) {
                if (findExtension(element, name) != nullptr && find(element, member) == nullptr) {
                    demand(name, pointer);
                }
            }
        });
    }

    Document& document_;
    const Json& root_;
    std::set<std::string> given_;
};

// ---- Attributes (sections 3.7.2.1 and 3.7.2.2, and KHR_mesh_quantization) ----

// Forms of components, as bits: two for each component type, of which the second is for normalised ones.
using Forms = std::uint32_t;

constexpr Forms form(int type, bool normalized) {
    const auto index = static_cast<std::uint32_t>(type - TINYGLTF_COMPONENT_TYPE_BYTE);
    return 1U << (2 * index + (normalized ? 1 : 0));
}
constexpr Forms kFloat = form(TINYGLTF_COMPONENT_TYPE_FLOAT, false);
constexpr Forms kUnsignedFractions =
    form(TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, true) | form(TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, true);
constexpr Forms kFractions =
    form(TINYGLTF_COMPONENT_TYPE_BYTE, true) | form(TINYGLTF_COMPONENT_TYPE_SHORT, true);
constexpr Forms kIntegers =
    form(TINYGLTF_COMPONENT_TYPE_BYTE, false) | form(TINYGLTF_COMPONENT_TYPE_SHORT, false);
constexpr Forms kUnsigned =
    form(TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, false) | form(TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, false);

struct AttributeForms {
    AccessorUse use;
    std::string_view prefix;
    Forms core = 0;
    Forms quantized = 0;  // further ones with KHR_mesh_quantization
};
constexpr AttributeForms kForms[] = {
    {AccessorUse::Attribute, "POSITION", kFloat, kIntegers | kFractions | kUnsigned | kUnsignedFractions},
    {AccessorUse::Attribute, "NORMAL", kFloat, kFractions},
    {AccessorUse::Attribute, "TANGENT", kFloat, kFractions},
    {AccessorUse::Attribute, "TEXCOORD_", kFloat | kUnsignedFractions, kIntegers | kFractions | kUnsigned},
    {AccessorUse::Attribute, "WEIGHTS_", kFloat | kUnsignedFractions},
    {AccessorUse::Target, "POSITION", kFloat, kIntegers | kFractions},
    {AccessorUse::Target, "NORMAL", kFloat, kFractions},
    {AccessorUse::Target, "TANGENT", kFloat, kFractions},
    {AccessorUse::Instances, "TRANSLATION", kFloat},
    {AccessorUse::Instances, "ROTATION", kFloat | kFractions},
    {AccessorUse::Instances, "SCALE", kFloat},
};

// Returns the row for the attribute, or null if any form is allowed or other messages tell of it.
const AttributeForms* formsOf(const UsedAccessor& used) {
    const auto* const row = std::ranges::find_if(kForms, [&](const AttributeForms& one) {
        return one.use == used.use && used.name.starts_with(one.prefix);
    });
    return row == std::end(kForms) ? nullptr : row;
}

class AccessorRules {
public:
    AccessorRules(Document& document, const Json& root) : document_(document), root_(root) {
        constexpr const char* kName = RequiredExtensions::kQuantization;
        quantized_ = isIn(arrayMember(root, "extensionsRequired"), kName) ||
                     isIn(arrayMember(root, "extensionsUsed"), kName);
    }

    void check(const UsedAccessor& used) {
        checkForm(used);
        checkBounds(used);
        if (find(accessor(used), "bufferView") != nullptr) {
            checkLayout(used);
        }
    }

    // Checks what only all uses of a buffer view together tell.
    void checkViews() {
        for (const auto& [view, uses] : views_) {
            const std::string pointer = fmt::format("/bufferViews/{}", view);
            const bool isStrided = strideOf(view) > 0;
            if (uses.kinds.size() > 1) {
                warn("accessor-layout", pointer,
                     "holds several kinds of data: vertices, indices, keyframes or inverse bind matrices");
            }
            if (isStrided && !uses.kinds.contains(kVertices)) {
                warn("accessor-layout", pointer + "/byteStride",
                     "only a buffer view of vertices may have a stride; it is followed");
            }
            if (!isStrided && uses.kinds.contains(kVertices) && uses.accessors.size() > 1) {
                warn("accessor-layout", pointer,
                     "several accessors of vertices share it, and it has no byteStride; their elements are "
                     "taken to follow each other");
            }
        }
    }

private:
    const Json& accessor(const UsedAccessor& used) const {
        return root_["accessors"][static_cast<std::size_t>(used.accessor)];
    }
    const Json& view(std::size_t index) const {
        return root_["bufferViews"][index];
    }
    std::size_t strideOf(std::size_t view) const {
        return memberOr<std::uint64_t>(this->view(view), "byteStride", 0);
    }

    enum Kind : std::uint8_t { kVertices, kIndices, kInverseBinds, kOther };
    struct ViewUse {
        std::set<Kind> kinds;
        std::set<int> accessors;
    };

    void warn(std::string id, const std::string& pointer, std::string message) {
        if (given_.insert(id + message).second) {
            document_.warn(std::move(id), pointer, std::move(message), kExport);
        }
    }

    void checkForm(const UsedAccessor& used) {
        const int type = accessor(used)["componentType"].get<int>();
        const bool normalized = memberOr(accessor(used), "normalized", false);
        const Forms own = form(type, normalized);
        const AttributeForms* const row = formsOf(used);
        const bool isTime = used.use == AccessorUse::Times;
        if (isTime && (own & kFloat) == 0) {
            warn("accessor-form", used.pointer, "the times of keyframes must be floats; they are converted");
        }
        if (row == nullptr || (own & row->core) != 0 || ((own & row->quantized) != 0 && quantized_)) {
            return;
        }
        const std::string_view mark = type == TINYGLTF_COMPONENT_TYPE_FLOAT && normalized
                                          ? "normalised floats"
                                      : normalized ? "normalised"
                                                   : "plain";
        const std::string what = fmt::format("{} has {} {}", used.name, mark,
                                             kComponentNames[type - TINYGLTF_COMPONENT_TYPE_BYTE]);
        warn(
            "accessor-form", used.pointer,
            (own & row->quantized) != 0
                ? what + ", for which the file must require KHR_mesh_quantization; they are read all the same"
                : what + ", which glTF does not allow there; they are converted");
    }

    void checkBounds(const UsedAccessor& used) {
        const bool isNeeded = used.use == AccessorUse::Times ||
                              ((used.use == AccessorUse::Attribute || used.use == AccessorUse::Target) &&
                               used.name == "POSITION");
        for (const char* const name : {"min", "max"}) {
            const Json* const bound = find(accessor(used), name);
            const std::string pointer = fmt::format("/accessors/{}", used.accessor);
            if (bound == nullptr && isNeeded) {
                warn("accessor-bounds", pointer,
                     "positions and times of keyframes must have min and max; Glint takes the bounds from "
                     "the data");
            } else if (bound != nullptr &&
                       (!bound->is_array() || bound->size() != componentsOf(accessor(used)))) {
                warn("accessor-bounds", pointer,
                     "min and max must have a number for each component; Glint takes the bounds from the "
                     "data");
            }
        }
    }

    void checkLayout(const UsedAccessor& used) {
        const Json& json = accessor(used);
        const std::size_t size = componentSizeOf(json["componentType"].get<int>());
        const auto viewIndex = json["bufferView"].get<std::size_t>();
        const std::size_t stride = strideOf(viewIndex);
        const bool isVertex = used.use == AccessorUse::Attribute || used.use == AccessorUse::Target;
        ViewUse& uses = views_[viewIndex];
        uses.kinds.insert(isVertex                                ? kVertices
                          : used.use == AccessorUse::Indices      ? kIndices
                          : used.use == AccessorUse::InverseBinds ? kInverseBinds
                                                                  : kOther);
        uses.accessors.insert(used.accessor);
        const std::uint64_t offset = memberOr<std::uint64_t>(json, "byteOffset", 0);
        const std::uint64_t inBuffer = offset + memberOr<std::uint64_t>(view(viewIndex), "byteOffset", 0);
        if (offset % size != 0 || inBuffer % size != 0 || stride % size != 0) {
            warn("accessor-layout", fmt::format("/accessors/{}", used.accessor),
                 "its elements are not at multiples of the size of a component; they are read all the same");
        }
        const std::size_t step = stride > 0 ? stride : componentsOf(json) * size;
        if (isVertex &&
            (offset % 4 != 0 || (step % 4 != 0 && memberOr<std::uint64_t>(json, "count", 0) > 1))) {
            warn("accessor-layout", fmt::format("/accessors/{}", used.accessor),
                 "elements of vertices must be at multiples of 4 bytes; they are read all the same");
        }
    }

    Document& document_;
    const Json& root_;
    bool quantized_ = false;
    std::map<std::size_t, ViewUse> views_;
    std::set<std::string> given_;  // ids and messages
};

// ---- Names of attributes (section 3.7.2.1) ----

// Returns the number of "TEXCOORD_1" after its prefix, or nothing if it is no number without leading zeros.
std::optional<int> setOf(std::string_view digits) {
    int set = 0;
    const auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), set);
    const bool isWhole = parsed.ec == std::errc() && parsed.ptr == digits.data() + digits.size();
    return isWhole && set >= 0 && std::to_string(set) == digits ? std::optional(set) : std::nullopt;
}

void checkNames(Document& document, const Json& attributes, const std::string& pointer) {
    constexpr std::array<std::string_view, 3> kSingle{"POSITION", "NORMAL", "TANGENT"};
    constexpr std::array<std::string_view, 4> kSets{"TEXCOORD_", "COLOR_", "JOINTS_", "WEIGHTS_"};
    for (const auto& [text, accessor] : attributes.items()) {
        const std::string_view name = text;
        if (name.starts_with('_') || std::ranges::find(kSingle, name) != kSingle.end()) {
            continue;
        }
        const auto prefix =
            std::ranges::find_if(kSets, [&](std::string_view one) { return name.starts_with(one); });
        const std::optional<int> set =
            prefix == kSets.end() ? std::nullopt : setOf(name.substr(prefix->size()));
        if (!set) {
            document.warn("attribute-name", fmt::format("{}/{}", pointer, name),
                          "is no name of an attribute and does not start with an underscore; it is not read",
                          "give attributes of an application names such as _TEMPERATURE");
        } else if (*set > 0 && find(attributes, fmt::format("{}{}", *prefix, *set - 1)) == nullptr) {
            document.warn("attribute-name", fmt::format("{}/{}", pointer, name),
                          fmt::format("there is no {}{}, and sets must count from 0", *prefix, *set - 1),
                          kExport);
        }
    }
}

}  // namespace

bool isSupportedExtension(const materials::MaterialModel& model, std::string_view name) {
    const int object = model.findObject(name);
    return (object >= 0 && model.objects[static_cast<std::size_t>(object)].isExtension) ||
           std::ranges::find(kKnownExtensions, name, &KnownExtension::name) != std::end(kKnownExtensions);
}

bool changesNoPicture(std::string_view name) {
    return std::find(kNoPicture.begin(), kNoPicture.end(), name) != kNoPicture.end();
}

Status checkExtensions(Document& document, const Json& root) {
    for (const char* list : {"extensionsRequired", "extensionsUsed"}) {
        const Json* names = find(root, list);
        if (names != nullptr &&
            (!names->is_array() ||
             !std::all_of(names->begin(), names->end(), [](auto& name) { return name.is_string(); }))) {
            return document.error("json-type", fmt::format("/{}", list), "must be an array of strings",
                                  "export the scene again");
        }
    }
    std::set<std::string> known;
    std::set<std::string> unread;
    for (const std::string_view list : {"extensionsRequired", "extensionsUsed"}) {
        const Json& names = arrayMember(root, list);
        for (std::size_t i = 0; i < names.size(); ++i) {
            const std::string& name = names[i].get_ref<const std::string&>();
            const std::string pointer = fmt::format("/{}/{}", list, i);
            if (changesNoPicture(name)) {
                unread.insert(name);
            } else if (isSupportedExtension(*document.options().materialModel, name)) {
                continue;
            } else if (list == "extensionsRequired") {
                return document.error(
                    "extension-unsupported", pointer,
                    fmt::format("needs the extension {}, which Glint does not support", name),
                    extensionHint(name));
            } else if (known.insert(name).second) {
                document.warn(
                    "extension-ignored", pointer,
                    fmt::format("the extension {} is not supported; what it adds is left out", name));
            }
        }
    }
    if (!unread.empty()) {
        document.note("extension-no-picture", "/extensionsUsed",
                      fmt::format("{} change{} no picture and {} not read", fmt::join(unread, ", "),
                                  unread.size() == 1 ? "s" : "", unread.size() == 1 ? "is" : "are"));
    }
    return okStatus();
}

void warnOfBrokenRules(Document& document, const Json& root) {
    checkLists(document, root);
    RequiredExtensions(document, root).check();
    visitPrimitives(root, [&](const Json& primitive, const std::string& pointer) {
        checkNames(document, primitive["attributes"], pointer + "/attributes");
    });
    AccessorRules rules(document, root);
    visitAccessors(root, *document.options().materialModel,
                   [&](const UsedAccessor& used) { rules.check(used); });
    rules.checkViews();
    // tinygltf does not read other transforms beside a matrix.
    visitElements(root, "nodes", "", [&](const Json& node, const std::string& pointer) {
        if (node.contains("matrix") &&
            (node.contains("translation") || node.contains("rotation") || node.contains("scale"))) {
            document.warn("node-matrix", pointer, "has a matrix and another transform; the matrix is used",
                          kExport);
        }
    });
}

}  // namespace glint::gltf
