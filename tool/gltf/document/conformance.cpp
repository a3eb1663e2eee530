#include "gltf/document/conformance.h"

#include "gltf/document/model.h"
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

// Returns the extensions in either list of a document that change no picture, in alphabetical order.
std::set<std::string> unreadOf(const Json& root) {
    std::set<std::string> names;
    for (const char* list : {"extensionsRequired", "extensionsUsed"}) {
        for (const Json& name : arrayMember(root, list)) {
            if (changesNoPicture(name.get_ref<const std::string&>())) {
                names.insert(name.get<std::string>());
            }
        }
    }
    return names;
}

std::string extensionHint(std::string_view name) {
    if (name == "EXT_texture_avif") {
        return "store the textures as PNG, JPEG or WebP";
    }
    if (name.starts_with("KHR_materials_")) {
        return fmt::format("move {} from extensionsRequired to extensionsUsed to render without it", name);
    }
    return "export the scene without this extension";
}

// Returns the error "extension-unsupported" at `pointer`.
Diagnostic unsupportedExtension(const Report& report, std::string_view name, std::string_view pointer) {
    return report.error("extension-unsupported", pointer,
                        fmt::format("needs the extension {}, which Glint does not support", name),
                        extensionHint(name));
}

constexpr const char* kExport = "export the scene again";

std::string_view nameOf(int componentType) {
    switch (componentType) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return "bytes";
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return "unsigned bytes";
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return "shorts";
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return "unsigned shorts";
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return "unsigned integers";
        default:
            return "floats";
    }
}

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

void checkLists(Report& report, const Json& document) {
    const Json& used = arrayMember(document, "extensionsUsed");
    const Json& required = arrayMember(document, "extensionsRequired");
    for (std::size_t i = 0; i < required.size(); ++i) {
        if (!isIn(used, required[i].get_ref<const std::string&>())) {
            report.warn("extension-unlisted", fmt::format("/extensionsRequired/{}", i),
                        fmt::format("{} is missing in extensionsUsed", required[i].get<std::string>()),
                        kExport);
        }
    }
    std::set<std::string> known;
    std::string root;
    visitExtensions(document, root, [&](const std::string& name, const std::string& pointer) {
        if (!isIn(used, name) && !isIn(required, name) && known.insert(name).second) {
            report.warn("extension-unlisted", pointer,
                        fmt::format("{} is missing in extensionsUsed; it is read all the same", name),
                        kExport);
        }
    });
}

// Warns of objects that a reader without the extension can't read in a file that does not require it.
class RequiredExtensions {
public:
    RequiredExtensions(Report& report, const Json& root) : report_(report), root_(root) {}

    void check() {
        if (isIn(arrayMember(root_, "extensionsUsed"), kQuantization)) {
            demand(kQuantization, "/extensionsUsed");
        }
        const Json& textures = arrayMember(root_, "textures");
        for (std::size_t i = 0; i < textures.size(); ++i) {
            for (const char* const name : kImageExtensions) {
                if (findExtension(textures[i], name) != nullptr && find(textures[i], "source") == nullptr) {
                    demand(name, fmt::format("/textures/{}", i));
                }
            }
        }
        const Json& buffers = arrayMember(root_, "buffers");
        for (std::size_t i = 0; i < buffers.size(); ++i) {
            for (const char* const name : kMeshoptExtensions) {
                if (findExtension(buffers[i], name) != nullptr && find(buffers[i], "uri") == nullptr) {
                    demand(name, fmt::format("/buffers/{}", i));
                }
            }
        }
        const Json& views = arrayMember(root_, "bufferViews");
        for (std::size_t i = 0; i < views.size(); ++i) {
            if (findExtension(views[i], "EXT_meshopt_compression") != nullptr &&
                findExtension(views[i], "KHR_meshopt_compression") != nullptr) {
                report_.warn("meshopt-layout", fmt::format("/bufferViews/{}", i),
                             "has both EXT_meshopt_compression and KHR_meshopt_compression; the former is "
                             "read",
                             kExport);
            }
        }
        checkDraco();
    }

    static constexpr const char* kQuantization = "KHR_mesh_quantization";

private:
    void demand(const char* name, const std::string& pointer) {
        if (!isIn(arrayMember(root_, "extensionsRequired"), name) && given_.insert(name).second) {
            report_.warn("extension-unlisted", pointer,
                         fmt::format("needs {}, which is missing in extensionsRequired", name), kExport);
        }
    }

    void checkDraco() {
        const Json& accessors = arrayMember(root_, "accessors");
        const Json& meshes = arrayMember(root_, "meshes");
        for (std::size_t i = 0; i < meshes.size(); ++i) {
            const Json& primitives = arrayMember(meshes[i], "primitives");
            for (std::size_t k = 0; k < primitives.size(); ++k) {
                const Json* const position = find(primitives[k]["attributes"], "POSITION");
                if (findExtension(primitives[k], kDracoExtension) != nullptr && position != nullptr &&
                    find(accessors[position->get<std::size_t>()], "bufferView") == nullptr) {
                    demand(kDracoExtension, fmt::format("/meshes/{}/primitives/{}", i, k));
                }
            }
        }
    }

    Report& report_;
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
    std::string_view prefix;
    Forms core = 0;
    Forms quantized = 0;  // further ones with KHR_mesh_quantization
};
constexpr std::array kAttributeForms{
    AttributeForms{"POSITION", kFloat, kIntegers | kFractions | kUnsigned | kUnsignedFractions},
    AttributeForms{"NORMAL", kFloat, kFractions},
    AttributeForms{"TANGENT", kFloat, kFractions},
    AttributeForms{"TEXCOORD_", kFloat | kUnsignedFractions, kIntegers | kFractions | kUnsigned},
    AttributeForms{"WEIGHTS_", kFloat | kUnsignedFractions, 0},
};
constexpr std::array kTargetForms{
    AttributeForms{"POSITION", kFloat, kIntegers | kFractions},
    AttributeForms{"NORMAL", kFloat, kFractions},
    AttributeForms{"TANGENT", kFloat, kFractions},
};
constexpr std::array kInstanceForms{
    AttributeForms{"TRANSLATION", kFloat, 0},
    AttributeForms{"ROTATION", kFloat | kFractions, 0},
    AttributeForms{"SCALE", kFloat, 0},
};

// Returns the row for the attribute, or null if any form is allowed or other messages tell of it.
const AttributeForms* formsOf(const UsedAccessor& used) {
    const auto find = [&](const auto& rows) -> const AttributeForms* {
        const auto row = std::ranges::find_if(
            rows, [&](const AttributeForms& one) { return used.name.starts_with(one.prefix); });
        return row == rows.end() ? nullptr : &*row;
    };
    switch (used.use) {
        case AccessorUse::Attribute:
            return find(kAttributeForms);
        case AccessorUse::Target:
            return find(kTargetForms);
        case AccessorUse::Instances:
            return find(kInstanceForms);
        default:
            return nullptr;
    }
}

class AccessorRules {
public:
    AccessorRules(Report& report, const Json& root) : report_(report), root_(root) {
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
        return sizeMember(this->view(view), "byteStride");
    }

    enum Kind : std::uint8_t { kVertices, kIndices, kInverseBinds, kOther };
    struct ViewUse {
        std::set<Kind> kinds;
        std::set<int> accessors;
    };

    void warn(std::string id, const std::string& pointer, std::string message) {
        if (given_.insert(id + message).second) {
            report_.warn(std::move(id), pointer, std::move(message), kExport);
        }
    }

    void checkForm(const UsedAccessor& used) {
        const int type = accessor(used)["componentType"].get<int>();
        const bool normalized = boolMember(accessor(used), "normalized", false);
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
        const std::string what = fmt::format("{} has {} {}", used.name, mark, nameOf(type));
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
        const std::uint64_t offset = sizeMember(json, "byteOffset");
        const std::uint64_t inBuffer = offset + sizeMember(view(viewIndex), "byteOffset");
        if (offset % size != 0 || inBuffer % size != 0 || stride % size != 0) {
            warn("accessor-layout", fmt::format("/accessors/{}", used.accessor),
                 "its elements are not at multiples of the size of a component; they are read all the same");
        }
        const std::size_t step = stride > 0 ? stride : componentsOf(json) * size;
        if (isVertex && (offset % 4 != 0 || (step % 4 != 0 && sizeMember(json, "count") > 1))) {
            warn("accessor-layout", fmt::format("/accessors/{}", used.accessor),
                 "elements of vertices must be at multiples of 4 bytes; they are read all the same");
        }
    }

    Report& report_;
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

void checkNames(Report& report, const Json& attributes, const std::string& pointer) {
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
            report.warn("attribute-name", fmt::format("{}/{}", pointer, name),
                        "is no name of an attribute and does not start with an underscore; it is not read",
                        "give attributes of an application names such as _TEMPERATURE");
        } else if (*set > 0 && find(attributes, fmt::format("{}{}", *prefix, *set - 1)) == nullptr) {
            report.warn("attribute-name", fmt::format("{}/{}", pointer, name),
                        fmt::format("there is no {}{}, and sets must count from 0", *prefix, *set - 1),
                        kExport);
        }
    }
}

// tinygltf does not read other transforms beside a matrix.
void checkTransforms(Report& report, const Json& root) {
    const Json& nodes = arrayMember(root, "nodes");
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (nodes[i].contains("matrix") && (nodes[i].contains("translation") ||
                                            nodes[i].contains("rotation") || nodes[i].contains("scale"))) {
            report.warn("node-matrix", fmt::format("/nodes/{}", i),
                        "has a matrix and another transform; the matrix is used", kExport);
        }
    }
}

void checkPrimitives(Report& report, const Json& root) {
    const Json& meshes = arrayMember(root, "meshes");
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        const Json& primitives = arrayMember(meshes[i], "primitives");
        for (std::size_t k = 0; k < primitives.size(); ++k) {
            checkNames(report, primitives[k]["attributes"],
                       fmt::format("/meshes/{}/primitives/{}/attributes", i, k));
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

Status checkExtensions(Report& report, const Json& root) {
    for (const char* list : {"extensionsRequired", "extensionsUsed"}) {
        const Json* names = find(root, list);
        if (names != nullptr &&
            (!names->is_array() ||
             !std::all_of(names->begin(), names->end(), [](auto& name) { return name.is_string(); }))) {
            return report.error("json-type", fmt::format("/{}", list), "must be an array of strings",
                                "export the scene again");
        }
    }
    const Json& required = arrayMember(root, "extensionsRequired");
    for (std::size_t i = 0; i < required.size(); ++i) {
        const std::string& name = required[i].get_ref<const std::string&>();
        if (!isSupportedExtension(*report.options().materialModel, name) && !changesNoPicture(name)) {
            return unsupportedExtension(report, name, fmt::format("/extensionsRequired/{}", i));
        }
    }
    std::set<std::string> warned;
    const Json& used = arrayMember(root, "extensionsUsed");
    for (std::size_t i = 0; i < used.size(); ++i) {
        const std::string& name = used[i].get_ref<const std::string&>();
        if (!isSupportedExtension(*report.options().materialModel, name) && !changesNoPicture(name) &&
            warned.insert(name).second) {
            report.warn("extension-ignored", fmt::format("/extensionsUsed/{}", i),
                        fmt::format("the extension {} is not supported; what it adds is left out", name));
        }
    }
    if (const std::set<std::string> unread = unreadOf(root); !unread.empty()) {
        report.note("extension-no-picture", "/extensionsUsed",
                    fmt::format("{} change{} no picture and {} not read", fmt::join(unread, ", "),
                                unread.size() == 1 ? "s" : "", unread.size() == 1 ? "is" : "are"));
    }
    return okStatus();
}

void warnOfBrokenRules(Report& report, const Json& root) {
    checkLists(report, root);
    RequiredExtensions(report, root).check();
    checkPrimitives(report, root);
    AccessorRules rules(report, root);
    visitAccessors(root, *report.options().materialModel,
                   [&](const UsedAccessor& used) { rules.check(used); });
    rules.checkViews();
    checkTransforms(report, root);
}

}  // namespace glint::gltf
