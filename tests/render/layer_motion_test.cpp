// The layers of motion: each kind of motion is checked by warping the frame before onto the next, and that of
// what mirrors and panes show against a scene whose points are known.
#include "render/layered_scene.h"
#include "render/moving_scenes.h"
#include "render/scene_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace glint::testing {
namespace {

constexpr std::uint32_t kWidth = 96;
constexpr std::uint32_t kHeight = 54;

using Point = std::array<double, 3>;

// Gives every material but the mirror, which is the first, colours that change slowly over the mesh.
gltf::Scene painted(gltf::Scene scene) {
    for (std::size_t i = 1; i < scene.materials.size(); ++i) {
        scene.materials[i] = unlitMaterial({1.0F, 1.0F, 1.0F});
    }
    for (gltf::Mesh& mesh : scene.meshes) {
        for (gltf::Primitive& primitive : mesh.primitives) {
            if (primitive.material == 0) {
                continue;
            }
            primitive.colorContent = materials::ColorContent::Varying;
            for (const gltf::Float3& at : primitive.positions) {
                primitive.colors.push_back(
                    {0.5F + 0.4F * at[0], 0.5F + 0.2F * at[1], 0.5F - 0.3F * at[0], 1.0F});
            }
        }
    }
    return scene;
}

compiler::CompileSettings withMotion() {
    compiler::CompileSettings settings;
    settings.layers = {"depth", "position", "material", "motion"};
    return settings;
}

// The frame before, as it is found by motion.
struct Warp {
    double worst = 0.0;    // of all channels and pixels that were seen before, too
    double unmoved = 0.0;  // the same without motion: the mean, which must be larger
    double mean = 0.0;
    std::size_t pixels = 0;
};

struct Frame {
    LinearImage image;
    LayerSet layers;
};

Frame draw(LayeredScene& scene) {
    LinearImage image = scene.render();
    return {std::move(image), LayerSet(scene.renderer())};
}

// Compares pixels that `counts` accepts. A point was seen before if all four pixels around its place had
// nearly its depth of that time.
template <typename Counts>
Warp warp(const Frame& before, const Frame& now, const Counts& counts) {
    Warp result;
    for (std::size_t i = 0; i < now.image.pixels.size(); ++i) {
        if (!counts(now, i)) {
            continue;
        }
        const auto row = i / kWidth;
        const double x = static_cast<double>(i % kWidth) + now.layers.at("motion", i, 0);
        const double y = static_cast<double>(row) + now.layers.at("motion", i, 1);
        const double depth = now.layers.at("depth", i, 0) + now.layers.at("motion", i, 2);
        const double left = std::floor(x);
        const double top = std::floor(y);
        bool seen = left >= 0.0 && top >= 0.0 && left + 1.0 < kWidth && top + 1.0 < kHeight;
        std::array<double, 3> found{};
        for (int corner = 0; seen && corner < 4; ++corner) {
            const double cx = left + corner % 2;
            const int down = corner / 2;
            const double cy = top + down;
            const auto place = static_cast<std::size_t>(cy * kWidth + cx);
            const double weight = (1.0 - std::abs(x - cx)) * (1.0 - std::abs(y - cy));
            seen =
                counts(before, place) && std::abs(before.layers.at("depth", place, 0) - depth) < 0.03 * depth;
            for (std::size_t c = 0; c < 3; ++c) {
                found[c] += weight * before.image.pixels[place][c];
            }
        }
        if (!seen) {
            continue;
        }
        ++result.pixels;
        for (std::size_t c = 0; c < 3; ++c) {
            const double value = now.image.pixels[i][c];
            result.worst = std::max(result.worst, std::abs(found[c] - value));
            result.mean += std::abs(found[c] - value);
            result.unmoved += std::abs(before.image.pixels[i][c] - value);
        }
    }
    return result;
}

bool isPainted(const Frame& frame, std::size_t pixel) {
    const std::uint32_t material = frame.layers.integer("material", pixel);
    return material != 0 && material != 0xFFFFFFFFU;
}

// Colours change by 1/100 over a pixel at most, and interpolation in the frame before adds less than a tenth
// of that.
void expectFollows(const Warp& warped, const std::string& what) {
    EXPECT_LT(warped.worst, 2e-3) << what;
    EXPECT_GT(warped.pixels, 100U) << what;
    EXPECT_GT(warped.unmoved, 10.0 * warped.mean) << what << ": without motion the frames must differ";
}

// Draws two frames, between which `move` changes the scene, and a third without a change.
template <typename Move>
void checkMotion(gltf::Scene posed, const std::string& what, const Move& move) {
    LayeredScene scene(painted(std::move(posed)), withMotion(), kWidth, kHeight);
    const Frame first = draw(scene);
    for (std::size_t i = 0; i < first.image.pixels.size(); ++i) {
        EXPECT_EQ(first.layers.at("motion", i, 0), 0.0F) << "the first frame has none before it";
    }
    move(scene.scene);
    const Frame second = draw(scene);
    expectFollows(warp(first, second, isPainted), what);
    const Frame third = draw(scene);
    double rest = 0.0;
    for (std::size_t i = 0; i < third.image.pixels.size(); ++i) {
        rest = std::max<double>(rest, std::abs(third.layers.at("motion", i, 0)));
    }
    EXPECT_LT(rest, 1e-3) << what << ": what stands still has no motion";
}

TEST(LayerMotion, FollowsTheCamera) {
    checkMotion(rigidScene(), "camera", [](gltf::Scene& scene) {
        const double angle = 0.04;
        scene.cameras[0].world = {std::cos(angle), 0, -std::sin(angle), 0, 0,   1,    0,    0,
                                  std::sin(angle), 0, std::cos(angle),  0, 0.1, 0.05, 0.15, 1};
    });
}

TEST(LayerMotion, FollowsInstances) {
    checkMotion(rigidScene(), "instances", [](gltf::Scene& scene) {
        scene.nodes[1].world = placed(-0.8, 0.1, -2.8, 0.2);
        scene.nodes[2].world = placed(0.9, -0.1, -3.2, -0.1);
    });
}

TEST(LayerMotion, FollowsSkins) {
    checkMotion(skinnedScene(0.1), "skin",
                [](gltf::Scene& scene) { scene.nodes[3].world = placed(0.1, 0.25, -2.4, 0.35); });
}

// A scene and its camera jump a thousand kilometres together. They have another origin there, and skins other
// joints, but nothing moves in the picture. The host reads places in the world.
TEST(LayerMotion, DoesNotContainThatOfTheOrigin) {
    LayeredScene scene(painted(skinnedScene(0.1)), withMotion(), kWidth, kHeight);
    const Frame near = draw(scene);
    for (gltf::Node& node : scene.scene.nodes) {
        node.world[12] += 1e6;
    }
    scene.scene.cameras[0].world[12] += 1e6;
    const Frame far = draw(scene);
    expectSameImage(far.image, near.image, "far away");
    std::size_t surfaces = 0;
    for (std::size_t i = 0; i < far.image.pixels.size(); ++i) {
        EXPECT_NEAR(far.layers.at("motion", i, 0), 0.0F, 1e-3F);
        EXPECT_NEAR(far.layers.at("motion", i, 1), 0.0F, 1e-3F);
        if (far.layers.at("depth", i, 0) > 0.0F) {
            ++surfaces;
            // Floats near a million have steps of 1/16.
            EXPECT_NEAR(far.layers.at("position", i, 0) - 1e6, near.layers.at("position", i, 0), 0.04);
            EXPECT_NEAR(far.layers.at("position", i, 1), near.layers.at("position", i, 1), 1e-4);
        }
    }
    EXPECT_GT(surfaces, 100U);
}

TEST(LayerMotion, FollowsMorphTargets) {
    checkMotion(morphedScene({0.1, 0.2}), "morph targets", [](gltf::Scene& scene) {
        scene.nodes[1].weights = {0.5, 0.6};
    });
}

// Where a camera at `eye` that looks along -Z sees a point, in pixels. Its vertical field of view is 90
// degrees.
std::array<double, 2> pixelOf(const Point& point, const Point& eye) {
    const double w = eye[2] - point[2];
    const double aspect = static_cast<double>(kWidth) / kHeight;
    return {((point[0] - eye[0]) / (w * aspect) * 0.5 + 0.5) * kWidth,
            (0.5 - (point[1] - eye[1]) / w * 0.5) * kHeight};
}

// The largest distance of a layer's motion to that of the points that a mirror or a pane shows, over pixels
// of `material` whose rays hit. `imageNow` and `imageBefore` return where the image of the pixel's hit is.
struct Truth {
    double worst = 0.0;
    double surface = 0.0;  // the largest difference of the surface's own motion to the truth
    std::size_t pixels = 0;
};
template <typename ImageBefore>
Truth compareWithTruth(const Frame& now, const std::string& effect, std::uint32_t material,
                       const Point& eyeBefore, const ImageBefore& imageBefore) {
    Truth truth;
    for (std::size_t i = 0; i < now.image.pixels.size(); ++i) {
        const double distance = now.layers.at(effect + ".distance", i, 0);
        if (now.layers.integer("material", i) != material || distance <= 0.0 || distance >= 65504.0) {
            continue;
        }
        const Point surface{now.layers.at("position", i, 0), now.layers.at("position", i, 1),
                            now.layers.at("position", i, 2)};
        const std::array<double, 2> last = pixelOf(imageBefore(surface, distance), eyeBefore);
        const double x = last[0] - (static_cast<double>(i % kWidth) + 0.5);
        const auto row = i / kWidth;
        const double y = last[1] - (static_cast<double>(row) + 0.5);
        const auto differs = [&](const std::string& layer) {
            return std::hypot(now.layers.at(layer, i, 0) - x, now.layers.at(layer, i, 1) - y);
        };
        truth.worst = std::max(truth.worst, differs(effect + ".virtual-motion"));
        truth.surface = std::max(truth.surface, differs("motion"));
        ++truth.pixels;
    }
    return truth;
}

// 16-bit floats store a motion of up to 16 pixels in steps of 1/128.
constexpr double kMotionError = 0.02;

gltf::Matrix4 eyeAt(const Point& eye) {
    return placed(eye[0], eye[1], eye[2]);
}

Point directionTo(const Point& point, const Point& eye) {
    const Point d{point[0] - eye[0], point[1] - eye[1], point[2] - eye[2]};
    const double length = std::hypot(d[0], d[1], d[2]);
    return {d[0] / length, d[1] / length, d[2] / length};
}

TEST(LayerMotion, OfAMirrorIsThatOfWhatItShows) {
    compiler::CompileSettings settings = withMotion();
    settings.layers.insert(settings.layers.end(),
                           {"reflection.virtual-motion", "reflection.distance", "reflection.radiance"});
    // The mirror is the plane y = -1 of its mesh. First the camera, the quads and the mirror stand still.
    LayeredScene scene(painted(rigidScene()), settings, kWidth, kHeight);
    Point eye{0, 0, 0};
    double mirror = -1.0;
    Point quads{0, 0, 0};
    draw(scene);
    struct Step {
        const char* what;
        Point eye;
        double mirror;
        Point quads;
    };
    for (const Step& step : {Step{"the camera moves", {0.1, 0.05, 0.2}, -1.0, {0, 0, 0}},
                             Step{"the quads move", {0.1, 0.05, 0.2}, -1.0, {0.2, 0.1, -0.3}},
                             Step{"the mirror moves", {0.1, 0.05, 0.2}, -1.1, {0.2, 0.1, -0.3}},
                             Step{"all move", {0, 0, 0.1}, -1.0, {0, 0, 0}}}) {
        scene.scene.cameras[0].world = eyeAt(step.eye);
        scene.scene.nodes[0].world = placed(0, step.mirror + 1.0, 0);
        scene.scene.nodes[1].world = placed(-1 + step.quads[0], step.quads[1], -3 + step.quads[2]);
        scene.scene.nodes[2].world = placed(1 + step.quads[0], step.quads[1], -3 + step.quads[2]);
        const Frame now = draw(scene);
        const Truth truth =
            compareWithTruth(now, "reflection", 0, eye, [&](const Point& surface, double distance) {
                const Point d = directionTo(surface, step.eye);
                const Point hit{surface[0] + distance * d[0], surface[1] - distance * d[1],
                                surface[2] + distance * d[2]};
                const Point before{hit[0] - step.quads[0] + quads[0], hit[1] - step.quads[1] + quads[1],
                                   hit[2] - step.quads[2] + quads[2]};
                return Point{before[0], 2.0 * mirror - before[1], before[2]};
            });
        EXPECT_LT(truth.worst, kMotionError) << step.what;
        EXPECT_GT(truth.pixels, 50U) << step.what;
        EXPECT_GT(truth.surface, 0.3) << step.what << ": the mirror's own motion is another one";
        eye = step.eye;
        mirror = step.mirror;
        quads = step.quads;
    }
}

TEST(LayerMotion, OfAPaneIsThatOfWhatIsBehind) {
    gltf::Scene posed = painted(rigidScene());
    materials::Material glass;
    glass.give("KHR_materials_transmission");
    glass["transmissionFactor"] = 1.0F;
    glass["metallicFactor"] = 0.0F;
    glass["roughnessFactor"] = 0.0F;
    const int pane = addMaterial(posed, glass);
    addQuad(posed, pane, {-1.4F, -0.6F, -1.5F}, {2.8F, 0, 0}, {0, 1.2F, 0});
    compiler::CompileSettings settings = withMotion();
    settings.effects = {false, compiler::builtinEffects({"refraction"})};
    settings.layers.insert(settings.layers.end(), {"refraction.virtual-motion", "refraction.distance"});
    LayeredScene scene(posed, settings, kWidth, kHeight);
    draw(scene);
    const Point step{0.15, -0.1, 0.2};
    const Point eye{0.05, 0.0, 0.1};
    scene.scene.cameras[0].world = eyeAt(eye);
    scene.scene.nodes[1].world = placed(-1 + step[0], step[1], -3 + step[2]);
    scene.scene.nodes[2].world = placed(1 + step[0], step[1], -3 + step[2]);
    scene.scene.nodes[3].world = placed(0.1, 0.05, 0.1);
    const Frame now = draw(scene);
    const Truth truth = compareWithTruth(now, "refraction", static_cast<std::uint32_t>(pane), {0, 0, 0},
                                         [&](const Point& surface, double distance) {
                                             const Point d = directionTo(surface, eye);
                                             Point hit{};
                                             for (std::size_t i = 0; i < 3; ++i) {
                                                 hit[i] = surface[i] + distance * d[i];
                                             }
                                             // What is not a quad is the mirror below, which stands still.
                                             const bool isQuad = hit[1] > -0.95;
                                             for (std::size_t i = 0; i < 3 && isQuad; ++i) {
                                                 hit[i] -= step[i];
                                             }
                                             return hit;
                                         });
    EXPECT_LT(truth.worst, kMotionError);
    EXPECT_GT(truth.pixels, 100U);
    EXPECT_GT(truth.surface, 0.3);
}

}  // namespace
}  // namespace glint::testing
