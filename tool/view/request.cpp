#include "view/request.h"

#include "settings/descriptor.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string_view>

namespace glint::view {

std::vector<std::string> shotWords(const compiler::Settings& settings, const ShotOptions& options) {
    std::vector<std::string> words{"glint", "render", options.scene, "-o", options.output};
    const auto add = [&](std::string_view name, const std::string& value) {
        words.push_back("--" + std::string(name));
        words.push_back(value);
    };
    const compiler::Settings usual;
    for (const compiler::Descriptor& row : compiler::settingsTable()) {
        const std::string value = row.values.text(settings);
        if ((row.commands & compiler::kOfRender) == 0 || value == row.values.text(usual)) {
            continue;
        }
        if (!settings.package.empty() && row.stage == compiler::SettingStage::Package) {
            continue;  // the package has decided
        }
        if (row.name == "layers") {
            continue;  // files of pictures hold none
        }
        std::ranges::move(optionWords(row, value), std::back_inserter(words));
    }
    const std::pair<std::string_view, const std::string&> files[] = {
        {"environment", settings.environment},
        {"package", settings.package},
        {"scene", settings.sceneInFile},
        {"variant", settings.variant},
        {"profile", settings.profile},
        {"calibration", settings.calibration},
        {"gpu", settings.gpu},
        {"host", settings.compile.host},
        {"camera", options.camera},
        {"time", options.time},
        {"view", options.view},
        {"layers", options.layers},
        {"edits", options.edits},
    };
    for (const auto& [name, value] : files) {
        // Profiles are only for policies that count hits, whose word names the file.
        if (name == "profile" && !value.empty()) {
            const auto merge = std::ranges::find(words, "--merge");
            if (merge != words.end()) {
                *(merge + 1) += ":" + value;
            }
        } else if (!value.empty()) {
            add(name, value);
        }
    }
    if (!options.time.empty() && !options.animation.empty()) {
        add("animation", options.animation);
    }
    for (const std::string& pack : settings.materials) {
        add("materials", pack);
    }
    add("exposure", fmt::format("{}", options.exposure));
    return words;
}

}  // namespace glint::view
