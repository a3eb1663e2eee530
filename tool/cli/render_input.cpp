#include "cli/render_input.h"

#include "cli/held_signals.h"
#include "cli/temporary_folder.h"
#include "gltf/import.h"

#include <fmt/format.h>

namespace glint {

namespace {

Diagnostic mismatch(const std::filesystem::path& folder, const std::string& message) {
    return makeError(
        "package-mismatch", folder.string(), message,
        "compile the package again, use the --variant that it was compiled with, or leave out --package");
}

FeatureMask maskOf(const package::PrimitiveEntry& entry) {
    return FeatureMask{entry.featureLobes} | FeatureMask{entry.featureInputs} << 32U;
}

}  // namespace

std::optional<std::uint32_t> sceneIn(const Package& package, const Scene& scene) {
    if (package.sceneCount() == 1) {
        return 0;
    }
    return package.findScene(std::filesystem::path(scene.path).stem().string());
}

Status checkPackage(const Package& package, const std::filesystem::path& folder, package::Strategy strategy,
                    bool environmentMap, const Scene& scene) {
    if (!package.supports(strategy)) {
        return mismatch(folder, "was compiled without the strategy that is asked for");
    }
    if (package.environmentMap() != environmentMap) {
        return makeError("package-mismatch", folder.string(),
                         environmentMap ? "was compiled for a gradient sky, not for an environment map"
                                        : "was compiled for an environment map, and there is none",
                         environmentMap ? "compile it with --environment-map, or leave out --environment"
                                        : "give one by --environment, or compile without --environment-map");
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
    const KeyOptions keys{package.alphaTested() ? AlphaPolicy::Tested : AlphaPolicy::Opaque};
    for (const PrimitiveInputs& inputs : planningInputs(scene)) {
        const package::PrimitiveEntry* entry = known.findPrimitive(
            static_cast<std::uint32_t>(inputs.mesh), static_cast<std::uint32_t>(inputs.primitive));
        const std::string pointer = fmt::format("/meshes/{}/primitives/{}", inputs.mesh, inputs.primitive);
        if (entry == nullptr) {
            return mismatch(folder, "does not know the scene's " + pointer);
        }
        const Material& material = scene.materials[static_cast<std::size_t>(inputs.material)];
        if (entry->materialIndex != static_cast<std::uint32_t>(inputs.material) ||
            maskOf(*entry) != makeKey(material, inputs, keys)) {
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

Result<Package> compileTemporary(const Scene& scene, CompileSettings settings) {
    settings.emitHeader = false;
    const Result<CompiledPackage> compiled = compilePackage(scene, settings);
    if (!compiled) {
        return compiled.error();
    }
    // From here on an interruption waits until the folder is gone again: milliseconds.
    const HeldSignals held;
    const Result<TemporaryFolder> folder = TemporaryFolder::create();
    if (!folder) {
        return folder.error();
    }
    const std::filesystem::path path = folder->path() / "package";
    if (Status written = writePackage(*compiled, path); !written) {
        return written.error();
    }
    return Package::load(path);
}

}  // namespace glint
