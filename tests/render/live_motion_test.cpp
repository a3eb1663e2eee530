// Tests scenes that move and are edited at once: poses, skins and morphs beside edits, with two frames in
// flight.
#include "render/edited_scene.h"
#include "render/harness.h"
#include "render/moving_scenes.h"
#include "render/replacement.h"
#include "render/scene_builder.h"
#include "scene/scene_store.h"
#include "support/must.h"
#include "support/nightly.h"

#include <glint/session/scene_view.h>

#include <array>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

constexpr std::uint32_t kWidth = 32;
constexpr std::uint32_t kHeight = 18;

// A mirror, a strip that follows joints, a strip with morph targets, and two squares of two primitives.
gltf::Scene playingScene() {
    gltf::Scene scene = skinnedScene(0.3);
    const gltf::Scene morphed = morphedScene({0.5, 0.2});
    gltf::Primitive strip = morphed.meshes[1].primitives[0];
    strip.material = addMaterial(scene, morphed.materials[static_cast<std::size_t>(strip.material)]);
    const int mesh = addMesh(scene, std::move(strip));
    scene.meshes[static_cast<std::size_t>(mesh)].weights = {0.0, 0.0};
    addInstance(scene, mesh, placed(-1, -0.8, -3, 0.1));
    scene.nodes.back().weights = {0.5, 0.2};
    const int square = addMesh(scene, makeQuad(1, {-0.3F, -0.3F, 0}, {0.6F, 0, 0}, {0, 0.6F, 0}));
    scene.meshes[static_cast<std::size_t>(square)].primitives.push_back(
        makeQuad(0, {-0.1F, -0.1F, 0.1F}, {0.2F, 0, 0.1F}, {0, 0.2F, 0}));
    addInstance(scene, square, placed(1, 0, -3));
    addInstance(scene, square, placed(1, 0.7, -2.8, 0.4));
    return scene;
}

// A scene that is edited and moves, and a description of its content.
class Playing {
public:
    Playing()
        : scene_(playingScene()),
          packages_{packageOf(scene_, EditedSceneOptions().settings)},
          frame_(defaultSetup(scene_, kWidth, kHeight).frame),
          frames_(sharedContext()) {
        if (packages_.front() == nullptr) {
            return;
        }
        data_ = session::makeSceneView(scene_);
        data_.moves = true;
        data_.traversalOrder = SceneView::TraversalOrder::Input;  // else no BLAS has several primitives
        SceneView view = data_.view();
        view.editable = true;
        gpuScene_ = uploadScene(package(), view);
        if (gpuScene_ == nullptr) {
            return;
        }
        for (std::uint32_t i = 0; i < data_.instances.size(); ++i) {
            Instance& instance = instances_.emplace_back();
            instance.handle = editor().instance(i);
            instance.uploaded = i;
            instance.take(data_.instances[i]);
        }
        lights_ = data_.lights;
        renderer_ = makeRenderer(package(), *gpuScene_, options());
    }
    GpuScene& gpuScene() {
        return *gpuScene_;
    }
    SceneEditor& editor() {
        return *gpuScene_->editor();
    }
    const Package& package() const {
        return *packages_[current_];
    }

    // Gives the nodes that play another pose, which the next frame takes.
    void pose(std::mt19937& random) {
        const auto value = [&](double least, double most) {
            return std::uniform_real_distribution<double>(least, most)(random);
        };
        scene_.nodes[3].world = placed(value(-0.3, 0.3), 0.2, -2.5, value(-0.6, 0.6));
        scene_.nodes[4].weights = {value(0, 1), value(0, 1)};
        scene_.nodes[5].world = placed(1, value(-0.5, 0.5), -3, value(-1, 1));
        scene_.lights[0].color[0] = static_cast<float>(value(0.2, 1));
        session::poseSceneView(scene_, data_);
        isPosed_ = true;
        for (Instance& instance : instances_) {
            if (instance.uploaded && kPlays[*instance.uploaded]) {
                const bool visible = instance.view.visible;
                instance.take(data_.instances[*instance.uploaded]);
                instance.view.visible = visible;  // the pose shows and hides nothing
            }
        }
        lights_[0] = data_.lights[0];
    }
    void edit(std::mt19937& random) {
        const auto number = [&](std::size_t count) {
            return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
        };
        const std::size_t chosen = number(instances_.size());
        // No two instances lie in each other: the order of triangles would decide which is seen.
        const float place = 100.0F * static_cast<float>(random()) / static_cast<float>(std::mt19937::max());
        switch (number(6)) {
            case 0:
                add(number(data_.instances.size()), place);
                break;
            case 1:
                remove(chosen);
                break;
            case 2:
                show(instances_[chosen], number(2) == 0);
                break;
            case 3:
                move(instances_[chosen], place);
                break;
            case 4:
                seal();
                break;
            default:
                change(instances_[chosen], number(data_.instances.size()));
                break;
        }
    }
    // Draws with another package from the next frame on, or with the first one again. In the other one the
    // cases are merged, and a material has a sheen and another colour, which the edits have not touched.
    void switchPackage() {
        if (packages_.size() == 1) {
            gltf::Scene scene = playingScene();
            materials::Material& square = scene.materials[1];
            square["baseColorFactor"] = {0.3F, 0.5F, 0.9F, 1.0F};
            giveSheen(square);
            compiler::CompileSettings settings = EditedSceneOptions().settings;
            settings.plan.merge = compiler::MergePolicy::All;
            packages_.push_back(packageOf(scene, settings));
        }
        current_ = 1 - current_;
        const Renderer::Replacement replaced = must(renderer_->replacePackage(packages_[current_]));
    }
    bool isSwitched() const {
        return current_ > 0;
    }
    // Records the pose and the edits, and a frame after them.
    void frame() {
        const VkCommandBuffer commands = frames_.begin();
        gpuScene_->complete(frames_.completed());
        finished_.completed(*renderer_, frames_.completed());
        const Status recorded = isPosed_ ? gpuScene_->update(commands, data_.motion(), frames_.frame())
                                         : editor().record(commands, frames_.frame());
        EXPECT_TRUE(recorded) << (recorded ? "" : toString(recorded.error()));
        isPosed_ = false;
        const Status drawn = renderer_->record(commands, frame_);
        EXPECT_TRUE(drawn) << (drawn ? "" : toString(drawn.error()));
        finished_.recorded(*renderer_, frames_.frame());
        frames_.submit();
    }
    void drain() {
        frames_.drain();
        gpuScene_->complete(frames_.completed());
        finished_.completed(*renderer_, frames_.completed());
    }
    void expectSameAsFresh(const std::string& what) {
        frame();
        drain();
        const LinearImage image = drawn(*renderer_, frame_);
        SceneView view = data_.view();
        std::vector<InstanceView> views;
        for (const Instance& instance : instances_) {
            views.push_back(instance.view);
        }
        view.instances = views;
        view.lights = lights_;
        view.moves = false;
        const auto fresh = uploadScene(package(), view);
        const auto renderer = makeRenderer(package(), *fresh, options());
        EXPECT_EQ(image.pixels, drawn(*renderer, frame_).pixels) << what;
    }
    // Removes what was added, and unseals the squares.
    void clear() {
        for (const std::size_t square : {std::size_t{3}, std::size_t{4}}) {
            const Instance& instance = instances_[square];
            EXPECT_TRUE(
                editor().setInstanceMesh(instance.handle, editor().mesh(data_.instances[square].mesh)));
        }
        for (std::size_t i = instances_.size(); i-- > 0;) {
            if (!instances_[i].uploaded) {
                remove(i);
            }
        }
    }
    std::optional<Renderer::SurfacePlace> placeAt(std::uint32_t x, std::uint32_t y) {
        return must(renderer_->readPlace(x, y));
    }
    InstanceHandle handleOf(std::size_t uploaded) const {
        return instances_[uploaded].handle;
    }

private:
    // The instances that a pose changes: the two strips and the first square.
    static constexpr std::array<bool, 5> kPlays{false, true, true, true, false};

    struct Instance {
        InstanceHandle handle;
        std::optional<std::size_t> uploaded{};  // its number
        InstanceView view{};
        std::vector<std::array<float, 12>> joints{};
        std::vector<float> weights{};

        void take(const InstanceView& other) {
            joints.assign(other.joints.begin(), other.joints.end());
            weights.assign(other.morphWeights.begin(), other.morphWeights.end());
            view = other;
            view.joints = joints;
            view.morphWeights = weights;
        }
    };

    static RendererOptions options() {
        RendererOptions options = EditedSceneOptions().renderer;
        options.width = kWidth;
        options.height = kHeight;
        return options;
    }
    static std::array<float, 12> rowsAt(float place) {
        const float x = 0.03F * place - 1.5F;
        return {0.5F, 0, 0, x, 0, 0.5F, 0, 0.2F * x, 0, 0, 0.5F, -2.2F - 0.1F * x};
    }

    // Adds an instance in the present pose of an uploaded one.
    void add(std::size_t like, float place) {
        Instance instance;
        instance.take(data_.instances[like]);
        instance.view.objectToWorld = rowsAt(place);
        SceneEditor::PlacedMesh placed;
        placed.mesh = editor().mesh(instance.view.mesh);
        placed.objectToWorld = instance.view.objectToWorld;
        placed.joints = instance.joints;
        placed.morphWeights = instance.weights;
        const SceneEditor::AddedInstance made = must(editor().addInstance(placed));
        instance.handle = made.instance;
        instance.view.visible = true;
        // Moving a vector keeps its elements in place.
        instances_.push_back(std::move(instance));
    }
    // Uploaded instances stay, since the others are counted after them.
    void remove(std::size_t index) {
        if (!instances_[index].uploaded) {
            EXPECT_TRUE(editor().removeInstance(instances_[index].handle));
            instances_.erase(instances_.begin() + static_cast<std::ptrdiff_t>(index));
        }
    }
    void show(Instance& instance, bool visible) {
        EXPECT_TRUE(editor().showInstance(instance.handle, visible));
        instance.view.visible = visible;
    }
    void move(Instance& instance, float place) {
        if (!instance.uploaded || !kPlays[*instance.uploaded]) {
            instance.view.objectToWorld = rowsAt(place);
            EXPECT_TRUE(editor().moveInstance(instance.handle, instance.view.objectToWorld));
        }
    }
    void seal() {
        std::vector<InstanceHandle> handles;
        for (const Instance& instance : instances_) {
            handles.push_back(instance.handle);
        }
        EXPECT_TRUE(editor().seal(handles));
    }
    // Gives an added instance another pose, or takes its pose away.
    void change(Instance& instance, std::size_t like) {
        if (instance.uploaded) {
            return;
        }
        const InstanceView& other = data_.instances[like];
        const bool isSame = other.mesh == instance.view.mesh;
        const std::array<float, 12> rows = instance.view.objectToWorld;
        const bool visible = instance.view.visible;
        InstanceView rest;
        rest.mesh = instance.view.mesh;
        instance.take(isSame ? other : rest);
        instance.view.objectToWorld = rows;
        instance.view.visible = visible;
        EXPECT_TRUE(editor().poseInstance(instance.handle, instance.joints, instance.weights));
    }

    gltf::Scene scene_;  // in its present pose
    std::vector<std::shared_ptr<const Package>> packages_;
    std::size_t current_ = 0;
    FrameOptions frame_;
    TwoFrames frames_;
    session::SceneViewData data_;
    std::unique_ptr<GpuScene> gpuScene_;
    std::unique_ptr<Renderer> renderer_;
    FinishedRecordings finished_;
    std::vector<Instance> instances_;  // the uploaded ones first
    std::vector<LightView> lights_;
    bool isPosed_ = false;
};

// Poses and edits at random, with this seed.
void play(unsigned seed, int count, int interval) {
    Playing playing;
    playing.expectSameAsFresh("as uploaded");
    const std::uint64_t allocated = playing.gpuScene().allocatedBytes();
    std::mt19937 random(seed);
    for (int i = 1; i <= count; ++i) {
        if (random() % 2 == 0) {
            playing.pose(random);
        }
        playing.edit(random);
        if (random() % 16 == 0) {
            playing.switchPackage();
        }
        if (i % interval == 0) {
            playing.expectSameAsFresh("after " + std::to_string(i) + " edits");
        } else {
            playing.frame();
        }
    }
    playing.clear();
    if (playing.isSwitched()) {
        playing.switchPackage();
    }
    playing.frame();
    playing.drain();
    playing.editor().trim();
    playing.frame();
    playing.drain();
    EXPECT_EQ(playing.gpuScene().allocatedBytes(), allocated);
}

TEST(LiveMotion, PosesAndEditsGiveThePictureOfAFreshUpload) {
    play(7, 160, 20);
    for (unsigned seed = 1; test::nightly() && seed <= 3; ++seed) {
        play(seed, 10000, 100);
    }
}

// What an edit has moved or hidden stays so, as long as the poses do not move or hide it themselves.
TEST(LiveMotion, EditsOutlastPosesThatLeaveThemAlone) {
    Playing playing;
    std::mt19937 random(3);
    const InstanceHandle square = playing.handleOf(4);
    playing.frame();
    playing.drain();
    std::optional<Renderer::SurfacePlace> seen;
    std::uint32_t x = 0;
    std::uint32_t y = 0;
    for (std::uint32_t i = 0; i < kWidth * kHeight; ++i) {
        const std::optional<Renderer::SurfacePlace> place = playing.placeAt(i % kWidth, i / kWidth);
        if (place && place->handle == square) {
            seen = place;
            x = i % kWidth;
            y = i / kWidth;
        }
    }
    ASSERT_TRUE(seen) << "pixels name the instances of a scene that is edited";
    EXPECT_EQ(seen->primitive, 0U);
    EXPECT_TRUE(playing.editor().showInstance(square, false));
    playing.pose(random);
    playing.frame();
    playing.pose(random);
    playing.frame();
    playing.drain();
    const std::optional<Renderer::SurfacePlace> after = playing.placeAt(x, y);
    EXPECT_TRUE(!after || after->handle != square) << "hidden";
}

}  // namespace
}  // namespace glint::testing
