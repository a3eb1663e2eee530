// Lists of materials without a scene. A list becomes a document of glTF with a sphere for each material, so
// that all that reads scenes reads lists: docs/material_lists.md.
#pragma once

#include "base/fields_fwd.h"
#include "base/files.h"
#include "base/json.h"
#include "gltf/document/files.h"
#include "gltf/document/schema.h"
#include "materials/material_model.h"

#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace glint::gltf {

// A texture of a listed material, if it is more than the name of a file.
struct ListedTexture {
    std::string file{};  // relative to the list; empty: a program gives the texture at run time
    std::string name{};
    std::uint32_t texCoord = 0;
    std::vector<double> offset{};
    std::vector<double> scale{};
    double rotation = 0.0;  // radians
};

struct ListedMaterial {
    std::string name{};
    std::string model{};  // the name of a base's declaration; empty: metallic-roughness
    std::vector<std::string> features{};
    std::map<std::string, base::Json> values{};  // a number, or a list of them, by the name of the parameter
    std::map<std::string, base::Json> textures{};  // the name of a file, or a ListedTexture
    std::vector<std::string> edited{};             // parameters
    std::vector<std::string> attributes{};
    std::string alphaMode = "OPAQUE";
    bool doubleSided = false;
    double weight = 1.0;
};

struct MaterialList {
    std::string schema;  // for editors
    std::vector<ListedMaterial> materials;
};
base::Fields fieldsOf(const ListedTexture* none);
base::Fields fieldsOf(const ListedMaterial* none);
base::Fields fieldsOf(const MaterialList* none);

// The document that a list becomes.
// Moving the Json can't throw here. NOLINTNEXTLINE(bugprone-exception-escape)
struct ExpandedList {
    Json document;
    base::Bytes buffer;  // the document's only buffer
    // The list's pointers of what has another one in the document:
    // "/materials/0/extensions/KHR_materials_sheen/…".
    std::map<std::string, std::string, std::less<>> places;
    std::vector<std::pair<int, int>> edited;  // materials, and parameters that may be anything in their range
};

// A member of images of such a document whose texels are given at run time.
inline constexpr const char* kAtRunTime = "glintAtRunTime";

bool isMaterialList(const Json& json);
// `text` is that of the file `path`. Errors: "material-list".
Result<ExpandedList> expandMaterialList(ByteView text, const std::filesystem::path& path,
                                        const materials::MaterialModel& model);

}  // namespace glint::gltf
