#include "base/lists.h"
#include "emit/material_layout.h"

#include <glint/session/live_scene.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <tuple>

namespace glint::session {

namespace {

template <typename Number>
std::size_t asIndex(Number index) {
    return static_cast<std::size_t>(index);
}

auto valuesOf(const LightView& light) {
    return std::tie(light.type, light.intensity, light.position, light.direction, light.range,
                    light.innerConeAngle, light.outerConeAngle, light.size);
}

std::vector<int> listMaterials(const gltf::Mesh& mesh) {
    return base::mapped<int>(mesh.primitives, &gltf::Primitive::material);
}

void addOnce(std::vector<AttributeMask>& masks, AttributeMask mask) {
    if (std::ranges::find(masks, mask) == masks.end()) {
        masks.push_back(mask);
    }
}

}  // namespace

void makeEditable(const Package& package, SceneViewData& data) {
    data.moves = data.editable = data.sealed = true;
    // Room for the textures of all scenes of the package, in both uses, and for some more.
    for (std::uint32_t i = 0; i < package.sceneCount(); ++i) {
        data.textureRoom += static_cast<std::uint32_t>(package.scene(i).textures.size());
    }
}

LiveScene::LiveScene(const Package& package, GpuScene& gpu, SceneViewData& data, const gltf::Scene& scene,
                     materials::FeatureMask keptLobes)
    : package_(package),
      gpu_(gpu),
      data_(data),
      keptLobes_(std::move(keptLobes)),
      uploadedInstances_(data.instances.size()),
      uploadedLights_(data.lights.size()),
      uploadedAnimated_(scene.animatedMaterials.size()),
      instances_(data.instances.size()),
      lights_(data.lights.size()) {
    const SceneEditor& editor = *gpu.editor();
    const PackageScene known = package.scene(data.packageScene);
    for (std::uint32_t i = 0; i < known.materials.size(); ++i) {
        materials_[static_cast<int>(i)].handle = editor.material(i);
    }
    for (std::uint32_t i = 0; i < known.textures.size(); ++i) {
        const package::TextureEntry& entry = known.textures[i];
        textures_[{static_cast<int>(entry.image), entry.srgb != 0}] = editor.texture(i);
    }
    for (const PrimitiveView& primitive : data.primitives) {
        if (primitive.primitive == 0) {
            LiveMesh& mesh = meshOf(primitive.mesh);
            mesh.handle = editor.mesh(primitive.mesh);
            mesh.materials = listMaterials(scene.meshes[primitive.mesh]);
            for (std::size_t i = 0; i < mesh.materials.size(); ++i) {
                // The package has the keys of the primitives that have the material.
                addOnce(materials_[mesh.materials[i]].attributes, mesh.attributes[i]);
            }
        }
    }
    for (std::uint32_t i = 0; i < instances_.size(); ++i) {
        instances_[i] = {editor.instance(i), false, {}, {}, {}, {}};
    }
    for (std::uint32_t i = 0; i < lights_.size(); ++i) {
        lights_[i] = {editor.light(i), false, {}};
    }
}

LiveScene::LiveMesh& LiveScene::meshOf(std::uint32_t number) {
    LiveMesh& mesh = meshes_[number];
    if (mesh.attributes.empty()) {
        const auto first = std::ranges::find(data_.primitives, number, &PrimitiveView::mesh);
        mesh.first = asIndex(first - data_.primitives.begin());
        for (auto one = first; one != data_.primitives.end() && one->mesh == number; ++one) {
            mesh.attributes.push_back(attributesOf(package_, *one));
        }
    }
    return mesh;
}

Result<TextureHandle> LiveScene::textureFor(const gltf::Scene& scene, int texture, bool srgb) {
    const int image = scene.textures[asIndex(texture)].image;
    TextureHandle& handle = textures_[{image, srgb}];
    if (handle.generation == 0) {
        GLINT_TRY(handle, gpu_.editor()->addTexture(data_.images[asIndex(image)], srgb));
    }
    return handle;
}

// Adds the textures that the material reads, and makes its record and keys.
Result<MaterialSourceData> LiveScene::sourceOf(const gltf::Scene& scene, int index,
                                               const std::vector<AttributeMask>& attributes) {
    const materials::Material& material = scene.materials[asIndex(index)];
    std::vector<EditedTextures> textures(scene.textures.size());
    for (const auto& [i, info] : material.textures) {
        const int texture = info.texture;
        if (texture < 0 || data_.materialLayout.slotOf(static_cast<int>(i), modelOf(material)) < 0) {
            continue;
        }
        const bool srgb = material.isColor(static_cast<int>(i));
        EditedTextures& handles = textures[asIndex(texture)];
        GLINT_TRY((srgb ? handles.color : handles.data), textureFor(scene, texture, srgb));
    }
    // The keys of a material that an animation changes are for all of its values.
    const auto animated =
        std::ranges::find(scene.animatedMaterials, index, &gltf::AnimatedMaterial::material);
    const materials::Material& planned =
        animated == scene.animatedMaterials.end() ? material : animated->planned;
    MaterialSourceData source =
        makeMaterialSource(package_, data_.materialLayout, scene, planned, textures, attributes, keptLobes_);
    source.record = compiler::makeMaterialRecord(material, data_.materialLayout);
    return source;
}

// Returns the material, with a key for primitives with these attributes.
Result<MaterialHandle> LiveScene::materialFor(const gltf::Scene& scene, int index, AttributeMask attributes) {
    LiveMaterial& material = materials_[index];
    if (std::ranges::find(material.attributes, attributes) != material.attributes.end()) {
        return material.handle;
    }
    std::vector<AttributeMask> wanted = material.attributes;
    wanted.push_back(attributes);
    GLINT_TRY(const MaterialSourceData source, sourceOf(scene, index, wanted));
    if (material.handle.generation == 0) {
        GLINT_TRY(material.handle, gpu_.editor()->addMaterial(source.view()));
    } else {
        GLINT_TRY(const SceneEditor::Report report,
                  gpu_.editor()->setMaterial(material.handle, source.view()));
        note(scene, report);
    }
    material.attributes = std::move(wanted);
    return material.handle;
}

Status LiveScene::addMesh(const gltf::Scene& scene, std::uint32_t number) {
    LiveMesh& mesh = meshOf(number);
    const std::vector<int> materials = listMaterials(scene.meshes[number]);
    std::vector<SceneEditor::EditedPrimitive> primitives;
    for (std::size_t i = 0; i < mesh.attributes.size(); ++i) {
        GLINT_TRY(const MaterialHandle material, materialFor(scene, materials[i], mesh.attributes[i]));
        primitives.push_back({data_.primitives[mesh.first + i], material});
    }
    GLINT_TRY(const SceneEditor::AddedMesh added, gpu_.editor()->addMesh(primitives));
    mesh.handle = added.mesh;
    mesh.materials = materials;
    note(scene, added.report);
    return okStatus();
}

// Gives meshes the materials of a variant.
Status LiveScene::followMesh(const gltf::Scene& scene, std::uint32_t number, LiveMesh& mesh) {
    const std::vector<int> wanted = listMaterials(scene.meshes[number]);
    for (std::size_t i = 0; i < mesh.materials.size(); ++i) {
        if (std::exchange(mesh.materials[i], wanted[i]) != wanted[i]) {
            GLINT_TRY(const MaterialHandle handle, materialFor(scene, wanted[i], mesh.attributes[i]));
            GLINT_TRY(const SceneEditor::Report report,
                      gpu_.editor()->setMeshMaterial(mesh.handle, static_cast<std::uint32_t>(i), handle));
            note(scene, report);
        }
    }
    return okStatus();
}

Status LiveScene::addInstance(const gltf::Scene& scene, std::size_t index) {
    const InstanceView& view = data_.instances[index];
    instances_[index].isNew = false;
    if (meshOf(view.mesh).handle.generation == 0) {
        GLINT_TRY_DO(addMesh(scene, view.mesh));
    }
    const LiveMesh& mesh = meshes_[view.mesh];
    const gltf::Node& node = scene.nodes[data_.sources[index].node];
    std::vector<int> own;
    std::vector<MaterialHandle> handles;
    if (asIndex(node.mesh) != view.mesh) {
        own = listMaterials(scene.meshes[asIndex(node.mesh)]);
        for (std::size_t i = 0; i < own.size(); ++i) {
            GLINT_TRY(handles.emplace_back(), materialFor(scene, own[i], mesh.attributes[i]));
        }
    }
    GLINT_TRY(const SceneEditor::AddedInstance added,
              gpu_.editor()->addInstance(
                  {mesh.handle, view.objectToWorld, view.visible, handles, view.joints, view.morphWeights}));
    instances_[index] = {added.instance,
                         false,
                         std::move(own),
                         view,
                         {view.joints.begin(), view.joints.end()},
                         {view.morphWeights.begin(), view.morphWeights.end()}};
    note(scene, added.report);
    return okStatus();
}

// Follows the materials of a node, and the pose of an instance that the upload did not have.
Status LiveScene::followInstance(const gltf::Scene& scene, std::size_t index) {
    SceneEditor& editor = *gpu_.editor();
    LiveInstance& instance = instances_[index];
    const InstanceView& view = data_.instances[index];
    const LiveMesh& mesh = meshes_[view.mesh];
    const gltf::Node& node = scene.nodes[data_.sources[index].node];
    const bool hasOwn = asIndex(node.mesh) != view.mesh;
    const std::vector<int> own =
        hasOwn ? listMaterials(scene.meshes[asIndex(node.mesh)]) : std::vector<int>();
    if (own != instance.materials) {
        instance.materials = own;
        for (std::size_t i = 0; i < mesh.attributes.size(); ++i) {
            MaterialHandle handle;
            if (hasOwn) {
                GLINT_TRY(handle, materialFor(scene, own[i], mesh.attributes[i]));
            }
            GLINT_TRY(const SceneEditor::Report report,
                      editor.setInstanceMaterial(instance.handle, static_cast<std::uint32_t>(i), handle));
            note(scene, report);
        }
    }
    if (index < uploadedInstances_) {
        return okStatus();
    }
    if (view.objectToWorld != instance.view.objectToWorld) {
        GLINT_TRY_DO(editor.moveInstance(instance.handle, view.objectToWorld));
        instance.view.objectToWorld = view.objectToWorld;
    }
    if (view.visible != instance.view.visible) {
        GLINT_TRY_DO(editor.showInstance(instance.handle, view.visible));
        instance.view.visible = view.visible;
    }
    if (!std::ranges::equal(view.joints, instance.joints) ||
        !std::ranges::equal(view.morphWeights, instance.weights)) {
        GLINT_TRY_DO(editor.poseInstance(instance.handle, view.joints, view.morphWeights));
        instance.joints.assign(view.joints.begin(), view.joints.end());
        instance.weights.assign(view.morphWeights.begin(), view.morphWeights.end());
    }
    return okStatus();
}

Status LiveScene::followLight(std::size_t index, bool isPlaced) {
    LiveLight& light = lights_[index];
    const LightView& view = data_.lights[index];
    if (!isPlaced) {
        return light.handle.generation == 0 ? okStatus()
                                            : gpu_.editor()->removeLight(std::exchange(light.handle, {}));
    }
    if (std::exchange(light.isNew, false)) {
        light.view = view;
        GLINT_TRY(light.handle, gpu_.editor()->addLight(view));
    } else if (index >= uploadedLights_ && light.handle.generation != 0 &&
               valuesOf(view) != valuesOf(light.view)) {
        light.view = view;
        return gpu_.editor()->setLight(light.handle, view);
    }
    return okStatus();
}

// Gives animated materials that edits have added the values of the pose.
Status LiveScene::followMaterials(const gltf::Scene& scene) {
    for (std::size_t i = uploadedAnimated_; i < scene.animatedMaterials.size(); ++i) {
        const int index = scene.animatedMaterials[i].material;
        const auto found = materials_.find(index);
        if (found == materials_.end() || found->second.handle.generation == 0) {
            continue;
        }
        std::vector<std::uint8_t> record =
            compiler::makeMaterialRecord(scene.materials[asIndex(index)], data_.materialLayout);
        if (record != found->second.record) {
            GLINT_TRY_DO(gpu_.editor()->setMaterialValues(found->second.handle, record));
            found->second.record = std::move(record);
        }
    }
    return okStatus();
}

Status LiveScene::follow(const gltf::Scene& scene) {
    extendSceneView(scene, data_);
    poseSceneView(scene, data_);
    Status first = okStatus();
    const auto keep = [&](const Status& status) { first = first ? status : first; };
    for (auto& [number, mesh] : meshes_) {
        keep(followMesh(scene, number, mesh));
    }
    instances_.resize(data_.instances.size());
    for (std::size_t i = 0; i < instances_.size(); ++i) {
        LiveInstance& instance = instances_[i];
        if (scene.nodes[data_.sources[i].node].mesh < 0) {
            if (instance.handle.generation != 0) {
                keep(gpu_.editor()->removeInstance(std::exchange(instance.handle, {})));
            }
        } else if (instance.isNew) {
            keep(addInstance(scene, i));
        } else if (instance.handle.generation != 0) {
            keep(followInstance(scene, i));
        }
    }
    std::vector<bool> isPlaced(scene.lights.size(), false);
    for (const gltf::Node& node : scene.nodes) {
        if (node.light >= 0) {
            isPlaced[asIndex(node.light)] = true;
        }
    }
    lights_.resize(data_.lights.size());
    for (std::size_t i = 0; i < data_.lightSources.size(); ++i) {
        if (data_.lightSources[i] >= 0) {
            keep(followLight(i, isPlaced[asIndex(data_.lightSources[i])]));
        }
    }
    keep(followMaterials(scene));
    return first;
}

MotionView LiveScene::motion() const {
    MotionView view = data_.motion();
    view.instances = view.instances.first(uploadedInstances_);
    view.lights = view.lights.first(uploadedLights_);
    return view;
}

std::vector<Diagnostic> LiveScene::takeNotes() {
    return std::exchange(notes_, {});
}

std::optional<std::size_t> LiveScene::instanceOf(InstanceHandle handle) const {
    const auto found = std::ranges::find(instances_, handle, &LiveInstance::handle);
    return found == instances_.end() || handle.generation == 0
               ? std::nullopt
               : std::optional(asIndex(found - instances_.begin()));
}

void LiveScene::note(const gltf::Scene& scene, const SceneEditor::Report& report) {
    for (const SceneEditor::Report::MissingCase& missing : report.missing) {
        const auto found = std::ranges::find_if(
            materials_, [&](const auto& one) { return one.second.handle == missing.material; });
        const std::string name =
            found == materials_.end() ? std::string() : scene.materials[asIndex(found->first)].name;
        Diagnostic note{Severity::Note, "edit-fallback", scene.path,
                        fmt::format("the package has no shader for the material \"{}\" ({}), which its "
                                    "fallback shades",
                                    name, fmt::join(missing.names, ", ")),
                        "compile the scene together with the files whose materials it gets"};
        if (std::ranges::find(notes_, note.message, &Diagnostic::message) == notes_.end()) {
            notes_.push_back(std::move(note));
        }
    }
}

}  // namespace glint::session
