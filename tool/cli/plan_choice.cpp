#include "cli/plan_choice.h"

#include "cli/report.h"
#include "cli/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace glint {

namespace {

// Returns nothing if this version of Glint lacks one of the features.
std::optional<FeatureMask> maskOf(const std::vector<std::string>& features) {
    FeatureMask mask = 0;
    for (const std::string& name : features) {
        const std::span<const FeatureInfo> table = featureTable();
        const auto row = std::ranges::find(table, std::string_view(name), &FeatureInfo::name);
        if (row == table.end()) {
            return std::nullopt;
        }
        mask |= bit(row->feature);
    }
    return mask;
}

// Returns the first names, and how many more there are.
std::string someOf(const std::vector<std::string>& names) {
    constexpr std::size_t kShown = 5;
    const std::size_t shown = std::min(names.size(), kShown);
    std::string text =
        fmt::format("{}", fmt::join(names.begin(), names.begin() + static_cast<long>(shown), "; "));
    return names.size() > shown ? text + fmt::format("; and {} more", names.size() - shown) : text;
}

std::string describe(const std::vector<std::string>& features, const std::vector<std::string>& materials) {
    return fmt::format("{} ({})", fmt::join(materials, ", "),
                       features.empty() ? "no features" : fmt::format("{}", fmt::join(features, ", ")));
}

// Warns of a profile that was counted with other keys.
void checkSettings(const Profile& profile, const Profile& expected, const std::string& file,
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
    warn("--hit-lobes", join(profile.hitLobes), join(expected.hitLobes));
}

// Returns whether a file that both have read has changed.
bool isStale(const Profile& profile, const Profile& expected) {
    return std::ranges::any_of(profile.sources, [&](const ProfileSource& source) {
        const auto now = std::ranges::find(expected.sources, source.file, &ProfileSource::file);
        return now != expected.sources.end() && now->hash != source.hash;
    });
}

// Compares the keys of the profile with those of the scene, and takes its hits over.
void takeHits(const Profile& profile, const Profile& expected, const std::string& file, PlanChoice& choice) {
    std::vector<std::string> gone;
    std::uint64_t hits = 0;
    for (const ProfileKey& key : profile.keys) {
        const auto here = std::ranges::find(expected.keys, key.features, &ProfileKey::features);
        const std::optional<FeatureMask> mask = maskOf(key.features);
        if (here == expected.keys.end() || !mask) {
            gone.push_back(describe(key.features, key.materials));
            continue;
        }
        choice.options.hits[*mask] += key.hits;
        hits += key.hits;
    }
    std::vector<std::string> unknown;
    for (const ProfileKey& key : expected.keys) {
        if (std::ranges::find(profile.keys, key.features, &ProfileKey::features) == profile.keys.end()) {
            unknown.push_back(describe(key.features, key.materials));
        }
    }
    if (!unknown.empty()) {
        choice.warnings.push_back(makeWarning(
            "profile-keys", file,
            fmt::format("has no count for {} of the scene's {} keys, which are taken as never hit: {}",
                        unknown.size(), expected.keys.size(), someOf(unknown)),
            "count the hits again with glint render --profile"));
    }
    if (!gone.empty()) {
        choice.notes.push_back(
            {Severity::Note, "profile-keys", file,
             fmt::format("counts {} keys that the scene does not have: {}", gone.size(), someOf(gone)), ""});
    }
    if (hits == 0 && !expected.keys.empty()) {
        // Auto has a better estimate than that nothing is hit.
        const bool isAuto = choice.options.merge == MergePolicy::Auto;
        choice.options.hits.clear();
        choice.warnings.push_back(
            makeWarning("profile-empty", file, "has no hit of the scene's keys",
                        isAuto ? "hits are expected from areas: count them where rays reach something"
                               : "all of them share one case: use --merge auto, or count hits "
                                 "where rays reach something"));
    }
}

// Decides what `--alpha auto` stands for, and says so where a scene has surfaces that are not opaque.
void chooseAlpha(const PlanArguments& arguments, const SceneList& scenes, PlanChoice& choice) {
    if (arguments.alpha == "auto" && hasAlphaMasks(scenes.materials(), scenes.primitives())) {
        choice.options.keys.alpha = AlphaPolicy::Tested;
        choice.notes.push_back({Severity::Note, "alpha-tested", "",
                                "the scene has alpha masks, so rays test them (--alpha tested)",
                                "--alpha opaque ignores masks where rays hit, which is faster"});
    }
    std::vector<std::string> blended;
    for (const Material& material : scenes.materials()) {
        if (material.alphaMode == AlphaMode::Blend) {
            blended.push_back(material.name.empty() ? "a material without a name" : material.name);
        }
    }
    if (!blended.empty()) {
        choice.notes.push_back({Severity::Note, "alpha-blend", "",
                                fmt::format("alphaMode BLEND is drawn opaque: {}", someOf(blended)), ""});
    }
}

}  // namespace

Result<PlanChoice> choosePlan(const PlanArguments& arguments, const SceneList& scenes) {
    PlanChoice choice;
    choice.options = arguments.options();
    chooseAlpha(arguments, scenes, choice);
    if (arguments.profile.empty()) {
        return choice;
    }
    const Result<Profile> profile = readProfile(arguments.profile);
    if (!profile) {
        return profile.error();
    }
    const Plan plan =
        makePlan(scenes.materials(), scenes.primitives(), {choice.options.keys, MergePolicy::None});
    const Profile expected = makeProfile(scenes, plan, choice.options.keys);
    checkSettings(*profile, expected, arguments.profile, choice.warnings);
    if (isStale(*profile, expected)) {
        choice.notes.push_back({Severity::Note, "profile-stale", arguments.profile,
                                "was counted in another version of the scene", ""});
    }
    takeHits(*profile, expected, arguments.profile, choice);
    return choice;
}

}  // namespace glint
