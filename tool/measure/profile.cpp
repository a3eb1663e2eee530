#include "base/files.h"
#include "base/json.h"
#include "base/suggest.h"
#include "base/text.h"
#include "inspect/pipelines.h"
#include "settings/table.h"

#include <glint/measure/profile.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

namespace glint::measure {

namespace {

constexpr const char* kProfileFormat = "glint-profile";
constexpr int kProfileVersion = 1;
// A key takes less than a kilobyte.
constexpr std::uint64_t kMaxProfileBytes = 1ULL << 26;
// With this limit, sums of 2^16 keys stay below 2^64.
constexpr std::uint64_t kMaxHits = 1ULL << 48;
constexpr std::size_t kMaxKeys = std::size_t{1} << 16;

std::vector<std::string> namesOf(const materials::MaterialModel& model, materials::FeatureMask mask) {
    std::vector<std::string> names;
    for (const std::string_view name : model.names(mask)) {
        names.emplace_back(name);
    }
    return names;
}

void readFormat(base::JsonReader& reader, const base::Json& json) {
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

Profile readMembers(base::JsonReader& reader, const base::Json& json) {
    Profile profile;
    reader.each(json, "", "sources", [&](const base::Json& source, const std::string& place) {
        profile.sources.push_back({reader.text(source, place, "file"), reader.text(source, place, "hash")});
    });
    const base::Json* variant = reader.ok() ? reader.member(json, "", "variant") : nullptr;
    if (variant != nullptr && !variant->is_null()) {
        profile.variant = reader.text(json, "", "variant");
    }
    profile.alpha = reader.text(json, "", "alpha");
    profile.hitLobes = reader.texts(json, "", "hitLobes");
    reader.each(json, "", "keys", [&](const base::Json& key, const std::string& place) {
        if (profile.keys.size() == kMaxKeys) {
            reader.fail("/keys", fmt::format("has more than {} elements", kMaxKeys));
            return;
        }
        profile.keys.push_back({reader.texts(key, place, "features"), reader.texts(key, place, "materials"),
                                reader.count(key, place, "hits", kMaxHits)});
    });
    return profile;
}

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
    warn("--hit-lobes", base::join(profile.hitLobes), base::join(expected.hitLobes));
}

// Returns whether a file that both have read has changed.
bool isStale(const Profile& profile, const Profile& expected) {
    return std::ranges::any_of(profile.sources, [&](const ProfileSource& source) {
        const auto now = std::ranges::find(expected.sources, source.file, &ProfileSource::file);
        return now != expected.sources.end() && now->hash != source.hash;
    });
}

// Compares the keys of the profile with those of the scene, and takes its hits over.
void takeHits(const Profile& profile, const Profile& expected, const materials::MaterialModel& model,
              const std::string& file, PlanChoice& choice) {
    std::vector<std::string> gone;
    std::uint64_t hits = 0;
    for (const ProfileKey& key : profile.keys) {
        const auto here = std::ranges::find(expected.keys, key.features, &ProfileKey::features);
        const std::optional<materials::FeatureMask> mask = maskOf(model, key.features);
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
        // Auto has a better estimate than zero hits.
        const bool isAuto = choice.options.merge == compiler::MergePolicy::Auto;
        choice.options.hits.clear();
        choice.warnings.push_back(
            makeWarning("profile-empty", file, "has no hit of the scene's keys",
                        isAuto ? "hits are expected from areas: count them where rays reach something"
                               : "all of them share one case: use --merge auto, or count hits "
                                 "where rays reach something"));
    }
}

// Chooses the policy of `--alpha auto`, and reports it if a scene has surfaces that are not opaque.
void chooseAlpha(const compiler::Settings& settings, const gltf::SceneList& scenes, PlanChoice& choice) {
    const package::AlphaPolicy needed = compiler::neededAlphaPolicy(scenes.materials(), scenes.primitives());
    const package::AlphaPolicy chosen = settings.alpha.value_or(needed);
    choice.options.keys.alpha = chosen;
    if (!settings.alpha && needed == package::AlphaPolicy::Tested) {
        choice.notes.push_back({Severity::Note, "alpha-tested", "",
                                "the scene has alpha masks, so rays test them (--alpha tested)",
                                "--alpha opaque ignores masks where rays hit, which is faster"});
    }
    std::vector<std::string> blended;
    for (const materials::Material& material : scenes.materials()) {
        if (material.alphaMode == materials::AlphaMode::Blend) {
            blended.push_back(material.name.empty() ? "a material without a name" : material.name);
        }
    }
    if (needed != package::AlphaPolicy::Stochastic || blended.empty()) {
        return;
    }
    if (chosen != package::AlphaPolicy::Stochastic) {
        choice.notes.push_back({Severity::Note, "alpha-blend", "",
                                fmt::format("alphaMode BLEND is drawn opaque: {}", someOf(blended)), ""});
    } else if (!settings.alpha) {
        choice.notes.push_back(
            {Severity::Note, "alpha-stochastic", "",
             fmt::format("alphaMode BLEND is seen with the probability alpha, which is noise at few samples "
                         "(--alpha stochastic): {}",
                         someOf(blended)),
             "--alpha tested draws BLEND opaque, which is faster and free of that noise"});
    }
}

// Decides what the table of --gpu decides: how much branches cost, and settings that are `auto`. A finished
// package has decided about these itself.
Status chooseByGpu(const compiler::Settings& settings, PlanChoice& choice) {
    std::optional<compiler::GpuCosts> gpu;
    if (!settings.gpu.empty() && settings.gpu != compiler::kThisDevice) {
        GLINT_TRY(gpu, inspect::readGpuCosts(settings.gpu));
        choice.options.branchFactor = branchFactor(*gpu).value_or(1.0);
    }
    for (const compiler::GpuChoice& one : chooseSettings(gpu ? &*gpu : nullptr, settings.precisionError)) {
        if (settings.package.empty() &&
            compiler::sweptSetting(one.setting)->values.text(settings) == "auto") {
            choice.decided.emplace(one.setting, one.value);
            choice.notes.push_back({Severity::Note, "gpu-choice", "",
                                    fmt::format("--{} auto is {}: {}", one.setting, one.value, one.why), ""});
        }
    }
    return okStatus();
}

// Adds the lobes of packs that hits keep. Their bits are known only once the packs are read.
Status keepPackLobes(const compiler::Settings& settings, const gltf::SceneList& scenes,
                     materials::KeyOptions& keys) {
    const materials::MaterialModel& model =
        scenes.materials().empty() ? materials::builtinMaterialModel() : scenes.materials().front().model();
    for (const std::string& name : settings.packLobes) {
        const int feature = model.findFeature(name);
        if (feature < 0 || !model.features[static_cast<std::size_t>(feature)].isLobe) {
            std::vector<std::string> names;
            for (const std::string_view lobe : model.names(model.lobes)) {
                names.emplace_back(lobe);
            }
            return makeError("hit-lobe-unknown", "",
                             fmt::format("neither Glint nor a pack has a lobe \"{}\"{}", name,
                                         base::suggestion(name, names)),
                             "correct --hit-lobes, or add the pack by --materials");
        }
        keys.keptLobes |= model.features[static_cast<std::size_t>(feature)].mask();
    }
    return okStatus();
}

}  // namespace

Profile makeProfile(const gltf::SceneList& scenes, const compiler::Plan& plan,
                    const materials::KeyOptions& options) {
    Profile profile;
    for (const gltf::Scene& scene : scenes.scenes()) {
        for (const gltf::SourceFile& file : scene.files) {
            profile.sources.push_back(
                {std::filesystem::path(file.path).filename().string(), base::hexHash(file.hash)});
        }
    }
    profile.variant = scenes.variant();
    profile.alpha = nameOf(options.alpha);
    profile.hitLobes = namesOf(*plan.model, options.keptLobes & plan.model->lobes);
    for (const compiler::Key& key : plan.keys) {
        ProfileKey entry;
        entry.features = namesOf(*plan.model, key.mask);
        for (const int material : key.materials) {
            entry.materials.push_back(scenes.materialName(material));
        }
        profile.keys.push_back(std::move(entry));
    }
    return profile;
}

std::string toText(const Profile& profile) {
    base::Json sources = base::Json::array();
    for (const ProfileSource& source : profile.sources) {
        sources.push_back(base::Json{{"file", source.file}, {"hash", source.hash}});
    }
    base::Json keys = base::Json::array();
    for (const ProfileKey& key : profile.keys) {
        keys.push_back(
            base::Json{{"features", key.features}, {"materials", key.materials}, {"hits", key.hits}});
    }
    return base::toText(
        base::Json{{"format", kProfileFormat},
                   {"version", kProfileVersion},
                   {"sources", sources},
                   {"variant", profile.variant.empty() ? base::Json(nullptr) : base::Json(profile.variant)},
                   {"alpha", profile.alpha},
                   {"hitLobes", profile.hitLobes},
                   {"keys", keys}});
}

Result<Profile> readProfile(const std::filesystem::path& path) {
    base::JsonReader reader(path, "profile-format", "make the profile again with glint render --profile");
    GLINT_TRY(const auto json, reader.read(kMaxProfileBytes));
    readFormat(reader, json);
    Profile profile = reader.ok() ? readMembers(reader, json) : Profile{};
    return reader.ok() ? Result<Profile>(std::move(profile)) : Result<Profile>(reader.error());
}

Result<PlanChoice> choosePlan(const compiler::Settings& settings, const gltf::SceneList& scenes) {
    PlanChoice choice;
    choice.options = settings.compile.plan;
    GLINT_TRY_DO(chooseByGpu(settings, choice));
    chooseAlpha(settings, scenes, choice);
    GLINT_TRY_DO(keepPackLobes(settings, scenes, choice.options.keys));
    if (settings.profile.empty()) {
        return choice;
    }
    GLINT_TRY(const auto profile, readProfile(settings.profile));
    const compiler::Plan plan = compiler::makePlan(scenes.materials(), scenes.primitives(),
                                                   {choice.options.keys, compiler::MergePolicy::None});
    const Profile expected = makeProfile(scenes, plan, choice.options.keys);
    checkSettings(profile, expected, settings.profile, choice.warnings);
    if (isStale(profile, expected)) {
        choice.notes.push_back({Severity::Note, "profile-stale", settings.profile,
                                "was counted in another version of the scene", ""});
    }
    takeHits(profile, expected, *plan.model, settings.profile, choice);
    return choice;
}

Status writeProfile(const std::string& file, const gltf::SceneList& scenes,
                    const compiler::PlanOptions& options, std::span<const std::uint64_t> hits,
                    std::vector<Diagnostic>& warnings) {
    const compiler::Plan plan = compiler::makePlan(scenes.materials(), scenes.primitives(), options);
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
    return base::writeFile(file, toText(profile));
}

}  // namespace glint::measure
