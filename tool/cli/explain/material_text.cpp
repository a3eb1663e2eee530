#include "cli/explain/material_text.h"

#include "emit/package/json.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

namespace glint::cli {

namespace {

using Drop = std::pair<std::string, std::string>;  // feature, reason

// Returns the features that a material asks for and does not get, over all of its primitives.
std::set<Drop> dropsOf(const compiler::Build& build, int material) {
    std::set<Drop> drops;
    for (const compiler::DroppedFeature& dropped : build.plan.dropped) {
        if (std::ranges::binary_search(dropped.materials, material)) {
            drops.emplace(dropped.feature, dropped.reason);
        }
    }
    return drops;
}

std::vector<const compiler::Key*> keysOf(const compiler::Build& build, int material) {
    std::vector<const compiler::Key*> keys;
    for (const compiler::Key& key : build.plan.keys) {
        if (std::binary_search(key.materials.begin(), key.materials.end(), material)) {
            keys.push_back(&key);
        }
    }
    return keys;
}

// Returns JSON pointers of the primitives of one material that have this key.
std::vector<std::string> primitivesOf(const compiler::Build& build, const compiler::Key& key, int material) {
    std::vector<std::string> pointers;
    for (const int index : key.primitives) {
        const materials::PrimitiveInputs& inputs =
            build.scenes->primitives()[static_cast<std::size_t>(index)];
        if (inputs.material == material) {
            pointers.push_back(fmt::format("/meshes/{}/primitives/{}", inputs.mesh, inputs.primitive));
        }
    }
    return pointers;
}

const compiler::Case& caseOf(const compiler::Build& build, const compiler::Key& key) {
    return build.plan.cases[static_cast<std::size_t>(key.shaderId)];
}

// Returns the masks of primary surfaces of one material whose hits have this key. If hits keep all lobes, it
// is only the key itself.
std::set<materials::FeatureMask> primaryMasksOf(const compiler::Build& build, const compiler::Key& key,
                                                int material) {
    std::set<materials::FeatureMask> masks;
    for (const int index : key.primitives) {
        const auto primitive = static_cast<std::size_t>(index);
        if (build.scenes->primitives()[primitive].material == material) {
            masks.insert(build.plan.primaryMaskOfPrimitive[primitive]);
        }
    }
    return masks;
}

base::Json primaryToJson(const compiler::Build& build, const compiler::Key& key, int material) {
    base::Json list = base::Json::array();
    for (const materials::FeatureMask mask : primaryMasksOf(build, key, material)) {
        list.push_back(featuresToJson(*build.plan.model, mask));
    }
    return list;
}

// The values of the material that animations change: planning drops no feature for a value that passes.
std::vector<std::string> changesOf(const gltf::SceneList& scenes, int material) {
    const gltf::SceneList::Place place = scenes.place(material);
    const std::vector<gltf::AnimatedMaterial>& all = scenes.scenes()[place.scene].animatedMaterials;
    const auto found = std::ranges::find(all, place.index, &gltf::AnimatedMaterial::material);
    return found == all.end() ? std::vector<std::string>() : found->changes;
}

std::string whyText(const compiler::Case& shader) {
    const std::size_t keys = shader.keys.size();
    return fmt::format("{}: {}{}", toString(shader.reason), explain(shader.reason),
                       keys > 1 ? fmt::format(" ({} keys)", keys) : std::string());
}

std::string sharesText(const compiler::Build& build, const compiler::Key& key, const compiler::Case& shader) {
    const bool counted = countsHits(build.settings.compile.plan);
    const std::string ofCase =
        shader.keys.size() > 1 ? fmt::format(", its case {:.2f} %", 100.0 * shader.share) : std::string();
    return fmt::format("{:.2f} %{}, {}", 100.0 * key.share, ofCase,
                       counted ? "counted by the profile" : "expected from areas");
}

}  // namespace

base::Json materialToJson(const compiler::Build& build, int material) {
    base::Json keys = base::Json::array();
    for (const compiler::Key* key : keysOf(build, material)) {
        const compiler::Case& shader = caseOf(build, *key);
        keys.push_back(base::Json{{"mask", fmt::format("0x{:016x}", key->mask)},
                                  {"features", featuresToJson(*build.plan.model, key->mask)},
                                  {"onPrimarySurfaces", primaryToJson(build, *key, material)},
                                  {"share", compiler::roundedShare(key->share)},
                                  {"case",
                                   {{"id", shader.shaderId},
                                    {"name", shader.name},
                                    {"keys", shader.keys.size()},
                                    {"share", compiler::roundedShare(shader.share)},
                                    {"reason", toString(shader.reason)},
                                    {"always", featuresToJson(*build.plan.model, shader.always)},
                                    {"sometimes", featuresToJson(*build.plan.model, shader.sometimes)}}},
                                  {"primitives", primitivesOf(build, *key, material)}});
    }
    base::Json dropped = base::Json::array();
    for (const auto& [feature, reason] : dropsOf(build, material)) {
        dropped.push_back(base::Json{{"feature", feature}, {"reason", reason}});
    }
    return {{"index", material},
            {"name", build.scenes->materialName(material)},
            {"keys", keys},
            {"dropped", dropped},
            {"animated", changesOf(*build.scenes, material)}};
}

std::vector<std::vector<std::string>> materialRows(const compiler::Build& build, int material,
                                                   Detail detail) {
    const std::vector<const compiler::Key*> keys = keysOf(build, material);
    if (keys.empty()) {
        return {};
    }
    std::vector<std::vector<std::string>> rows;
    for (const compiler::Key* key : keys) {
        const compiler::Case& shader = caseOf(build, *key);
        const std::vector<std::string> primitives = primitivesOf(build, *key, material);
        const std::string more =
            primitives.size() > 1 ? fmt::format(" and {} more", primitives.size() - 1) : std::string();
        rows.push_back({"  key", fmt::format("0x{:016x}", key->mask)});
        rows.push_back({"    features", featureList(*build.plan.model, key->mask)});
        for (const materials::FeatureMask mask : primaryMasksOf(build, *key, material)) {
            if (mask != key->mask) {
                rows.push_back({"    primary only", featureList(*build.plan.model, mask & ~key->mask)});
            }
        }
        rows.push_back(
            {"    case", shaderTitle(static_cast<std::uint64_t>(shader.shaderId), shader.name, detail)});
        rows.push_back({"    why", whyText(shader)});
        rows.push_back({"    hits", sharesText(build, *key, shader)});
        rows.push_back({"    branches on", featureList(*build.plan.model, shader.sometimes)});
        rows.push_back({"    primitives", primitives.front() + more});
    }
    for (const auto& [feature, reason] : dropsOf(build, material)) {
        rows.push_back({"  dropped", fmt::format("{}: {}", feature, reason)});
    }
    for (const std::string& change : changesOf(*build.scenes, material)) {
        rows.push_back({"  animated", fmt::format("{}: kept for all values between", change)});
    }
    return rows;
}

}  // namespace glint::cli
