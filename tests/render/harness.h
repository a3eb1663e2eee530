// Renders scenes in process, with the validation layers unless GLINT_TESTS_UNVALIDATED is in the environment.
#pragma once

#include "emit/compile.h"
#include "gltf/scene.h"

#include <glint/session/session.h>

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>

namespace glint::testing {

// Returns a device that the tests of a program share, with synchronisation validation. From then on each case
// fails for the messages of the validation layers.
Context& sharedContext();

// These make something of a scene. They throw as must() does.
std::unique_ptr<GpuScene> uploadScene(const Package& package, const SceneView& scene);
// `change`, if there is one, is called with what is uploaded.
std::unique_ptr<GpuScene> uploadScene(const Package& package, const gltf::Scene& scene,
                                      const std::function<void(SceneView&)>& change = {});
std::unique_ptr<Renderer> makeRenderer(const Package& package, GpuScene& scene,
                                       const RendererOptions& options);
LinearImage drawn(Renderer& renderer, const FrameOptions& frame, std::uint32_t samples = 1);

struct RenderSetup {
    std::uint32_t width = 64;
    std::uint32_t height = 36;
    std::uint32_t samples = 1;
    bool countsLight = false;  // as RendererOptions::countsLight
    FrameOptions frame;
};

// A scene that is compiled with one policy, loaded through a package on disk, and uploaded.
class LoadedScene {
public:
    // Throws as must() does.
    LoadedScene(const gltf::Scene& scene, const compiler::PlanOptions& plan);
    // `change`, if there is one, is called with the data before they are uploaded.
    LoadedScene(const gltf::Scene& scene, const compiler::CompileSettings& settings,
                const std::function<void(session::SceneViewData&)>& change = {});

    const compiler::CompiledPackage& compiled() const {
        return compiled_;
    }
    const Package& package() const {
        return *device_.package;
    }
    GpuScene& gpuScene() const {
        return *device_.gpu;
    }
    std::unique_ptr<Renderer> makeRenderer(const RendererOptions& options) const {
        return testing::makeRenderer(package(), gpuScene(), options);
    }
    // Renders an image. `counters` may be null. Keeps the renderer for further images with the same options,
    // because making one takes longer than most images.
    LinearImage render(package::Strategy strategy, const RenderSetup& setup,
                       Renderer::Counters* counters = nullptr) const;
    // The size is that of the setup.
    LinearImage render(RendererOptions options, const RenderSetup& setup,
                       Renderer::Counters* counters = nullptr) const;

private:
    compiler::CompiledPackage compiled_;
    session::DeviceScene device_;
    mutable std::unique_ptr<Renderer> renderer_;  // the last one of render()
    mutable RendererOptions options_;             // of renderer_
};

// A scene on the device that moves.
struct PosedScene {
    // Uploads it with the package of `loaded`. `change`, if there is one, is called with the data before
    // that.
    PosedScene(gltf::Scene posed, std::shared_ptr<const LoadedScene> loaded,
               const std::function<void(session::SceneViewData&)>& change = {});

    const Package& package() const {
        return compiled->package();
    }
    std::unique_ptr<Renderer> makeRenderer(const RendererOptions& options) const {
        return testing::makeRenderer(package(), *gpuScene, options);
    }
    // Moves the uploaded scene to the current pose of `scene`.
    GpuScene::MotionStatistics update(MotionView::Builds builds = MotionView::Builds::ByRule);

    gltf::Scene scene;
    std::shared_ptr<const LoadedScene> compiled;
    session::SceneViewData data;
    std::unique_ptr<GpuScene> gpuScene;
};

// Returns the scene's first camera or a framing one, and a sun if the scene has no light, as `glint render`
// does.
RenderSetup defaultSetup(const gltf::Scene& scene, std::uint32_t width, std::uint32_t height);

// Expects |a - b| <= 1e-4 max(1, |b|) for every channel of every pixel, and no NaN or infinity.
void expectSameImage(const LinearImage& image, const LinearImage& reference, const std::string& what);

}  // namespace glint::testing
