// The importer's view of tinygltf. Every other header and source gets tinygltf through this one.
#pragma once

#include "gltf/document/schema.h"

// Debian's libdraco exports functions of another version of tinygltf. Another namespace keeps the two apart.
#define tinygltf glint_tinygltf
// Glint opens files and decodes images itself (model.cpp says why).
#define TINYGLTF_NO_FS
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_INCLUDE_JSON
#include <tiny_gltf.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace glint::gltf {

using tinygltf::Value;

// Makes tinygltf's model of a document that checkDocument() has accepted, and takes the document's members
// away: those that tinygltf can't be trusted with are left in `root` (model.cpp names them). `used` says for
// each accessor whether the importer reads it; the others have one element that is 0. Returns why tinygltf
// refuses the document, or an empty text.
std::string readModel(Json& root, const std::vector<bool>& used, tinygltf::Model& model);

// Return how many numbers an element of the accessor has, how many bytes a number of such a type has, and
// whether elements are matrices.
std::size_t componentsOf(const tinygltf::Accessor& accessor);
std::size_t componentSizeOf(int componentType);
bool isMatrix(const tinygltf::Accessor& accessor);

// Returns the extension of that name, or null.
const Value* extensionOf(const tinygltf::ExtensionMap& extensions, const std::string& name);
// Returns the member of a value whose types have been checked, or `fallback` where it is absent.
template <typename T>
T memberOr(const Value& object, const std::string& name, T fallback) {
    if (!object.Has(name)) {
        return fallback;
    }
    if constexpr (std::is_same_v<T, bool> || std::is_same_v<T, std::string>) {
        return object.Get(name).Get<T>();
    } else {
        return static_cast<T>(object.Get(name).GetNumberAsDouble());
    }
}
// Returns the distance of a camera's far plane if the file gives one.
std::optional<double> farPlane(const tinygltf::Camera& camera);
// Returns the number of an attribute's accessor, or -1 if it has none.
int accessorOf(const std::map<std::string, int>& attributes, const std::string& name);

}  // namespace glint::gltf
