#include "gltf/document/conformance.h"

#include "gltf/document/document.h"
#include "gltf/document/extensions.h"
#include "gltf/document/validate.h"

#include <fmt/format.h>

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

constexpr const char* kExport = "export the scene again";

std::string_view nameOf(ComponentType type) {
    switch (type) {
        case ComponentType::Byte:
            return "bytes";
        case ComponentType::UnsignedByte:
            return "unsigned bytes";
        case ComponentType::Short:
            return "shorts";
        case ComponentType::UnsignedShort:
            return "unsigned shorts";
        case ComponentType::UnsignedInt:
            return "unsigned integers";
        case ComponentType::Float:
            return "floats";
    }
    return "components";
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

void checkLists(Document& document) {
    const Json& used = arrayMember(document.json(), "extensionsUsed");
    const Json& required = arrayMember(document.json(), "extensionsRequired");
    for (std::size_t i = 0; i < required.size(); ++i) {
        if (!isIn(used, required[i].get_ref<const std::string&>())) {
            document.warn("extension-unlisted", fmt::format("/extensionsRequired/{}", i),
                          fmt::format("{} is missing in extensionsUsed", required[i].get<std::string>()),
                          kExport);
        }
    }
    std::set<std::string> known;
    std::string root;
    visitExtensions(document.json(), root, [&](const std::string& name, const std::string& pointer) {
        if (!isIn(used, name) && !isIn(required, name) && known.insert(name).second) {
            document.warn("extension-unlisted", pointer,
                          fmt::format("{} is missing in extensionsUsed; it is read all the same", name),
                          kExport);
        }
    });
}

// Warns of objects that a reader without the extension can't read in a file that does not require it.
class RequiredExtensions {
public:
    explicit RequiredExtensions(Document& document) : document_(document) {}

    void check() {
        if (isIn(arrayMember(document_.json(), "extensionsUsed"), kQuantization)) {
            demand(kQuantization, "/extensionsUsed");
        }
        const Json& textures = arrayMember(document_.json(), "textures");
        for (std::size_t i = 0; i < textures.size(); ++i) {
            for (const char* const name : {"EXT_texture_webp", "KHR_texture_basisu", "MSFT_texture_dds"}) {
                if (findExtension(textures[i], name) != nullptr && find(textures[i], "source") == nullptr) {
                    demand(name, fmt::format("/textures/{}", i));
                }
            }
        }
        const Json& buffers = arrayMember(document_.json(), "buffers");
        for (std::size_t i = 0; i < buffers.size(); ++i) {
            for (const char* const name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
                if (findExtension(buffers[i], name) != nullptr && find(buffers[i], "uri") == nullptr) {
                    demand(name, fmt::format("/buffers/{}", i));
                }
            }
        }
        const Json& views = arrayMember(document_.json(), "bufferViews");
        for (std::size_t i = 0; i < views.size(); ++i) {
            if (findExtension(views[i], "EXT_meshopt_compression") != nullptr &&
                findExtension(views[i], "KHR_meshopt_compression") != nullptr) {
                document_.warn("meshopt-layout", fmt::format("/bufferViews/{}", i),
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
        if (!requiresExtension(document_, name) && given_.insert(name).second) {
            document_.warn("extension-unlisted", pointer,
                           fmt::format("needs {}, which is missing in extensionsRequired", name), kExport);
        }
    }

    void checkDraco() {
        const Json& accessors = arrayMember(document_.json(), "accessors");
        const Json& meshes = arrayMember(document_.json(), "meshes");
        for (std::size_t i = 0; i < meshes.size(); ++i) {
            const Json& primitives = arrayMember(meshes[i], "primitives");
            for (std::size_t k = 0; k < primitives.size(); ++k) {
                constexpr const char* kDraco = "KHR_draco_mesh_compression";
                const Json* const position = find(primitives[k]["attributes"], "POSITION");
                if (findExtension(primitives[k], kDraco) != nullptr && position != nullptr &&
                    find(accessors[position->get<std::size_t>()], "bufferView") == nullptr) {
                    demand(kDraco, fmt::format("/meshes/{}/primitives/{}", i, k));
                }
            }
        }
    }

    Document& document_;
    std::set<std::string> given_;
};

// ---- Attributes (sections 3.7.2.1 and 3.7.2.2, and KHR_mesh_quantization) ----

// Forms of components, as bits: two for each component type, of which the second is for normalised ones.
using Forms = std::uint32_t;

constexpr Forms form(ComponentType type, bool normalized) {
    const auto index = static_cast<std::uint32_t>(type) - static_cast<std::uint32_t>(ComponentType::Byte);
    return 1U << (2 * index + (normalized ? 1 : 0));
}
constexpr Forms kFloat = form(ComponentType::Float, false);
constexpr Forms kUnsignedFractions =
    form(ComponentType::UnsignedByte, true) | form(ComponentType::UnsignedShort, true);
constexpr Forms kFractions = form(ComponentType::Byte, true) | form(ComponentType::Short, true);
constexpr Forms kIntegers = form(ComponentType::Byte, false) | form(ComponentType::Short, false);
constexpr Forms kUnsigned =
    form(ComponentType::UnsignedByte, false) | form(ComponentType::UnsignedShort, false);

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
    explicit AccessorRules(Document& document) : document_(document) {
        constexpr const char* kName = RequiredExtensions::kQuantization;
        quantized_ =
            requiresExtension(document, kName) || isIn(arrayMember(document.json(), "extensionsUsed"), kName);
    }

    void check(const UsedAccessor& used) {
        checkForm(used);
        checkBounds(used);
        if (document_.accessor(used.accessor).bufferView >= 0) {
            checkLayout(used);
        }
    }

    // Checks what only all uses of a buffer view together tell.
    void checkViews() {
        for (const auto& [view, uses] : views_) {
            const std::string pointer = fmt::format("/bufferViews/{}", view);
            const bool isStrided = document_.stride(view) > 0;
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
        const Accessor& accessor = document_.accessor(used.accessor);
        const Forms own = form(accessor.componentType, accessor.normalized);
        const AttributeForms* const row = formsOf(used);
        const bool isTime = used.use == AccessorUse::Times;
        if (isTime && (own & kFloat) == 0) {
            warn("accessor-form", used.pointer, "the times of keyframes must be floats; they are converted");
        }
        if (row == nullptr || (own & row->core) != 0 || ((own & row->quantized) != 0 && quantized_)) {
            return;
        }
        const std::string_view mark = accessor.componentType == ComponentType::Float && accessor.normalized
                                          ? "normalised floats"
                                      : accessor.normalized ? "normalised"
                                                            : "plain";
        const std::string what = fmt::format("{} has {} {}", used.name, mark, nameOf(accessor.componentType));
        warn(
            "accessor-form", used.pointer,
            (own & row->quantized) != 0
                ? what + ", for which the file must require KHR_mesh_quantization; they are read all the same"
                : what + ", which glTF does not allow there; they are converted");
    }

    void checkBounds(const UsedAccessor& used) {
        const Json& json = document_.json()["accessors"][static_cast<std::size_t>(used.accessor)];
        const bool isNeeded = used.use == AccessorUse::Times ||
                              ((used.use == AccessorUse::Attribute || used.use == AccessorUse::Target) &&
                               used.name == "POSITION");
        for (const char* const name : {"min", "max"}) {
            const Json* const bound = find(json, name);
            const std::string pointer = fmt::format("/accessors/{}", used.accessor);
            if (bound == nullptr && isNeeded) {
                warn("accessor-bounds", pointer,
                     "positions and times of keyframes must have min and max; Glint takes the bounds from "
                     "the data");
            } else if (bound != nullptr && (!bound->is_array() ||
                                            bound->size() != document_.accessor(used.accessor).components)) {
                warn("accessor-bounds", pointer,
                     "min and max must have a number for each component; Glint takes the bounds from the "
                     "data");
            }
        }
    }

    void checkLayout(const UsedAccessor& used) {
        const Accessor& accessor = document_.accessor(used.accessor);
        const std::size_t size = sizeOf(accessor.componentType);
        const std::size_t stride = document_.stride(accessor.bufferView);
        const bool isVertex = used.use == AccessorUse::Attribute || used.use == AccessorUse::Target;
        ViewUse& view = views_[accessor.bufferView];
        view.kinds.insert(isVertex                                ? kVertices
                          : used.use == AccessorUse::Indices      ? kIndices
                          : used.use == AccessorUse::InverseBinds ? kInverseBinds
                                                                  : kOther);
        view.accessors.insert(used.accessor);
        const Json& json = document_.json()["bufferViews"][static_cast<std::size_t>(accessor.bufferView)];
        const std::uint64_t inBuffer = accessor.offset + sizeMember(json, "byteOffset");
        if (accessor.offset % size != 0 || inBuffer % size != 0 || stride % size != 0) {
            warn("accessor-layout", fmt::format("/accessors/{}", used.accessor),
                 "its elements are not at multiples of the size of a component; they are read all the same");
        }
        const std::size_t step = stride > 0 ? stride : accessor.components * size;
        if (isVertex && (accessor.offset % 4 != 0 || (step % 4 != 0 && accessor.count > 1))) {
            warn("accessor-layout", fmt::format("/accessors/{}", used.accessor),
                 "elements of vertices must be at multiples of 4 bytes; they are read all the same");
        }
    }

    Document& document_;
    bool quantized_ = false;
    std::map<int, ViewUse> views_;
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

void checkPrimitives(Document& document) {
    const Json& meshes = arrayMember(document.json(), "meshes");
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        const Json& primitives = arrayMember(meshes[i], "primitives");
        for (std::size_t k = 0; k < primitives.size(); ++k) {
            checkNames(document, primitives[k]["attributes"],
                       fmt::format("/meshes/{}/primitives/{}/attributes", i, k));
        }
    }
}

}  // namespace

void warnOfBrokenRules(Document& document) {
    checkLists(document);
    RequiredExtensions(document).check();
    checkPrimitives(document);
    AccessorRules rules(document);
    visitAccessors(document.json(), *document.options().materialModel,
                   [&](const UsedAccessor& used) { rules.check(used); });
    rules.checkViews();
}

}  // namespace glint::gltf
