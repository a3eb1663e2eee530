#include "gltf/scene_list.h"

#include "gltf/planning_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <filesystem>
#include <iterator>
#include <set>

namespace glint::gltf {

namespace {

std::vector<std::string> uniqueNames(std::span<const Scene> scenes) {
    std::set<std::string> taken;
    std::vector<std::string> names;
    for (const Scene& scene : scenes) {
        const std::string stem = std::filesystem::path(scene.path).stem().string();
        std::string name = stem;
        for (int count = 2; !taken.insert(name).second; ++count) {
            name = fmt::format("{}_{}", stem, count);
        }
        names.push_back(std::move(name));
    }
    return names;
}

}  // namespace

SceneList::SceneList(std::span<const Scene> scenes) : scenes_(scenes), names_(uniqueNames(scenes)) {
    assert(!scenes.empty());
    const bool joins = scenes.size() > 1 || !scenes.front().animatedMaterials.empty();
    std::size_t materials = 0;
    for (const Scene& scene : scenes) {
        materialRanges_.push_back({materials, scene.materials.size()});
        std::vector<materials::PrimitiveInputs> inputs = planningInputs(scene);
        primitiveRanges_.push_back({primitives_.size(), inputs.size()});
        for (materials::PrimitiveInputs& input : inputs) {
            input.material += static_cast<int>(materials);
            primitives_.push_back(input);
        }
        if (joins) {
            std::vector<materials::Material> planned = planningMaterials(scene);
            std::ranges::move(planned, std::back_inserter(joined_));
        }
        materials += scene.materials.size();
    }
    materials_ = joins ? std::span<const materials::Material>(joined_) : scenes.front().materials;
}

std::string SceneList::path() const {
    std::string text;
    for (const Scene& scene : scenes_) {
        text += (text.empty() ? "" : ", ") + scene.path;
    }
    return text;
}

std::string SceneList::fileNames() const {
    std::string text;
    for (const Scene& scene : scenes_) {
        text += (text.empty() ? "" : ", ") + std::filesystem::path(scene.path).filename().string();
    }
    return text;
}

SceneList::Place SceneList::place(int material) const {
    const auto index = static_cast<std::size_t>(material);
    const auto after = std::ranges::upper_bound(materialRanges_, index, {}, &Range::first);
    const auto scene = static_cast<std::size_t>(after - materialRanges_.begin()) - 1;
    return {scene, static_cast<int>(index - materialRanges_[scene].first)};
}

std::string SceneList::materialName(int material) const {
    const Place at = place(material);
    if (at.index == scenes_[at.scene].defaultMaterial) {
        return "(default)";
    }
    const std::string& name = materials_[static_cast<std::size_t>(material)].name;
    return name.empty() ? fmt::format("material {}", at.index) : name;
}

std::string SceneList::variant() const {
    const auto chosen =
        std::ranges::find_if(scenes_, [](const Scene& scene) { return !scene.variant.empty(); });
    return chosen == scenes_.end() ? std::string() : chosen->variant;
}

}  // namespace glint::gltf
