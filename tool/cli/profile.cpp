#include "cli/profile.h"

#include "base/files.h"
#include "cli/report.h"

#include <fmt/format.h>

#include <string_view>

namespace glint {

namespace {

constexpr const char* kFormat = "glint-profile";
constexpr int kVersion = 1;
// A key takes less than a kilobyte.
constexpr std::uint64_t kMaxBytes = 1ULL << 26;
// Sums of 2^16 keys stay below 2^64.
constexpr std::uint64_t kMaxHits = 1ULL << 48;
constexpr std::size_t kMaxKeys = std::size_t{1} << 16;

std::vector<std::string> namesOf(FeatureMask mask) {
    std::vector<std::string> names;
    for (const std::string_view name : featureNames(mask)) {
        names.emplace_back(name);
    }
    return names;
}

// Reads members with their places; the first thing that is wrong stays in `error`.
class Reader {
public:
    explicit Reader(const std::filesystem::path& path) : path_(path.string()) {}

    bool ok() const {
        return error_.message.empty();
    }
    const Diagnostic& error() const {
        return error_;
    }

    void fail(const std::string& pointer, const std::string& message) {
        if (ok()) {
            error_ = makeError("profile-format", pointer.empty() ? path_ : path_ + "#" + pointer, message,
                               "make the profile again with glint render --profile");
        }
    }

    // Null, and an error, where `object` lacks the member.
    const Json* member(const Json& object, const std::string& pointer, const char* name) {
        const auto found = object.is_object() ? object.find(name) : object.end();
        if (found == object.end()) {
            fail(pointer, fmt::format("has no member \"{}\"", name));
            return nullptr;
        }
        return &*found;
    }

    std::string text(const Json& object, const std::string& pointer, const char* name) {
        const Json* value = member(object, pointer, name);
        if (value != nullptr && !value->is_string()) {
            fail(pointer + "/" + name, "is no string");
        }
        return ok() ? value->get<std::string>() : std::string();
    }

    std::uint64_t count(const Json& object, const std::string& pointer, const char* name) {
        const Json* value = member(object, pointer, name);
        if (value != nullptr && (!value->is_number_unsigned() || value->get<std::uint64_t>() > kMaxHits)) {
            fail(pointer + "/" + name, fmt::format("is no whole number from 0 to {}", kMaxHits));
        }
        return ok() ? value->get<std::uint64_t>() : 0;
    }

    // Calls use(element, its pointer) until one fails.
    template <typename Use>
    void each(const Json& object, const std::string& pointer, const char* name, const Use& use) {
        const Json* list = member(object, pointer, name);
        if (list != nullptr && !list->is_array()) {
            fail(pointer + "/" + name, "is no list");
        }
        for (std::size_t i = 0; ok() && i < list->size(); ++i) {
            use((*list)[i], fmt::format("{}/{}/{}", pointer, name, i));
        }
    }

    std::vector<std::string> texts(const Json& object, const std::string& pointer, const char* name) {
        std::vector<std::string> list;
        each(object, pointer, name, [&](const Json& element, const std::string& place) {
            if (!element.is_string()) {
                fail(place, "is no string");
                return;
            }
            list.push_back(element.get<std::string>());
        });
        return list;
    }

private:
    std::string path_;
    Diagnostic error_;
};

void readFormat(Reader& reader, const Json& json) {
    if (!json.is_object()) {
        reader.fail("", "is no JSON object");
        return;
    }
    if (reader.text(json, "", "format") != kFormat) {
        reader.fail("/format", fmt::format("is not \"{}\"", kFormat));
    }
    const std::uint64_t version = reader.count(json, "", "version");
    if (version != kVersion) {
        reader.fail("/version", fmt::format("is {}; this glint reads {}", version, kVersion));
    }
}

Profile readMembers(Reader& reader, const Json& json) {
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
                                reader.count(key, place, "hits")});
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
    return toText(Json{{"format", kFormat},
                       {"version", kVersion},
                       {"sources", sources},
                       {"variant", profile.variant.empty() ? Json(nullptr) : Json(profile.variant)},
                       {"alpha", profile.alpha},
                       {"hitLobes", profile.hitLobes},
                       {"keys", keys}});
}

Result<Profile> readProfile(const std::filesystem::path& path) {
    const Result<Bytes> bytes = readFile(path, kMaxBytes);
    if (!bytes) {
        return bytes.error();
    }
    Reader reader(path);
    Json json;
    try {
        json = Json::parse(bytes->begin(), bytes->end());
    } catch (const Json::parse_error& error) {
        reader.fail("", fmt::format("is no JSON: byte {} is wrong", error.byte));
        return reader.error();
    } catch (const Json::exception&) {
        // Not of the syntax: a number that no double holds.
        reader.fail("", "holds a number that is too large");
        return reader.error();
    }
    readFormat(reader, json);
    Profile profile = reader.ok() ? readMembers(reader, json) : Profile{};
    return reader.ok() ? Result<Profile>(std::move(profile)) : Result<Profile>(reader.error());
}

}  // namespace glint
