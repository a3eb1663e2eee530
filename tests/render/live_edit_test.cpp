// Scenes that are edited at random while two frames are in flight: the picture must be that of a scene that
// is uploaded afresh with the same content, to the bit.
#include "render/edited_scene.h"
#include "scene/scene_store.h"
#include "support/must.h"
#include "support/nightly.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <string>

namespace glint::testing {
namespace {

// Makes one random edit after another.
class RandomEdits {
public:
    RandomEdits(EditedScene& edited, std::uint32_t seed)
        : edited_(edited), random_(seed), lamps_(edited.package().emission() != nullptr) {}

    void next() {
        const std::function<void()> edits[] = {[&] { changeValues(); },
                                               [&] { changeKind(); },
                                               [&] { replaceTexture(); },
                                               [&] { renewTexture(); },
                                               [&] { addMaterial(); },
                                               [&] { removeMaterial(); },
                                               [&] { addMesh(); },
                                               [&] { changeMesh(); },
                                               [&] { removeMesh(); },
                                               [&] { addInstance(); },
                                               [&] { addInstance(); },
                                               [&] { moveInstance(); },
                                               [&] { moveInstance(); },
                                               [&] { showInstance(); },
                                               [&] { exchangeMesh(); },
                                               [&] { changeVariant(); },
                                               [&] { removeInstance(); },
                                               [&] { addLight(); },
                                               [&] { changeLight(); },
                                               [&] { removeLight(); },
                                               [&] { refused(); },
                                               [&] { switchPackage(); },
                                               [&] { seal(); }};
        edits[below(std::size(edits))]();
    }

    // Removes what was added, and gives what was uploaded its own meshes, materials and textures again. The
    // package is again the first one.
    void removeAll() {
        if (edited_.isSwitched()) {
            edited_.switchPackage();
        }
        for (std::size_t i = edited_.instances.size(); i-- > 0;) {
            EditedScene::Instance& instance = edited_.instances[i];
            if (instance.first) {
                instance.mesh = i;
                instance.materials.clear();
                expectDone(editor().setInstanceMesh(instance.handle, edited_.meshes[i].handle));
            } else {
                eraseInstance(i);
            }
        }
        for (std::size_t i = edited_.meshes.size(); i-- > 0;) {
            EditedScene::Mesh& mesh = edited_.meshes[i];
            if (mesh.first) {
                mesh.materials[0] = i == 0 ? 0 : 3;
                expectDone(editor().setMeshMaterial(mesh.handle, 0, material(mesh.materials[0])));
            } else {
                eraseMesh(i);
            }
        }
        for (std::size_t i = edited_.materials.size(); i-- > 0;) {
            if (!edited_.materials[i].first) {
                eraseMaterial(i);
            }
        }
        for (std::size_t i = edited_.lights.size(); i-- > 0;) {
            if (!edited_.lights[i].first) {
                expectDone(editor().removeLight(edited_.lights[i].handle));
                edited_.lights.erase(edited_.lights.begin() + static_cast<std::ptrdiff_t>(i));
            }
        }
        const gltf::Scene& original = edited_.original;
        for (std::size_t i = 0; i < edited_.textures.size(); ++i) {
            EditedScene::Texture& texture = edited_.textures[i];
            texture.width = static_cast<std::uint32_t>(original.images[i].width);
            texture.height = static_cast<std::uint32_t>(original.images[i].height);
            texture.pixels = original.images[i].pixels;
            expectDone(editor().replaceTexture(texture.handle, texture.view()));
        }
    }

    std::map<std::string, int> made;  // edits by name

private:
    SceneEditor& editor() {
        return edited_.editor();
    }
    std::size_t below(std::size_t count) {
        return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_);
    }
    float between(float low, float high) {
        return std::uniform_real_distribution<float>(low, high)(random_);
    }
    MaterialHandle material(std::size_t index) const {
        return edited_.materials[index].handle;
    }
    template <typename T>
    void expectDone(const Result<T>& result) {
        EXPECT_TRUE(result) << (result ? "" : toString(result.error()));
    }

    void switchPackage() {
        ++made["another package"];
        edited_.switchPackage();
    }

    void seal() {
        std::vector<InstanceHandle> handles;
        for (const EditedScene::Instance& instance : edited_.instances) {
            if (below(3) != 0) {
                handles.push_back(instance.handle);
            }
        }
        ++made["seal"];
        EXPECT_TRUE(editor().seal(handles));
    }

    void changeValues() {
        ++made["values"];
        const auto kind = static_cast<std::uint32_t>(below(kKinds));
        materials::Material& changed = edited_.scene.materials[kind];
        changed["baseColorFactor"] = {between(0.1F, 0.9F), between(0.1F, 0.9F), between(0.1F, 0.9F), 1.0F};
        if (kind != 0 && kind != 4) {
            changed["roughnessFactor"] = between(0.2F, 0.8F);
        }
        if (lamps_ && (kind == 1 || kind == 3)) {
            const float strength = below(3) == 0 ? 0.0F : between(1, 8);
            changed["emissiveFactor"] = {strength, strength * between(0, 1), strength * between(0, 1)};
        }
        const session::MaterialSourceData source = edited_.source(kind);
        for (const EditedScene::Material& one : edited_.materials) {
            if (one.kind == kind) {
                expectDone(editor().setMaterialValues(one.handle, source.record));
            }
        }
    }

    // Another key. The materials of the upload keep their kinds, because others are made from those.
    void changeKind() {
        if (edited_.materials.size() == kKinds) {
            return;
        }
        ++made["another key"];
        EditedScene::Material& one = edited_.materials[kKinds + below(edited_.materials.size() - kKinds)];
        one.kind = static_cast<std::uint32_t>(below(kKinds));
        const session::MaterialSourceData source = edited_.source(one.kind);
        const Result<SceneEditor::Report> report = editor().setMaterial(one.handle, source.view());
        expectDone(report);
        EXPECT_TRUE(report && report->missing.empty());
    }

    void fill(EditedScene::Texture& texture) {
        // Large enough that the picture shows their mips.
        texture.width = static_cast<std::uint32_t>(1 + below(64));
        texture.height = static_cast<std::uint32_t>(1 + below(64));
        texture.pixels.clear();
        for (std::uint32_t i = 0; i < texture.width * texture.height; ++i) {
            const auto value = [&] { return static_cast<std::uint8_t>(below(256)); };
            texture.pixels.insert(texture.pixels.end(), {value(), value(), value(), value()});
        }
    }

    void replaceTexture() {
        ++made["texture"];
        EditedScene::Texture& texture = edited_.textures[below(edited_.textures.size())];
        fill(texture);
        expectDone(editor().replaceTexture(texture.handle, texture.view()));
    }

    // A texture of its own takes the place of another, which is removed.
    void renewTexture() {
        ++made["new texture"];
        EditedScene::Texture& texture = edited_.textures[below(edited_.textures.size())];
        fill(texture);
        const TextureHandle added = must(editor().addTexture(texture.view(), true));
        const TextureHandle old = std::exchange(texture.handle, added);
        for (const EditedScene::Material& one : edited_.materials) {
            const session::MaterialSourceData source = edited_.source(one.kind);
            expectDone(editor().setMaterial(one.handle, source.view()));
        }
        expectDone(editor().removeTexture(old));
    }

    void addMaterial() {
        if (edited_.materials.size() > 16) {
            return;
        }
        ++made["add material"];
        const auto kind = static_cast<std::uint32_t>(below(kKinds));
        const session::MaterialSourceData source = edited_.source(kind);
        const MaterialHandle added = must(editor().addMaterial(source.view()));
        edited_.materials.push_back({added, kind, false});
    }

    bool isUsed(std::size_t index) const {
        const auto names = [&](const auto& list) { return std::ranges::find(list, index) != list.end(); };
        return std::ranges::any_of(edited_.meshes, [&](const auto& mesh) { return names(mesh.materials); }) ||
               std::ranges::any_of(edited_.instances, [&](const auto& one) { return names(one.materials); });
    }

    void eraseMaterial(std::size_t index) {
        expectDone(editor().removeMaterial(material(index)));
        edited_.materials.erase(edited_.materials.begin() + static_cast<std::ptrdiff_t>(index));
        const auto shift = [&](auto& place) {
            if (place > index) {
                place = static_cast<std::size_t>(place) - 1;
            }
        };
        for (EditedScene::Mesh& mesh : edited_.meshes) {
            std::ranges::for_each(mesh.materials, shift);
        }
        for (EditedScene::Instance& instance : edited_.instances) {
            for (std::optional<std::size_t>& own : instance.materials) {
                if (own) {
                    shift(*own);
                }
            }
        }
    }

    void removeMaterial() {
        const std::size_t index = below(edited_.materials.size());
        if (edited_.materials[index].first) {
            return;
        }
        if (isUsed(index)) {
            expectRefused(editor().removeMaterial(material(index)), "scene-edit-used");
            return;
        }
        ++made["remove material"];
        eraseMaterial(index);
    }

    void addMesh() {
        if (edited_.meshes.size() > 12) {
            return;
        }
        ++made["add mesh"];
        EditedScene::Mesh mesh;
        mesh.shape = static_cast<std::uint32_t>(below(kShapes));
        std::vector<SceneEditor::EditedPrimitive> primitives;
        for (std::size_t i = 0; i < primitivesOfShape(mesh.shape); ++i) {
            mesh.materials.push_back(below(edited_.materials.size()));
            primitives.push_back({edited_.primitive(mesh.shape, i), material(mesh.materials.back())});
        }
        const SceneEditor::AddedMesh added = must(editor().addMesh(primitives));
        mesh.handle = added.mesh;
        edited_.meshes.push_back(mesh);
    }

    void changeMesh() {
        ++made["mesh material"];
        EditedScene::Mesh& mesh = edited_.meshes[below(edited_.meshes.size())];
        const std::size_t primitive = below(mesh.materials.size());
        mesh.materials[primitive] = below(edited_.materials.size());
        expectDone(editor().setMeshMaterial(mesh.handle, static_cast<std::uint32_t>(primitive),
                                            material(mesh.materials[primitive])));
    }

    void eraseMesh(std::size_t index) {
        expectDone(editor().removeMesh(edited_.meshes[index].handle));
        edited_.meshes.erase(edited_.meshes.begin() + static_cast<std::ptrdiff_t>(index));
        for (EditedScene::Instance& instance : edited_.instances) {
            instance.mesh -= instance.mesh > index ? 1 : 0;
        }
    }

    void removeMesh() {
        const std::size_t index = below(edited_.meshes.size());
        const bool used = std::ranges::find(edited_.instances, index, &EditedScene::Instance::mesh) !=
                          edited_.instances.end();
        if (used) {
            expectRefused(editor().removeMesh(edited_.meshes[index].handle), "scene-edit-used");
        } else if (!edited_.meshes[index].first) {
            ++made["remove mesh"];
            eraseMesh(index);
        }
    }

    // Turned about the vertical, sometimes mirrored, and rarely flat.
    std::array<float, 12> anywhere() {
        // Lamps shine at what is behind them, too.
        const float most = lamps_ ? 3.0F : 1.2F;
        const float angle = between(-most, most);
        const float size = below(12) == 0 ? 0.0F : between(0.5F, 1.5F);
        const float mirror = below(4) == 0 ? -1.0F : 1.0F;
        const float c = size * std::cos(angle);
        const float s = size * std::sin(angle);
        return {mirror * c,  0, s, between(-1.5F, 1.5F), 0, size, 0, between(-0.6F, 0.8F),
                mirror * -s, 0, c, between(-5, -2)};
    }

    std::vector<std::optional<std::size_t>> variants(const EditedScene::Mesh& mesh) {
        std::vector<std::optional<std::size_t>> own;
        for (std::size_t i = 0; i < mesh.materials.size() && below(2) == 0; ++i) {
            own.resize(mesh.materials.size());
            own[i] = below(edited_.materials.size());
        }
        return own;
    }

    std::vector<MaterialHandle> handlesOf(std::span<const std::optional<std::size_t>> own) const {
        std::vector<MaterialHandle> handles;
        for (const std::optional<std::size_t>& one : own) {
            handles.push_back(one ? material(*one) : MaterialHandle{});
        }
        return handles;
    }

    void addInstance() {
        if (edited_.instances.size() > 10) {
            return;
        }
        ++made["add instance"];
        EditedScene::Instance instance;
        instance.mesh = below(edited_.meshes.size());
        instance.materials = variants(edited_.meshes[instance.mesh]);
        instance.objectToWorld = anywhere();
        instance.visible = below(5) != 0;
        const std::vector<MaterialHandle> own = handlesOf(instance.materials);
        const SceneEditor::AddedInstance added = must(editor().addInstance(
            {edited_.meshes[instance.mesh].handle, instance.objectToWorld, instance.visible, own}));
        instance.handle = added.instance;
        edited_.instances.push_back(instance);
    }

    EditedScene::Instance& anyInstance() {
        return edited_.instances[below(edited_.instances.size())];
    }

    void moveInstance() {
        ++made["move"];
        EditedScene::Instance& instance = anyInstance();
        instance.objectToWorld = anywhere();
        expectDone(editor().moveInstance(instance.handle, instance.objectToWorld));
    }

    void showInstance() {
        ++made["show"];
        EditedScene::Instance& instance = anyInstance();
        instance.visible = below(3) != 0;
        expectDone(editor().showInstance(instance.handle, instance.visible));
    }

    void exchangeMesh() {
        ++made["another mesh"];
        EditedScene::Instance& instance = anyInstance();
        instance.mesh = below(edited_.meshes.size());
        instance.materials = variants(edited_.meshes[instance.mesh]);
        expectDone(editor().setInstanceMesh(instance.handle, edited_.meshes[instance.mesh].handle,
                                            handlesOf(instance.materials)));
    }

    void changeVariant() {
        ++made["variant"];
        EditedScene::Instance& instance = anyInstance();
        const std::size_t count = edited_.meshes[instance.mesh].materials.size();
        const std::size_t primitive = below(count);
        instance.materials.resize(count);
        std::optional<std::size_t>& own = instance.materials[primitive];
        own = below(3) == 0 ? std::nullopt : std::optional(below(edited_.materials.size()));
        expectDone(editor().setInstanceMaterial(instance.handle, static_cast<std::uint32_t>(primitive),
                                                own ? material(*own) : MaterialHandle{}));
    }

    void eraseInstance(std::size_t index) {
        expectDone(editor().removeInstance(edited_.instances[index].handle));
        edited_.instances.erase(edited_.instances.begin() + static_cast<std::ptrdiff_t>(index));
    }

    void removeInstance() {
        const std::size_t index = below(edited_.instances.size());
        if (!edited_.instances[index].first) {
            ++made["remove instance"];
            eraseInstance(index);
        }
    }

    LightView anyLight() {
        LightView light;
        light.type = static_cast<LightView::Type>(below(3));
        light.intensity = {between(0.5F, 3), between(0.5F, 3), between(0.5F, 3)};
        light.position = {between(-2, 2), between(0, 2), between(-4, 0)};
        light.direction = {0.0F, -0.6F, -0.8F};
        return light;
    }

    void addLight() {
        if (edited_.lights.size() > 5) {
            return;
        }
        ++made["add light"];
        const LightView view = anyLight();
        const LightHandle added = must(editor().addLight(view));
        edited_.lights.push_back({added, view, false});
    }

    void changeLight() {
        ++made["light"];
        EditedScene::Light& light = edited_.lights[below(edited_.lights.size())];
        light.view = anyLight();
        expectDone(editor().setLight(light.handle, light.view));
    }

    void removeLight() {
        const std::size_t index = below(edited_.lights.size());
        if (!edited_.lights[index].first) {
            ++made["remove light"];
            expectDone(editor().removeLight(edited_.lights[index].handle));
            edited_.lights.erase(edited_.lights.begin() + static_cast<std::ptrdiff_t>(index));
        }
    }

    template <typename T>
    void expectRefused(const Result<T>& result, const std::string& id) {
        ++made["refused"];
        ASSERT_FALSE(result) << id;
        EXPECT_EQ(result.error().id, id);
    }

    // What is refused changes nothing, which the next pictures show.
    void refused() {
        EditedScene::Instance& instance = anyInstance();
        std::array<float, 12> rows = anywhere();
        rows[below(12)] = NAN;
        expectRefused(editor().moveInstance(instance.handle, rows), "scene-edit-value");
        InstanceHandle gone = instance.handle;
        gone.generation += 1000000;
        expectRefused(editor().removeInstance(gone), "scene-edit-handle");
    }

    EditedScene& edited_;
    std::mt19937 random_;
    bool lamps_;  // the kinds 1 and 3 are lights
};

std::vector<std::string> memoryOf(const GpuScene& scene) {
    std::vector<std::string> lines;
    for (const MemoryItem& item : scene.memory()) {
        lines.push_back(item.name + ": " + std::to_string(item.count) + " in " + std::to_string(item.bytes));
    }
    std::ranges::sort(lines);
    return lines;
}

void runEdits(EditedScene& edited, int count, std::uint32_t seed) {
    const int interval = test::nightly() ? 100 : 20;
    edited.expectSameAsFresh("as uploaded");
    const std::vector<std::string> memory = memoryOf(edited.gpuScene());
    const std::uint64_t allocated = edited.gpuScene().allocatedBytes();
    RandomEdits edits(edited, seed);
    std::mt19937 pace(seed);
    for (int i = 1; i <= count && !::testing::Test::HasFailure(); ++i) {
        edits.next();
        if (pace() % 2 == 0) {
            edited.frame();
        }
        if (i % interval == 0) {
            edited.expectSameAsFresh("after " + std::to_string(i) + " edits");
        }
    }
    if (count >= 300) {
        EXPECT_EQ(edits.made.size(), 21U) << "every kind of edit";
    }
    edits.removeAll();
    edited.frame();
    edited.drain();
    edited.editor().trim();
    edited.expectSameAsFresh("after all was removed");
    EXPECT_EQ(edited.editor().retiredBytes(), 0U);
    EXPECT_EQ(memoryOf(edited.gpuScene()), memory);
    EXPECT_EQ(edited.gpuScene().allocatedBytes(), allocated);
}

TEST(LiveEdit, RandomEditsShowWhatAFreshUploadShows) {
    EditedSceneOptions options;
    options.traversalOrder = SceneView::TraversalOrder::Input;  // else no BLAS has several primitives
    EditedScene edited(options);
    runEdits(edited, test::nightly() ? 10000 : 300, 1);
}

TEST(LiveEdit, TheLightHierarchyFollowsTheLights) {
    EditedSceneOptions options;
    options.settings.lightSamples = 2;
    EditedScene edited(options);
    runEdits(edited, test::nightly() ? 1000 : 120, 2);
}

TEST(LiveEdit, EmissiveTrianglesFollowEdits) {
    EditedScene edited(EditedSceneOptions::withLamps(2));
    runEdits(edited, test::nightly() ? 2000 : 100, 3);
}

TEST(LiveEdit, EmissiveTrianglesWithoutAHierarchyFollowEdits) {
    EditedScene edited(EditedSceneOptions::withLamps(0));
    runEdits(edited, test::nightly() ? 1000 : 40, 4);
}

}  // namespace
}  // namespace glint::testing
