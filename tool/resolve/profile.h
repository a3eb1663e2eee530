// Profiles, which are the number of hits of each key, and the options of planning that follow from them.
// `glint render --profile FILE` counts hits, and `--merge profile` reads them.
#pragma once

#include "base/fields_fwd.h"
#include "gltf/scene_list.h"
#include "plan/plan.h"
#include "resolve/build.h"

#include <glint/result.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace glint::compiler {

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

base::Fields fieldsOf(const Profile*);

// Returns JSON in the format of docs/schemas/profile.json.
std::string toText(const Profile& profile);

// Has the errors of readFile(), and "profile-format" with the place if the file is not a profile.
Result<Profile> readProfile(const std::filesystem::path& path);

// Returns the hits by key that a file counts. Adds to `messages` warnings about keys that the scenes have and
// the file lacks, and about a file that was made with other settings. `keys` are those of planKeys() with
// options.keys. Has the errors of readProfile().
Result<std::map<materials::FeatureMask, std::uint64_t>> readHits(const std::string& file,
                                                                 const gltf::SceneList& scenes,
                                                                 const Plan& keys, const PlanOptions& options,
                                                                 std::vector<Diagnostic>& messages);

// Writes the profile of a picture. `hits` is indexed by shader ID, and every key of the build has its own
// case (Settings::countsHits). Adds to `warnings` if there are no hits. Has the errors of writeFile().
Status writeProfile(const std::string& file, const Build& build, std::span<const std::uint64_t> hits,
                    std::vector<Diagnostic>& warnings);

}  // namespace glint::compiler
