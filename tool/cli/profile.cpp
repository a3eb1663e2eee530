#include "cli/profile.h"

#include "base/files.h"
#include "cli/json_reader.h"
#include "cli/report.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace glint {

namespace {

constexpr const char* kProfileFormat = "glint-profile";
constexpr int kProfileVersion = 1;
// A key takes less than a kilobyte.
constexpr std::uint64_t kMaxProfileBytes = 1ULL << 26;
// With this limit, sums of 2^16 keys stay below 2^64.
constexpr std::uint64_t kMaxHits = 1ULL << 48;
constexpr std::size_t kMaxKeys = std::size_t{1} << 16;

std::vector<std::string> namesOf(FeatureMask mask) {
    std::vector<std::string> names;
    for (const std::string_view name : featureNames(mask)) {
        names.emplace_back(name);
    }
    return names;
}

void readFormat(JsonReader& reader, const Json& json) {
    if (!json.is_object()) {
        reader.fail("", "is no JSON object");
        return;
    }
    if (reader.text(json, "", "format") != kProfileFormat) {
        reader.fail("/format", fmt::format("is not \"{}\"", kProfileFormat));
    }
    const std::uint64_t version = reader.count(json, "", "version", kMaxHits);
    if (version != kProfileVersion) {
        reader.fail("/version", fmt::format("is {}; this glint reads {}", version, kProfileVersion));
    }
}

Profile readMembers(JsonReader& reader, const Json& json) {
    Profile profile;
    reader.each(json, "", "sources", [&](const Json& source, const std::string& place) {
        profile.sources.push_back({reader.text(source, place, "file"), reader.text(source, place, "hash")});
    });
    const Json* variant = reader.ok() ? reader.member(json, "", "variant") : nullptr;
    if (variant != nullptr && !variant->is_null()) {
        profile.variant = reader.text(json, "", "variant");
    }
    profile.alpha = reader.text(json, "", "alpha");
    profile.hitLobes = reader.texts(json, "", "hitLobes");
    reader.each(json, "", "keys", [&](const Json& key, const std::string& place) {
        if (profile.keys.size() == kMaxKeys) {
            reader.fail("/keys", fmt::format("has more than {} elements", kMaxKeys));
            return;
        }
        profile.keys.push_back({reader.texts(key, place, "features"), reader.texts(key, place, "materials"),
                                reader.count(key, place, "hits", kMaxHits)});
    });
    return profile;
}

}  // namespace

Profile makeProfile(const SceneList& scenes, const Plan& plan, const KeyOptions& options) {
    Profile profile;
    for (const Scene& scene : scenes.scenes()) {
        for (const SourceFile& file : scene.files) {
            profile.sources.push_back(
                {std::filesystem::path(file.path).filename().string(), hexHash(file.hash)});
        }
    }
    profile.variant = scenes.variant();
    profile.alpha = toString(options.alpha);
    profile.hitLobes = namesOf(options.keptLobes & kLobeMask);
    for (const Key& key : plan.keys) {
        ProfileKey entry;
        entry.features = namesOf(key.mask);
        for (const int material : key.materials) {
            entry.materials.push_back(scenes.materialName(material));
        }
        profile.keys.push_back(std::move(entry));
    }
    return profile;
}

std::string toText(const Profile& profile) {
    Json sources = Json::array();
    for (const ProfileSource& source : profile.sources) {
        sources.push_back(Json{{"file", source.file}, {"hash", source.hash}});
    }
    Json keys = Json::array();
    for (const ProfileKey& key : profile.keys) {
        keys.push_back(Json{{"features", key.features}, {"materials", key.materials}, {"hits", key.hits}});
    }
    return toText(Json{{"format", kProfileFormat},
                       {"version", kProfileVersion},
                       {"sources", sources},
                       {"variant", profile.variant.empty() ? Json(nullptr) : Json(profile.variant)},
                       {"alpha", profile.alpha},
                       {"hitLobes", profile.hitLobes},
                       {"keys", keys}});
}

Result<Profile> readProfile(const std::filesystem::path& path) {
    JsonReader reader(path, "profile-format", "make the profile again with glint render --profile");
    const Result<Json> json = reader.read(kMaxProfileBytes);
    if (!json) {
        return json.error();
    }
    readFormat(reader, *json);
    Profile profile = reader.ok() ? readMembers(reader, *json) : Profile{};
    return reader.ok() ? Result<Profile>(std::move(profile)) : Result<Profile>(reader.error());
}

}  // namespace glint
