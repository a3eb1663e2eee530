#include "cli/read_scenes.h"

#include <optional>
#include <utility>

namespace glint {

Result<std::vector<Scene>> readScenes(std::span<const std::string> files, const ImportOptions& options) {
    std::vector<Scene> scenes;
    bool hasVariant = options.variant.empty();
    std::optional<Diagnostic> missing;
    for (const std::string& file : files) {
        Result<Scene> scene = importScene(file, options);
        if (!scene && scene.error().id == "variant-unknown") {
            missing = missing ? missing : scene.error();
            ImportOptions defaults = options;
            defaults.variant.clear();
            scene = importScene(file, defaults);
        } else {
            hasVariant = true;
        }
        if (!scene) {
            return scene.error();
        }
        scenes.push_back(std::move(*scene));
    }
    if (!hasVariant) {
        return *missing;
    }
    return scenes;
}

std::vector<Diagnostic> warningsOf(std::span<const Scene> scenes) {
    std::vector<Diagnostic> warnings;
    for (const Scene& scene : scenes) {
        warnings.insert(warnings.end(), scene.warnings.begin(), scene.warnings.end());
    }
    return warnings;
}

}  // namespace glint
