#include "resolve/profile.h"

#include "base/fields.h"
#include "base/files.h"
#include "base/text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

namespace glint::compiler {

using base::field;

namespace {

// A key takes less than a kilobyte.
constexpr std::uint64_t kMaxProfileBytes = 1ULL << 26;
// With this limit, sums of 2^16 keys stay below 2^64.
constexpr double kMaxHits = 0x1p48;
constexpr std::size_t kMaxKeys = std::size_t{1} << 16;

// Returns nothing if this version of Glint lacks one of the features.
std::optional<materials::FeatureMask> maskOf(const materials::MaterialModel& model,
                                             const std::vector<std::string>& features) {
    materials::FeatureMask mask = 0;
    for (const std::string& name : features) {
        const materials::FeatureMask feature = model.mask(name);
        if (feature == 0) {
            return std::nullopt;
        }
        mask |= feature;
    }
    return mask;
}

std::string describe(const std::vector<std::string>& features, const std::vector<std::string>& materials) {
    return fmt::format("{} ({})", fmt::join(materials, ", "),
                       features.empty() ? "no features" : fmt::format("{}", fmt::join(features, ", ")));
}

// Warns of a profile that was counted with other keys.
void compareSettings(const Profile& profile, const Profile& expected, const std::string& file,
                     std::vector<Diagnostic>& warnings) {
    const auto warn = [&](const char* what, const std::string& was, const std::string& is) {
        if (was != is) {
            warnings.push_back(makeWarning("profile-settings", file,
                                           fmt::format("was counted with {} {}, but this is {}", what,
                                                       was.empty() ? "none" : was, is.empty() ? "none" : is),
                                           "its keys may differ; count the hits again"));
        }
    };
    warn("--alpha", profile.alpha, expected.alpha);
    warn("--variant", profile.variant, expected.variant);
    warn("--hit-lobes", base::join(profile.hitLobes), base::join(expected.hitLobes));
}

// Returns whether a file that both have read has changed.
bool isStale(const Profile& profile, const Profile& expected) {
    return std::ranges::any_of(profile.sources, [&](const ProfileSource& source) {
        const auto now = std::ranges::find(expected.sources, source.file, &ProfileSource::file);
        return now != expected.sources.end() && now->hash != source.hash;
    });
}

void warnOfUnknown(const Profile& profile, const Profile& expected, const std::string& file,
                   std::vector<Diagnostic>& warnings) {
    std::vector<std::string> unknown;
    for (const ProfileKey& key : expected.keys) {
        if (std::ranges::find(profile.keys, key.features, &ProfileKey::features) == profile.keys.end()) {
            unknown.push_back(describe(key.features, key.materials));
        }
    }
    if (!unknown.empty()) {
        warnings.push_back(makeWarning(
            "profile-keys", file,
            fmt::format("has no count for {} of the scene's {} keys, which are taken as never hit: {}",
                        unknown.size(), expected.keys.size(), base::someOf(unknown)),
            "count the hits again with glint render --profile"));
    }
}

// Returns the profile of scenes and their keys, without hits.
Profile makeProfile(const gltf::SceneList& scenes, const Plan& plan, const materials::KeyOptions& options) {
    Profile profile;
    for (const gltf::Scene& scene : scenes.scenes()) {
        for (const gltf::SourceFile& file : scene.files) {
            profile.sources.push_back(
                {std::filesystem::path(file.path).filename().string(), base::hexHash(file.hash)});
        }
    }
    profile.variant = scenes.variant();
    profile.alpha = nameOf(options.alpha);
    profile.hitLobes = plan.model->names(options.keptLobes & plan.model->lobes);
    for (const Key& key : plan.keys) {
        ProfileKey entry;
        entry.features = plan.model->names(key.mask);
        for (const int material : key.materials) {
            entry.materials.push_back(scenes.materialName(material));
        }
        profile.keys.push_back(std::move(entry));
    }
    return profile;
}

}  // namespace

static base::Fields fieldsOf(const ProfileSource*) {
    return {
        field<&ProfileSource::file>("file", "File of the scene, without its folder."),
        field<&ProfileSource::hash>("hash", "XXH3 of the file, hexadecimal.", {.pattern = "^[0-9a-f]{16}$"})};
}

static base::Fields fieldsOf(const ProfileKey*) {
    using T = ProfileKey;
    return {field<&T::features>("features", "Names of its features, by bit."),
            field<&T::materials>("materials", "Names of the materials that have it."),
            field<&T::hits>("hits", "Number of its hits.", {.most = kMaxHits})};
}

base::Fields fieldsOf(const Profile*) {
    using T = Profile;
    return {base::constant("format", "Names the kind of file.", "glint-profile"),
            base::constant("version", "Version of the format.", 1),
            field<&T::sources>("sources", "The files whose materials were rendered."),
            field<&T::variant>("variant", "The variant of the materials; null for none.", {.orNull = true}),
            field<&T::alpha>("alpha", "What rays did with the alpha of what they hit."),
            field<&T::hitLobes>("hitLobes", "Names of the lobes that hits kept."),
            field<&T::keys>("keys", "The keys of the scene, by their mask.", {.mostElements = kMaxKeys})};
}

std::string toText(const Profile& profile) {
    return base::toText(base::jsonOf(profile));
}

Result<Profile> readProfile(const std::filesystem::path& path) {
    constexpr const char* kHint = "make the profile again with glint render --profile";
    return base::readFileAs<Profile>({path, "profile-format", kHint}, kMaxProfileBytes);
}

Result<std::map<materials::FeatureMask, std::uint64_t>> readHits(const std::string& file,
                                                                 const gltf::SceneList& scenes,
                                                                 const Plan& keys, const PlanOptions& options,
                                                                 std::vector<Diagnostic>& messages) {
    GLINT_TRY(const auto profile, readProfile(file));
    const Profile expected = makeProfile(scenes, keys, options.keys);
    std::vector<Diagnostic> notes;
    compareSettings(profile, expected, file, messages);
    if (isStale(profile, expected)) {
        notes.push_back(
            {Severity::Note, "profile-stale", file, "was counted in another version of the scene", ""});
    }
    std::map<materials::FeatureMask, std::uint64_t> hits;
    std::vector<std::string> gone;
    std::uint64_t sum = 0;
    for (const ProfileKey& key : profile.keys) {
        const auto here = std::ranges::find(expected.keys, key.features, &ProfileKey::features);
        const std::optional<materials::FeatureMask> mask = maskOf(*keys.model, key.features);
        if (here == expected.keys.end() || !mask) {
            gone.push_back(describe(key.features, key.materials));
            continue;
        }
        hits[*mask] += key.hits;
        sum += key.hits;
    }
    if (!gone.empty()) {
        notes.push_back(
            {Severity::Note, "profile-keys", file,
             fmt::format("counts {} keys that the scene does not have: {}", gone.size(), base::someOf(gone)),
             ""});
    }
    warnOfUnknown(profile, expected, file, messages);
    if (sum == 0 && !expected.keys.empty()) {
        // Auto has a better estimate than that nothing is hit.
        const bool isAuto = options.merge == MergePolicy::Auto;
        hits.clear();
        messages.push_back(makeWarning(
            "profile-empty", file, "has no hit of the scene's keys",
            isAuto
                ? "hits are expected from areas: count them where rays reach something"
                : "all of them share one case: use --merge auto, or count hits where rays reach something"));
    }
    messages.insert(messages.end(), notes.begin(), notes.end());
    return hits;
}

Status writeProfile(const std::string& file, const Build& build, std::span<const std::uint64_t> hits,
                    std::vector<Diagnostic>& warnings) {
    Profile profile = makeProfile(*build.scenes, build.plan, build.settings.compile.plan.keys);
    std::uint64_t sum = 0;
    for (std::size_t key = 0; key < profile.keys.size(); ++key) {
        const auto shader = static_cast<std::size_t>(build.plan.keys[key].shaderId);
        profile.keys[key].hits = shader < hits.size() ? hits[shader] : 0;
        sum += profile.keys[key].hits;
    }
    if (sum == 0) {
        warnings.push_back(makeWarning("profile-empty", file, "counts no hit: no ray reached a material",
                                       "choose another --camera, or a higher --max-roughness"));
    }
    return base::writeFile(file, toText(profile));
}

}  // namespace glint::compiler
