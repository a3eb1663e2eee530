// glint_edit_times: measures how long the host takes to record edits of a scene, and how many bytes they
// bring to the device.
#include "base/clock.h"
#include "context/commands.h"
#include "gltf/scene.h"
#include "program.h"

#include <glint/scene.h>
#include <glint/session/session.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace glint {

namespace {

struct Arguments {
    std::uint32_t lamps = 100;
    std::uint32_t triangles = 100;
    std::uint32_t objects = 100;  // that are no lamps
    bool moves = false;
    bool sorted = false;
    int rounds = 20;
};

// A strip of triangles around a cylinder.
gltf::Primitive cylinder(std::uint32_t triangles) {
    gltf::Primitive primitive;
    const std::uint32_t steps = std::max(triangles / 2, 1U);
    for (std::uint32_t i = 0; i <= steps; ++i) {
        const float angle = 6.2831853F * static_cast<float>(i) / static_cast<float>(steps);
        const float c = std::cos(angle);
        const float s = std::sin(angle);
        primitive.positions.push_back({0.1F * c, 0.0F, 0.1F * s});
        primitive.positions.push_back({0.1F * c, 0.5F, 0.1F * s});
        primitive.normals.insert(primitive.normals.end(), 2, {c, 0.0F, s});
    }
    for (std::uint32_t i = 0; i < 2 * steps; ++i) {
        const std::uint32_t turn = i % 2;
        primitive.indices.insert(primitive.indices.end(), {i, i + 1 + turn, i + 2 - turn});
    }
    return primitive;
}

// Meshes 0 and 1 are a lamp and an object; the instances of the lamp come first.
gltf::Scene makeScene(const Arguments& arguments) {
    gltf::Scene scene;
    scene.path = "edit_times.gltf";
    scene.materials.resize(2);
    scene.materials[0]["emissiveFactor"] = {3.0F, 2.0F, 1.0F};
    for (int i = 0; i < 2; ++i) {
        gltf::Mesh mesh;
        mesh.primitives.push_back(cylinder(arguments.triangles));
        mesh.primitives.back().material = i;
        scene.meshes.push_back(std::move(mesh));
    }
    for (std::size_t i = 0; i < arguments.lamps + arguments.objects; ++i) {
        gltf::Node node;
        node.mesh = i < arguments.lamps ? 0 : 1;
        for (const std::size_t one : {0, 5, 10, 15}) {
            node.world[one] = 1.0;
        }
        node.world[12] = static_cast<double>(i % 16);
        node.world[14] = static_cast<double>(i / 16);
        scene.nodes.push_back(std::move(node));
    }
    gltf::Light light;
    light.type = gltf::LightType::Point;
    scene.lights.push_back(light);
    return scene;
}

std::array<float, 12> placeOf(int round) {
    const float x = static_cast<float>(std::fmod(0.37 * round, 9.0));
    return {1, 0, 0, x, 0, 1, 0, 2.0F, 0, 0, 1, 0.5F * x};
}

// Prints the milliseconds of an edit and of SceneEditor::record() after it, and the bytes of its staging
// memory and of everything else that it replaces: the medians, and the least and the most time.
Status measureEdit(Context& context, SceneEditor& editor, const std::string& name, int rounds,
                   std::uint64_t& frame, const std::function<Status(int)>& edit) {
    GLINT_TRY(auto runner, CommandRunner::create(context.state()));
    std::vector<double> times;
    std::vector<std::uint64_t> bytes;
    for (int round = -1; round < rounds; ++round) {
        GLINT_TRY(const auto commands, runner.begin());
        const auto begin = base::Clock::now();
        GLINT_TRY_DO(edit(round));
        GLINT_TRY_DO(editor.record(commands, ++frame));
        const double ms = base::millisecondsSince(begin);
        if (round >= 0) {
            times.push_back(ms);
            bytes.push_back(editor.retiredBytes());
        }
        GLINT_TRY_DO(runner.submitAndWait());
        editor.complete(frame);
    }
    const auto part = [&](double share) { return benchmarks::quantile(times, share); };
    fmt::print("| {} | {:.3f} | {:.3f} to {:.3f} | {} |\n", name, part(0.5), part(0.0), part(1.0),
               benchmarks::quantile(bytes, 0.5));
    return okStatus();
}

Status measureEdits(const Arguments& arguments) {
    GLINT_TRY(const auto context, Context::createHeadless({}));
    const gltf::Scene scene = makeScene(arguments);
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyUber;
    settings.tracers = context->handles().tracers;
    if (arguments.lamps > 0) {
        settings.emissiveLights = compiler::EmissiveLights::On;
        settings.lightSamples = 4;
    }
    GLINT_TRY(const auto build, compiler::resolve(std::span(&scene, 1), settings));
    GLINT_TRY(const auto package, session::compileAndLoad(build));
    const session::SceneViewData data = session::makeSceneView(scene);
    SceneView view = data.view();
    view.editable = true;
    view.moves = arguments.moves;
    view.traversalOrder =
        arguments.sorted ? SceneView::TraversalOrder::Halving : SceneView::TraversalOrder::Input;
    GLINT_TRY(const auto uploaded, GpuScene::upload(*context, *package, view));
    SceneEditor& editor = *uploaded->editor();
    fmt::print("{}: {} lamps of {} triangles, {} other objects{}\n\n", context->deviceName(), arguments.lamps,
               arguments.triangles, arguments.objects, arguments.moves ? ", in a scene that moves" : "");
    fmt::print("| edit | ms of the host | least to most | bytes |\n|---|--:|--:|--:|\n");
    std::uint64_t frame = 0;
    const auto measured = [&](const std::string& name, const std::function<Status(int)>& edit) {
        return measureEdit(*context, editor, name, arguments.rounds, frame, edit);
    };
    const std::uint32_t other = arguments.lamps;
    const auto move = [&](std::uint32_t instance) {
        return [&editor, instance](int round) {
            return editor.moveInstance(editor.instance(instance), placeOf(round));
        };
    };
    const auto paint = [&](int round) {
        std::vector<std::uint8_t> record(package->scene(0).materials.bytes.begin(),
                                         package->scene(0).materials.bytes.end());
        const std::size_t bytes = package->scene(0).materials.recordBytes;
        const float color = 0.01F * static_cast<float>(round + 1);
        std::memcpy(&record[bytes], &color, sizeof color);
        return editor.setMaterialValues(editor.material(1), std::span(record).subspan(bytes, bytes));
    };
    const auto light = [&](int round) {
        LightView changed = data.lights.front();
        changed.position[0] = 0.1F * static_cast<float>(round);
        return editor.setLight(editor.light(0), changed);
    };
    TextureHandle texture;
    const auto addTexture = [&](int /*round*/) -> Status {
        if (texture.generation != 0) {
            GLINT_TRY_DO(editor.removeTexture(texture));
        }
        constexpr std::array<std::uint8_t, 64> kTexels{};
        GLINT_TRY(texture, editor.addTexture({4, 4, kTexels}, true));
        return okStatus();
    };
    InstanceHandle added;
    const auto addInstance = [&](int /*round*/) -> Status {
        if (added.generation != 0) {
            GLINT_TRY_DO(editor.removeInstance(added));
        }
        GLINT_TRY(const auto made, editor.addInstance({editor.mesh(1), placeOf(3)}));
        added = made.instance;
        return okStatus();
    };
    GLINT_TRY_DO(measured("none", [](int) { return okStatus(); }));
    GLINT_TRY_DO(measured("an object moved", move(other)));
    GLINT_TRY_DO(measured("values of a material", paint));
    GLINT_TRY_DO(measured("a light changed", light));
    GLINT_TRY_DO(measured("a texture added, another removed", addTexture));
    GLINT_TRY_DO(measured("an object added, another removed", addInstance));
    if (arguments.lamps > 0) {
        GLINT_TRY_DO(measured("a lamp moved", move(0)));
        GLINT_TRY_DO(measured("a lamp shown or hidden", [&](int round) {
            return editor.showInstance(editor.instance(0), round % 2 == 0);
        }));
    }
    return okStatus();
}

}  // namespace

}  // namespace glint

int main(int count, char** words) {
    glint::Arguments arguments;
    return glint::benchmarks::runProgram(
        "Measures how long the host takes to record edits of a scene.",
        {{"--lamps", &arguments.lamps, "instances that shine", {false, 0, 1'000'000}},
         {"--objects", &arguments.objects, "other instances", {false, 1, 10'000'000}},
         {"--moves", &arguments.moves, "the scene moves, so its TLAS is updated"},
         {"--sorted", &arguments.sorted, "the TLAS is sorted, as for CPU drivers"},
         {"--triangles", &arguments.triangles, "triangles of each", {false, 2, 1'000'000}},
         glint::benchmarks::roundsOption(arguments.rounds, "edits of each kind")},
        count, words, [&] { return glint::measureEdits(arguments); });
}
