// Profiles, which are the number of hits of each key, and the options of planning that follow from them.
// `glint render --profile FILE` counts hits, and `--merge profile` reads them.
#pragma once

#include "gltf/scene_list.h"
#include "plan/plan.h"
#include "settings/configuration.h"

#include <glint/measure/render_settings.h>
#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace glint::measure {

// A key as the names of its features, which stay valid if a version of Glint numbers them differently.
struct ProfileKey {
    std::vector<std::string> features;   // in order of bits
    std::vector<std::string> materials;  // materials with the key; for people
    std::uint64_t hits = 0;
};

struct ProfileSource {
    std::string file;  // without folder
    std::string hash;
};

struct Profile {
    std::vector<ProfileSource> sources;
    std::string variant;  // empty: none
    std::string alpha;
    std::vector<std::string> hitLobes;
    std::vector<ProfileKey> keys;
};

// Returns the profile of scenes and plan, without hits. Requires a plan that gives each key its own case, in
// the order of the keys.
Profile makeProfile(const gltf::SceneList& scenes, const compiler::Plan& plan,
                    const materials::KeyOptions& options);

std::string toText(const Profile& profile);

// Has the errors of readFile(), and "profile-format" with the place if the file is not a profile.
Result<Profile> readProfile(const std::filesystem::path& path);

// Writes the profile of a picture. `hits` is indexed by shader ID of a plan with `options`, in which every
// key has its own case. Adds to `warnings` if there are no hits. Has the errors of writeFile().
Status writeProfile(const std::string& file, const gltf::SceneList& scenes,
                    const compiler::PlanOptions& options, std::span<const std::uint64_t> hits,
                    std::vector<Diagnostic>& warnings);

struct PlanChoice {
    compiler::PlanOptions options;
    // The values of settings that are `auto` and that the table of --gpu decides, for withSettings().
    compiler::Configuration decided;
    std::vector<Diagnostic> warnings;
    std::vector<Diagnostic> notes;
};

// Returns the options of the command line, with the hits of its profile if it names one, and with what `auto`
// stands for. Notes say what was chosen. Warns of keys that the scene has and the profile lacks, and of a
// profile that was made with other settings. Has the errors of readProfile() and of inspect::readGpuCosts().
Result<PlanChoice> choosePlan(const compiler::Settings& settings, const gltf::SceneList& scenes);

}  // namespace glint::measure
