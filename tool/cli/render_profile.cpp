#include "cli/render_profile.h"

#include "base/files.h"
#include "cli/profile.h"

namespace glint {

void settleProfileOutput(const std::string& file, const std::string& package, const std::string& strategy,
                         bool mergeGiven, PlanArguments& plan) {
    if (file.empty()) {
        return;
    }
    if (!package.empty()) {
        throw CLI::ValidationError("--profile",
                                   "counts the shaders that --package decides; leave out one of them");
    }
    if (mergeGiven && plan.merge != "none") {
        throw CLI::ValidationError(
            "--profile",
            "counts the hits of every permutation, each of which needs a shader of its "
            "own: leave out --merge " +
                plan.merge);
    }
    if (strategy != "visibility") {
        throw CLI::ValidationError(
            "--profile", "needs --strategy visibility, which orders hits by shader, not " + strategy);
    }
    plan.merge = "none";
}

Status writeProfile(const std::string& file, const SceneList& scenes, const PlanOptions& options,
                    std::span<const std::uint64_t> hits, std::vector<Diagnostic>& warnings) {
    const Plan plan = makePlan(scenes.materials(), scenes.primitives(), options);
    Profile profile = makeProfile(scenes, plan, options.keys);
    std::uint64_t sum = 0;
    for (std::size_t key = 0; key < profile.keys.size(); ++key) {
        const auto shader = static_cast<std::size_t>(plan.keys[key].shaderId);
        profile.keys[key].hits = shader < hits.size() ? hits[shader] : 0;
        sum += profile.keys[key].hits;
    }
    if (sum == 0) {
        warnings.push_back(makeWarning("profile-empty", file, "counts no hit: no ray reached a material",
                                       "choose another --camera, or a higher --max-roughness"));
    }
    return writeFile(file, toText(profile));
}

}  // namespace glint
