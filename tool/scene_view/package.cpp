#include "emit/compile.h"
#include "resolve/resolve.h"
#include "scene/deformed.h"

#include <glint/embedded_file.h>
#include <glint/scene_view/package.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string_view>
#include <vector>

namespace glint::scene_view {

namespace {

Diagnostic mismatch(const std::filesystem::path& folder, const std::string& message) {
    return makeError(
        "package-mismatch", folder.string(), message,
        "compile the package again, use the --variant that it was compiled with, or leave out --package");
}

Status checkStrategy(const Package& package, const compiler::Settings& settings) {
    if (package.supports(*settings.strategy)) {
        return okStatus();
    }
    const std::vector<std::string> has = compiler::strategyNames(package.shape().strategies);
    const std::string_view wanted = package::nameOf(*settings.strategy);
    return makeError(
        "package-mismatch", settings.package, fmt::format("has {}, not {}", fmt::join(has, ", "), wanted),
        fmt::format("render with --strategy {}, or compile with --strategy {}", has.front(), wanted));
}

Status checkTracer(const Package& package, const compiler::Settings& settings) {
    const std::uint32_t compiled = package::tracersOf(*settings.strategy, package.shape().tracers);
    const std::optional<package::Tracer> tracer = settings.renderer.tracer;
    if (!tracer || (compiled & *tracer) != 0) {
        return okStatus();
    }
    const std::vector<std::string> has = compiler::tracerNames(compiled);
    const std::string_view wanted = package::nameOf(*tracer);
    return makeError(
        "package-tracer", settings.package,
        fmt::format("has {} for {}, not {}", fmt::join(has, ", "), package::nameOf(*settings.strategy),
                    wanted),
        fmt::format("render with --tracer {}, or compile with --tracer {}", has.front(), wanted));
}

Status checkSky(const Package& package, const compiler::Settings& settings) {
    const bool map = !settings.environment.empty();
    if (package.environmentMap() == map) {
        return okStatus();
    }
    return makeError("package-mismatch", settings.package,
                     map ? "was compiled for a gradient sky, not for an environment map"
                         : "was compiled for an environment map, and there is none",
                     map ? "compile it with --environment-map, or leave out --environment"
                         : "give one by --environment, or compile without --environment-map");
}

materials::FeatureMask maskOf(const package::PrimitiveEntry& entry) {
    return materials::FeatureMask{entry.featureLobes} | materials::FeatureMask{entry.featureInputs} << 32U;
}

}  // namespace

std::optional<std::uint32_t> sceneIn(const Package& package, const gltf::Scene& scene) {
    if (package.sceneCount() == 1) {
        return 0;
    }
    return package.findScene(std::filesystem::path(scene.path).stem().string());
}

Status checkPackage(const Package& package, const compiler::Build& build) {
    const compiler::Settings& settings = build.settings;
    const gltf::Scene& scene = build.scenes->scenes().front();
    GLINT_TRY_DO(checkStrategy(package, settings));
    GLINT_TRY_DO(checkTracer(package, settings));
    GLINT_TRY_DO(checkSky(package, settings));
    const std::optional<std::uint32_t> index = sceneIn(package, scene);
    if (!index) {
        return mismatch(settings.package,
                        fmt::format("has {} scenes, none of them named {}", package.sceneCount(),
                                    std::filesystem::path(scene.path).stem().string()));
    }
    const PackageScene known = package.scene(*index);
    if (known.materials.size() != scene.materials.size()) {
        return mismatch(settings.package, fmt::format("has {} materials, but the scene has {}",
                                                      known.materials.size(), scene.materials.size()));
    }
    if (compiler::hasDeformedMesh(scene) && !package.shape().deforms) {
        return mismatch(settings.package,
                        "has no pass for meshes that follow joints or morph targets, as the scene has");
    }
    for (std::size_t i = 0; i < build.scenes->primitives().size(); ++i) {
        const materials::PrimitiveInputs& inputs = build.scenes->primitives()[i];
        const package::PrimitiveEntry* entry = known.findPrimitive(
            static_cast<std::uint32_t>(inputs.mesh), static_cast<std::uint32_t>(inputs.primitive));
        const std::string pointer = fmt::format("/meshes/{}/primitives/{}", inputs.mesh, inputs.primitive);
        if (entry == nullptr) {
            return mismatch(settings.package, "does not know the scene's " + pointer);
        }
        if (entry->materialIndex != static_cast<std::uint32_t>(inputs.material) ||
            maskOf(*entry) != build.plan.primaryMaskOfPrimitive[i]) {
            return mismatch(settings.package,
                            "has another material or other features for the scene's " + pointer);
        }
    }
    for (const package::TextureEntry& texture : known.textures) {
        if (texture.image >= scene.images.size()) {
            return mismatch(settings.package, fmt::format("uses image {}, but the scene has {} images",
                                                          texture.image, scene.images.size()));
        }
    }
    return okStatus();
}

Result<Package> loadPackage(const compiler::CompiledPackage& compiled) {
    std::vector<package::EmbeddedFile> files;
    files.reserve(compiled.files.size());
    for (const compiler::PackageFile& file : compiled.files) {
        files.push_back({file.name, file.bytes});
    }
    return Package::load(files);
}

Result<Package> compileAndLoad(const compiler::Build& build, compiler::ModuleCache* cache) {
    GLINT_TRY(const auto compiled, compilePackage(build, cache));
    return loadPackage(compiled);
}

}  // namespace glint::scene_view
