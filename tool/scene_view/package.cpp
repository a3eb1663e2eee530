#include "gltf/import.h"
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

Status checkStrategy(const Package& package, const std::filesystem::path& folder,
                     const PackageDemand& demand) {
    if (package.supports(demand.strategy)) {
        return okStatus();
    }
    const std::vector<std::string> has = compiler::strategyNames(package.shape().strategies);
    const std::string_view wanted = package::nameOf(demand.strategy);
    return makeError(
        "package-mismatch", folder.string(), fmt::format("has {}, not {}", fmt::join(has, ", "), wanted),
        fmt::format("render with --strategy {}, or compile with --strategy {}", has.front(), wanted));
}

Status checkTracer(const Package& package, const std::filesystem::path& folder, const PackageDemand& demand) {
    const std::uint32_t compiled = package::tracersOf(demand.strategy, package.shape().tracers);
    if (!demand.tracer || (compiled & *demand.tracer) != 0) {
        return okStatus();
    }
    const std::vector<std::string> has = compiler::tracerNames(compiled);
    const std::string_view wanted = package::nameOf(*demand.tracer);
    return makeError(
        "package-tracer", folder.string(),
        fmt::format("has {} for {}, not {}", fmt::join(has, ", "), package::nameOf(demand.strategy), wanted),
        fmt::format("render with --tracer {}, or compile with --tracer {}", has.front(), wanted));
}

Status checkSky(const Package& package, const std::filesystem::path& folder, const PackageDemand& demand) {
    const bool map = demand.environmentMap;
    if (package.environmentMap() == map) {
        return okStatus();
    }
    return makeError("package-mismatch", folder.string(),
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

Status checkPackage(const Package& package, const std::filesystem::path& folder, const PackageDemand& demand,
                    const gltf::Scene& scene) {
    for (const Status& status : {checkStrategy(package, folder, demand), checkTracer(package, folder, demand),
                                 checkSky(package, folder, demand)}) {
        if (!status) {
            return status;
        }
    }
    const std::optional<std::uint32_t> index = sceneIn(package, scene);
    if (!index) {
        return mismatch(folder, fmt::format("has {} scenes, none of them named {}", package.sceneCount(),
                                            std::filesystem::path(scene.path).stem().string()));
    }
    const PackageScene known = package.scene(*index);
    if (known.materials.size() != scene.materials.size()) {
        return mismatch(folder, fmt::format("has {} materials, but the scene has {}", known.materials.size(),
                                            scene.materials.size()));
    }
    if (compiler::hasDeformedMesh(scene) && !package.shape().deforms) {
        return mismatch(folder,
                        "has no pass for meshes that follow joints or morph targets, as the scene has");
    }
    const materials::KeyOptions keys{package.alpha()};
    for (const materials::PrimitiveInputs& inputs : planningInputs(scene)) {
        const package::PrimitiveEntry* entry = known.findPrimitive(
            static_cast<std::uint32_t>(inputs.mesh), static_cast<std::uint32_t>(inputs.primitive));
        const std::string pointer = fmt::format("/meshes/{}/primitives/{}", inputs.mesh, inputs.primitive);
        if (entry == nullptr) {
            return mismatch(folder, "does not know the scene's " + pointer);
        }
        const materials::Material& material = scene.materials[static_cast<std::size_t>(inputs.material)];
        if (entry->materialIndex != static_cast<std::uint32_t>(inputs.material) ||
            maskOf(*entry) != compiler::makeKey(material, inputs, keys)) {
            return mismatch(folder, "has another material or other features for the scene's " + pointer);
        }
    }
    for (const package::TextureEntry& texture : known.textures) {
        if (texture.image >= scene.images.size()) {
            return mismatch(folder, fmt::format("uses image {}, but the scene has {} images", texture.image,
                                                scene.images.size()));
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

Result<Package> compileAndLoad(const gltf::Scene& scene, compiler::CompileSettings settings,
                               compiler::ModuleCache* cache) {
    settings.emitHeader = false;
    GLINT_TRY(const auto compiled, compilePackage(scene, settings, cache));
    return loadPackage(compiled);
}

}  // namespace glint::scene_view
