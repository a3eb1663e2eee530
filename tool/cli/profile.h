// Profiles: the number of hits of each key. `glint render --profile FILE` counts them, and `--merge profile`
// reads them.
#pragma once

#include "gltf/scene_list.h"
#include "plan/plan.h"

#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace glint {

// A key as the names of its features, which stay valid if a version of Glint numbers them differently.
struct ProfileKey {
    std::vector<std::string> features;   // in order of bits
    std::vector<std::string> materials;  // that have the key; for people
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

// Returns what scenes and plan give, without hits. Requires a plan that gives each key its own case, in the
// order of the keys.
Profile makeProfile(const SceneList& scenes, const Plan& plan, const KeyOptions& options);

std::string toText(const Profile& profile);

// Has the errors of readFile(), and "profile-format" with the place if the file is not a profile.
Result<Profile> readProfile(const std::filesystem::path& path);

}  // namespace glint
