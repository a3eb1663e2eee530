#include "render/hit_kernel.h"

#include "base/files.h"
#include "emit/context.h"
#include "emit/glsl/passes.h"
#include "support/shared_modules.h"

#include <utility>

namespace glint::testing {

namespace {

Result<std::vector<std::uint32_t>> compileKernel(const gltf::Scene& scene, const LoadedScene& loaded,
                                                 const std::string& shader,
                                                 const compiler::CompileSettings& settings) {
    GLINT_TRY(const auto text, base::readFile(std::filesystem::path(GLINT_SOURCE_DIR) / "tests" / "render" /
                                              "shaders" / shader));
    GLINT_TRY(const auto sources,
              makeSourceSet(gltf::SceneList({&scene, 1}), loaded.compiled().plan, settings));
    GLINT_TRY(const auto glsl, flatten(shader, std::string(text.begin(), text.end()), sources.lookup(),
                                       compiler::FlattenSide::Glsl));
    return compileComputeOnce(shader, glsl.withPlaces());
}

}  // namespace

HitKernel::HitKernel(std::unique_ptr<SceneKernel> kernel) : kernel_(std::move(kernel)) {}

Result<std::unique_ptr<HitKernel>> HitKernel::create(const gltf::Scene& scene, const LoadedScene& loaded,
                                                     const std::string& shader,
                                                     const compiler::CompileSettings& settings) {
    const Result<std::vector<std::uint32_t>> words = compileKernel(scene, loaded, shader, settings);
    return words ? create(loaded, *words) : words.error();
}

Result<std::unique_ptr<HitKernel>> HitKernel::create(const LoadedScene& loaded,
                                                     const std::vector<std::uint32_t>& words) {
    GLINT_TRY(auto kernel, SceneKernel::create(loaded.gpuScene(), words));
    return std::unique_ptr<HitKernel>(new HitKernel(std::move(kernel)));
}

Result<std::vector<std::uint32_t>> HitKernel::run(const gpu::FrameConstants& constants,
                                                  std::span<const gpu::RayRecord> rays,
                                                  std::uint32_t invocations, std::size_t outputs) {
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(rays.data());
    return runSceneKernel(kernel_->state(), constants, {bytes, rays.size_bytes()}, invocations, outputs);
}

}  // namespace glint::testing
