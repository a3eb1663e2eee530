// Edits of a scene: the list of a file, and their effect on a Scene. glint/session/live_scene.h brings the
// effect to a scene on a device. docs/live.md describes the file.
#pragma once

#include "base/fields_fwd.h"
#include "gltf/import_options.h"
#include "gltf/scene.h"

#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glint::session {

enum class EditKind : std::uint8_t {
    Hide,
    Show,
    Move,
    Delete,
    Duplicate,
    Parent,
    Material,
    Light,
    Variant,
    Add,
};
inline constexpr Named<EditKind> kEditKindNames[] = {
    {EditKind::Hide, "hide", "hides a node and all below it"},
    {EditKind::Show, "show", "shows a node again"},
    {EditKind::Move, "move", "gives a node another transform, relative to its parent"},
    {EditKind::Delete, "delete", "removes a node and all below it"},
    {EditKind::Duplicate, "duplicate", "copies a node and all below it"},
    {EditKind::Parent, "parent", "puts a node below another one; its own transform stays"},
    {EditKind::Material, "material", "gives the primitives of a node another material"},
    {EditKind::Light, "light", "changes the light of a node"},
    {EditKind::Variant, "variant", "chooses a variant of KHR_materials_variants"},
    {EditKind::Add, "add", "adds the nodes of another glTF file"},
};
constexpr std::span<const Named<EditKind>> namesOf(EditKind /*type*/) {
    return kEditKindNames;
}

// An edit. Nodes and materials are named by their name, of which the first counts, or by their number in the
// file. Things that edits add are numbered after those of the file, in their order.
struct Edit {
    std::uint32_t frame = 0;  // before which it is made
    EditKind kind = EditKind::Hide;
    std::string node{};
    // The parts of a transform that are given, as in glTF; a matrix excludes the others.
    std::vector<double> translation{};  // metres
    std::vector<double> rotation{};     // quaternion x, y, z, w
    std::vector<double> scale{};
    std::vector<double> matrix{};  // column-major
    std::string name{};            // of the node that is made
    // The node above; empty: none, and for Duplicate that of the original.
    std::string parent{};
    std::string material{};
    std::optional<std::uint32_t> primitive{};  // of the node's mesh; no value: all of them
    std::vector<double> color{};               // linear, of a light
    std::optional<double> intensity{};         // lux or candela
    std::string variant{};                     // empty: the materials of no variant
    std::string file{};                        // .gltf or .glb
    // Where it stands, for messages: "edits.json#/edits/3". Not in the file.
    std::string place{};
};
// The whole file.
struct EditList {
    std::vector<Edit> edits;
};
base::Fields fieldsOf(const EditList*);

// Reads a file of edits and sorts them by frame. Edits of one frame keep their order. Edit::file becomes
// relative to the folder of the list. Error "edit-format" with the place of the first member that is wrong,
// and those of reading a file.
Result<std::vector<Edit>> readEdits(const std::filesystem::path& file);

// Scenes that edits add, by Edit::file. They must have been read without ImportOptions::trustTextures.
using SceneFiles = std::map<std::string, std::shared_ptr<const gltf::Scene>, std::less<>>;

// Reads the files that edits add and that `files` lacks, with their default scenes. Has the errors of
// importScene().
Status readFiles(std::span<const Edit> edits, gltf::ImportOptions options, SceneFiles& files);

// Returns the node that a text names: the first with the name, or the one with the number. Nothing if there
// is none.
std::optional<int> findNode(const gltf::Scene& scene, const std::string& text);
// Returns the name of a node, or its number if the name would find another one.
std::string nodeLabel(const gltf::Scene& scene, int node);
// Returns whether the node is neither removed nor left behind by an edit that has moved it in the list.
bool isPresent(const gltf::Node& node);

// Makes an edit and returns the node that it is about, or the one that it has added; -1: none. The scene's
// pose has to be taken anew (moveTo()). Nodes and lights keep their numbers: what is removed stays as an
// empty node, and joints go on moving what follows them. A property that an edit sets is no longer animated.
// Copies of animated nodes follow the animation. Errors, after which nothing has changed: "edit-unknown" (no
// such node, material or file), "variant-unknown", "edit-value" (the edit can't be made).
Result<int> applyEdit(const Edit& edit, const SceneFiles& files, gltf::Scene& scene);

// Returns whether the edits need shaders that a package of the scene alone may lack: for other materials,
// for files, for lights.
bool needShaders(std::span<const Edit> edits);
// Returns the same of one edit of `scene`. What was seen or shone once needs no others to do so again.
bool needsShaders(const Edit& edit, const gltf::Scene& scene);
// Returns the local transform of a node at rest, or nothing if its matrix has a shear.
std::optional<gltf::Transform> localTransform(const gltf::Node& node);
// Returns the scene with all materials, primitives and lights that it has at some time between its edits,
// from which a package is made beside the scene itself. Has the errors of applyEdit().
Result<gltf::Scene> plannedScene(const gltf::Scene& scene, std::span<const Edit> edits,
                                 const SceneFiles& files);

}  // namespace glint::session
