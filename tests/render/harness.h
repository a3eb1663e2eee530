// Renders scenes in process, with the validation layers always on.
#pragma once

#include "cli/scene_view.h"
#include "emit/compile.h"
#include "gltf/scene.h"

#include <glint/context.h>
#include <glint/renderer.h>

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>

namespace glint::testing {

// A device shared by the tests of a program, with synchronisation validation. Fails the test where there is
// none.
Context& sharedContext();

// Fails the test for each message of the validation layers so far that an earlier call has not reported.
void expectNoValidationMessages();

struct RenderSetup {
    std::uint32_t width = 64;
    std::uint32_t height = 36;
    std::uint32_t samples = 1;
    FrameOptions frame;
};

// A scene compiled under one policy, loaded through the package on disk and uploaded.
class LoadedScene {
public:
    // Compiles into a temporary folder of its own. On failure ok() is false and the test has failed.
    LoadedScene(const Scene& scene, const PlanOptions& plan);
    // `change`, if there is one, is called on what is uploaded.
    LoadedScene(const Scene& scene, const CompileSettings& settings,
                const std::function<void(SceneViewData&)>& change = {});
    ~LoadedScene();

    bool ok() const {
        return gpuScene_ != nullptr;
    }
    const CompiledPackage& compiled() const {
        return compiled_;
    }
    // Only if ok().
    const Package& package() const {
        return *package_;
    }
    GpuScene& gpuScene() const {
        return *gpuScene_;
    }
    // An image of no size where rendering failed; the test has failed then. `counters` may be null.
    LinearImage render(package::Strategy strategy, const RenderSetup& setup,
                       FrameCounters* counters = nullptr) const;
    // The size is that of the setup.
    LinearImage render(RendererOptions options, const RenderSetup& setup,
                       FrameCounters* counters = nullptr) const;

private:
    Status load(const Scene& scene, const CompileSettings& settings,
                const std::function<void(SceneViewData&)>& change);

    CompiledPackage compiled_;
    std::unique_ptr<Package> package_;
    std::unique_ptr<GpuScene> gpuScene_;
};

// The scene's first camera or a framing one, and a sun where the scene has no light, as `glint render` does.
RenderSetup defaultSetup(const Scene& scene, std::uint32_t width, std::uint32_t height);

// Expects |a - b| <= 1e-4 max(1, |b|) on every channel of every pixel, and no NaN or infinity.
void expectSameImage(const LinearImage& image, const LinearImage& reference, const std::string& what);

}  // namespace glint::testing
