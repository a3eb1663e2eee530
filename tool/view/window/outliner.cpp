// The outliner: the tree of nodes, the controls of the one that is selected, and the edits that they make.
#include "gltf/motion/transform.h"
#include "view/window/window.h"

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <imgui.h>
#include <numbers>
#include <utility>

namespace glint::view {

namespace {

using session::Edit;
using session::EditKind;

constexpr float kMetresPerPixel = 0.01F;
constexpr std::size_t kOpenNodes = 256;  // trees of more nodes begin closed

std::string kindOf(const gltf::Node& node) {
    std::string kind = node.mesh >= 0 ? (node.skin >= 0 ? "skinned mesh" : "mesh") : "";
    kind += node.light >= 0 ? (kind.empty() ? "light" : ", light") : "";
    kind += node.camera >= 0 ? (kind.empty() ? "camera" : ", camera") : "";
    return kind;
}

std::string titleOf(const gltf::Node& node) {
    return node.name.empty() ? fmt::format("node {}", node.source) : node.name;
}

std::string titleOf(const gltf::Scene& scene, int material) {
    const std::string& name = scene.materials[static_cast<std::size_t>(material)].name;
    return name.empty() ? fmt::format("material {}", material) : name;
}

// Draws a row of numbers that can be dragged or typed, each with a control of its own: "node.x". Returns
// whether any has changed.
bool dragNumbers(Controls& controls, const std::string& name, std::span<const char* const> parts,
                 std::span<double> numbers, float speed, const char* format) {
    bool changed = false;
    const float room = ImGui::GetContentRegionAvail().x - ImGui::GetFontSize() * 5.0F;
    const auto width = room / static_cast<float>(numbers.size()) - ImGui::GetStyle().ItemSpacing.x;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const std::string control = name + "." + parts[i];
        auto number = static_cast<float>(numbers[i]);
        ImGui::SetNextItemWidth(std::max(width, 1.0F));
        if (controls.mark(control,
                          ImGui::DragFloat(("##" + control).c_str(), &number, speed, 0.0F, 0.0F, format))) {
            numbers[i] = number;
            changed = true;
        }
        ImGui::SameLine();
    }
    ImGui::TextUnformatted(name.substr(name.rfind('.') + 1).c_str());
    return changed;
}

constexpr const char* kAxes[] = {"x", "y", "z"};

}  // namespace

// --- Edits ---

// Adds an edit to the list and makes it. Dragging a number makes many edits of one thing, of which the last
// counts.
void Window::edit(Edit edit) {
    edit.place = "outliner";
    std::size_t same = edits_.size();
    const bool isDragged = edit.kind == EditKind::Move || edit.kind == EditKind::Light;
    if (isDragged && !edits_.empty() && edits_.back().kind == edit.kind && edits_.back().node == edit.node) {
        edits_.pop_back();
        --same;
    }
    edits_.push_back(std::move(edit));
    for (std::size_t i = 0; i < kPictures; ++i) {
        if (!sides_[i]) {
            continue;
        }
        finishSamples();
        Picture& picture = sides_[i]->picture;
        if (const Status made = picture.edit(edits_, same, presenter_->submitted() + 1); !made) {
            fail(made.error());
        }
        if (picture.needsBuild()) {
            say("compiling for the edit");
            order(i);
        }
    }
    // A camera of the scene may be below a node that has moved.
    cameraIsNew_ = cameraIsNew_ || !camera_.moved();
    wakes_ = 4;
}

void Window::editNode(EditKind kind) {
    Edit one{.kind = kind};
    one.node = session::nodeLabel(side().picture.scene(), selected_);
    edit(std::move(one));
}

// Forgets the edits for which there is no build, because it has failed.
void Window::dropEdits(const Diagnostic& error) {
    const std::size_t made = side().picture.isReady() ? side().picture.build().edits : 0;
    std::size_t kept = std::min(made, edits_.size());
    while (kept < edits_.size() && !session::needShaders(std::span(edits_).subspan(kept, 1))) {
        ++kept;
    }
    if (kept == edits_.size() || !side().picture.needsBuild()) {
        return;
    }
    edits_.resize(kept);
    forSides([&](Side& one) { reportErrorOf(one.picture.edit(edits_, kept, presenter_->submitted() + 1)); });
    say("the edit was not made: " + error.message);
}

// --- The panel ---

void Window::drawOutliner() {
    showsOutliner_ = true;
    if (!side().picture.isReady() || opening_) {
        return;
    }
    const gltf::Scene& scene = side().picture.scene();
    std::vector<std::vector<int>> children(scene.nodes.size() + 1);
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        if (session::isPresent(scene.nodes[i])) {
            const int parent = scene.nodes[i].parent;
            children[parent < 0 ? scene.nodes.size() : static_cast<std::size_t>(parent)].push_back(
                static_cast<int>(i));
        }
    }
    if (selected_ >= static_cast<int>(scene.nodes.size()) ||
        (selected_ >= 0 && !session::isPresent(scene.nodes[static_cast<std::size_t>(selected_)]))) {
        selected_ = -1;
    }
    ImGui::BeginChild("nodes", {0.0F, ImGui::GetContentRegionAvail().y * 0.45F});
    for (const int top : children.back()) {
        drawNode(scene, children, top);
    }
    ImGui::EndChild();
    ImGui::Separator();
    ImGui::BeginChild("selected");
    if (selected_ >= 0) {
        // The scene may be another one after an edit.
        drawSelected(scene);
    } else {
        ImGui::TextDisabled("Select a node here, or click the picture.");
    }
    drawVariants(side().picture.scene());
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - ImGui::GetFontSize() * 5.0F);
    std::array<char, 1024> text{};
    std::copy_n(addedFile_.begin(), std::min(addedFile_.size(), text.size() - 1), text.begin());
    if (ImGui::InputText("add file", text.data(), text.size(), ImGuiInputTextFlags_EnterReturnsTrue)) {
        onDrop(text.data());
        text.front() = '\0';
    }
    addedFile_ = text.data();
    controls_.mark("node.file");
    tip("a .gltf or .glb file, which is added below the selected node; or drop it on the window");
    ImGui::EndChild();
}

void Window::drawNode(const gltf::Scene& scene, const std::vector<std::vector<int>>& children, int index) {
    const gltf::Node& node = scene.nodes[static_cast<std::size_t>(index)];
    const std::vector<int>& below = children[static_cast<std::size_t>(index)];
    ImGuiTreeNodeFlags flags = ImGuiTreeNodeFlags_OpenOnArrow | ImGuiTreeNodeFlags_SpanAvailWidth;
    flags |= below.empty() ? ImGuiTreeNodeFlags_Leaf : ImGuiTreeNodeFlags_None;
    flags |= scene.nodes.size() <= kOpenNodes ? ImGuiTreeNodeFlags_DefaultOpen : ImGuiTreeNodeFlags_None;
    flags |= index == selected_ ? ImGuiTreeNodeFlags_Selected : ImGuiTreeNodeFlags_None;
    const std::string kind = kindOf(node);
    const std::string label = fmt::format("{}{}{}###{}", titleOf(node), kind.empty() ? "" : "  " + kind,
                                          node.visible ? "" : "  hidden", index);
    ImGui::PushStyleColor(ImGuiCol_Text,
                          ImGui::GetStyleColorVec4(node.shown ? ImGuiCol_Text : ImGuiCol_TextDisabled));
    const bool isOpen = ImGui::TreeNodeEx(label.c_str(), flags);
    ImGui::PopStyleColor();
    if (controls_.mark("node " + titleOf(node), ImGui::IsItemClicked() && !ImGui::IsItemToggledOpen())) {
        selected_ = index;
    }
    if (isOpen) {
        for (const int child : below) {
            drawNode(scene, children, child);
        }
        ImGui::TreePop();
    }
}

void Window::drawSelected(const gltf::Scene& scene) {
    const gltf::Node& node = scene.nodes[static_cast<std::size_t>(selected_)];
    // An edit may replace the scene, and the node with it.
    const bool hasMesh = node.mesh >= 0;
    const bool hasLight = node.light >= 0;
    ImGui::TextUnformatted(titleOf(node).c_str());
    const auto button = [&](const char* title, EditKind kind) {
        ImGui::SameLine();
        const bool pressed = ImGui::Button(title);
        controls_.mark(title);
        if (pressed) {
            editNode(kind);
        }
        return pressed;
    };
    if (button(node.visible ? "Hide" : "Show", node.visible ? EditKind::Hide : EditKind::Show) ||
        button("Duplicate", EditKind::Duplicate) || button("Delete", EditKind::Delete)) {
        return;
    }
    drawTransform(scene);
    if (hasMesh) {
        drawMaterials(side().picture.scene());
    }
    if (hasLight) {
        drawLight(side().picture.scene());
    }
}

void Window::drawTransform(const gltf::Scene& scene) {
    const std::optional<gltf::Transform> parts =
        session::localTransform(scene.nodes[static_cast<std::size_t>(selected_)]);
    if (!parts) {
        ImGui::TextDisabled("Its matrix has a shear.");
        return;
    }
    Edit move{.kind = EditKind::Move, .node = session::nodeLabel(scene, selected_)};
    std::array<double, 3> place = parts->translation;
    if (dragNumbers(controls_, "node.place", kAxes, place, kMetresPerPixel, "%.3f m")) {
        move.translation.assign(place.begin(), place.end());
    }
    const auto [x, y, z, w] = parts->rotation;
    constexpr double kDegrees = 180.0 / std::numbers::pi;
    const glm::dvec3 angles = glm::eulerAngles(glm::dquat(w, x, y, z)) * kDegrees;
    std::array<double, 3> turn{angles.x + 0.0, angles.y + 0.0, angles.z + 0.0};  // no -0
    if (dragNumbers(controls_, "node.turn", kAxes, turn, 0.5F, "%.1f\u00b0")) {
        const glm::dquat turned(glm::dvec3(turn[0], turn[1], turn[2]) / kDegrees);
        move.rotation = {turned.x, turned.y, turned.z, turned.w};
    }
    std::array<double, 3> scale = parts->scale;
    if (dragNumbers(controls_, "node.scale", kAxes, scale, kMetresPerPixel, "%.3f")) {
        move.scale.assign(scale.begin(), scale.end());
    }
    if (!move.translation.empty() || !move.rotation.empty() || !move.scale.empty()) {
        // All parts, because an edit of the same node replaces the one before.
        move.translation.assign(place.begin(), place.end());
        move.scale.assign(scale.begin(), scale.end());
        move.rotation = move.rotation.empty() ? std::vector<double>{x, y, z, w} : move.rotation;
        edit(std::move(move));
    }
}

void Window::drawMaterials(const gltf::Scene& scene) {
    const gltf::Node& node = scene.nodes[static_cast<std::size_t>(selected_)];
    const gltf::Mesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
    std::optional<Edit> chosen;
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
        const int present = mesh.primitives[i].material;
        const std::string name = i == 0 ? std::string("node.material") : fmt::format("node.material.{}", i);
        ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - ImGui::GetFontSize() * 5.0F);
        const bool isOpen = ImGui::BeginCombo(("material##" + name).c_str(), titleOf(scene, present).c_str());
        if (!isOpen) {
            controls_.mark(name);
            continue;
        }
        for (int material = 0; material < static_cast<int>(scene.materials.size()); ++material) {
            const std::string title = titleOf(scene, material);
            if (controls_.mark(
                    fmt::format("{}={}", name, title),
                    ImGui::Selectable(fmt::format("{}##{}", title, material).c_str(), material == present))) {
                chosen = Edit{.kind = EditKind::Material, .node = session::nodeLabel(scene, selected_)};
                chosen->material = std::to_string(material);
                chosen->primitive = static_cast<std::uint32_t>(i);
            }
        }
        closeByEscape();
        ImGui::EndCombo();
    }
    if (chosen) {
        edit(std::move(*chosen));
    }
}

void Window::drawLight(const gltf::Scene& scene) {
    const gltf::Node& node = scene.nodes[static_cast<std::size_t>(selected_)];
    const gltf::Light& light = scene.lights[static_cast<std::size_t>(node.light)];
    Edit change{.kind = EditKind::Light, .node = session::nodeLabel(scene, selected_)};
    std::array<double, 3> color{light.color[0], light.color[1], light.color[2]};
    constexpr const char* kColors[] = {"red", "green", "blue"};
    const bool changed = dragNumbers(controls_, "light.color", kColors, color, 0.005F, "%.3f");
    std::array<double, 1> intensity{light.intensity};
    constexpr const char* kUnits[] = {"value"};
    const float speed = std::max(0.01F * light.intensity, 0.01F);
    const char* const format = light.type == gltf::LightType::Directional ? "%.3f lx" : "%.3f cd";
    if (dragNumbers(controls_, "light.intensity", kUnits, intensity, speed, format) || changed) {
        for (double& channel : color) {
            channel = std::max(channel, 0.0);
        }
        change.color.assign(color.begin(), color.end());
        change.intensity = std::max(intensity[0], 0.0);
        edit(std::move(change));
    }
}

void Window::drawVariants(const gltf::Scene& scene) {
    if (scene.variants.empty()) {
        return;
    }
    std::optional<std::string> chosen;
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - ImGui::GetFontSize() * 5.0F);
    const std::string present = scene.variant.empty() ? "none" : scene.variant;
    if (ImGui::BeginCombo("variant##scene", present.c_str())) {
        const auto word = [&](const std::string& title, const std::string& variant) {
            if (controls_.mark("scene.variant=" + title,
                               ImGui::Selectable(title.c_str(), variant == scene.variant))) {
                chosen = variant;
            }
        };
        word("none", "");
        for (const std::string& variant : scene.variants) {
            word(variant, variant);
        }
        closeByEscape();
        ImGui::EndCombo();
    } else {
        controls_.mark("scene.variant");
    }
    if (chosen) {
        edit(Edit{.kind = EditKind::Variant, .variant = *chosen});
    }
}

}  // namespace glint::view
