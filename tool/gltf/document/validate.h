// Checks a glTF document's JSON before anything is read from it, against what the importer needs
// (validate.cpp), and against the extensions that Glint reads and rules of glTF that it can do without
// (conformance.cpp).
#pragma once

#include "gltf/document/schema.h"
#include "materials/material_model.h"

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace glint::gltf {

class Document;

// An extension that the importer knows by itself; those of materials are declared (shaders/materials).
struct KnownExtension {
    std::string_view name;
    bool isInModel = true;  // tinygltf reads its objects; else Glint reads them from the JSON
};
// KHR_texture_basisu is among them even if this build does not decode it; textures.cpp decides about each
// texture.
inline constexpr KnownExtension kKnownExtensions[] = {
    {"EXT_mesh_gpu_instancing"}, {"EXT_meshopt_compression"},      {"EXT_texture_webp"},
    {"KHR_animation_pointer"},   {"KHR_draco_mesh_compression"},   {"KHR_lights_punctual"},
    {"KHR_materials_variants"},  {"KHR_mesh_quantization", false}, {"KHR_meshopt_compression"},
    {"KHR_node_visibility"},     {"KHR_texture_basisu"},           {"KHR_texture_transform", false},
    {"MSFT_texture_dds"}};
inline constexpr const char* kDracoExtension = "KHR_draco_mesh_compression";
// The names of these extensions of buffer views and buffers, and of textures. The first that is given counts.
inline constexpr const char* kMeshoptExtensions[] = {"EXT_meshopt_compression", "KHR_meshopt_compression"};
inline constexpr const char* kImageExtensions[] = {"EXT_texture_webp", "KHR_texture_basisu",
                                                   "MSFT_texture_dds"};

// Checks types, ranges and references of everything that the importer reads. It checks only the accessors
// that a mesh, an animation or a skin uses. It ignores `extras` that the model does not declare. The place of
// an error is a JSON pointer.
Status checkDocument(Json& root, const materials::MaterialModel& model);

// Returns an error for extensionsRequired that Glint can't honour. Warns once about each other extension that
// it doesn't read. One note names all those that change no picture.
Status checkExtensions(Document& document, const Json& root);

bool isSupportedExtension(const materials::MaterialModel& model, std::string_view name);

// Returns whether the extension holds only data that no picture shows: metadata, and choices for users.
bool changesNoPicture(std::string_view name);

// Warns of rules that a document breaks which checkDocument() has accepted: extensions, the names and forms
// of attributes, and where the elements of accessors lie. Equal warnings are given once, at the first place.
void warnOfBrokenRules(Document& document, const Json& root);

enum class AccessorUse : std::uint8_t {
    Attribute,
    Target,  // of a morph target
    Indices,
    Instances,  // EXT_mesh_gpu_instancing
    Times,      // of keyframes
    Keyframes,
    InverseBinds,
};
// A place from which the importer reads an accessor.
struct UsedAccessor {
    int accessor = 0;
    AccessorUse use = AccessorUse::Attribute;
    std::string_view name;  // of the member that refers to it, such as "POSITION"
    std::string pointer;    // of that member
};
using AccessorVisitor = std::function<void(const UsedAccessor&)>;
// Calls `visit` for each place of a checked document from which the importer reads an accessor.
void visitAccessors(const Json& root, const materials::MaterialModel& model, const AccessorVisitor& visit);

// Returns for each accessor whether the importer reads it. Only these have been checked.
std::vector<bool> usedAccessors(const Json& root, const materials::MaterialModel& model);

// The attributes of primitives that the importer reads.
inline constexpr const char* kAttributes[] = {
    "POSITION", "NORMAL",   "TANGENT",  "TEXCOORD_0", "TEXCOORD_1", "COLOR_0",   "JOINTS_0",
    "JOINTS_1", "JOINTS_2", "JOINTS_3", "WEIGHTS_0",  "WEIGHTS_1",  "WEIGHTS_2", "WEIGHTS_3"};
// How many sets of joints and weights are among them.
inline constexpr int kInfluenceSets = 4;
// The attributes of EXT_mesh_gpu_instancing that the importer reads.
inline constexpr const char* kInstanceAttributes[] = {"TRANSLATION", "ROTATION", "SCALE"};
// The attributes of morph targets that the importer reads.
inline constexpr const char* kTargetAttributes[] = {"POSITION", "NORMAL", "TANGENT", "COLOR_0"};

}  // namespace glint::gltf
