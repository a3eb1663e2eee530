#include "resolve/lock_file.h"

#include "base/files.h"
#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <set>
#include <system_error>
#include <utility>

namespace glint::compiler {

LockUpdate updateLock(const LockedIds& locked, const Plan& plan, bool prune) {
    std::set<int> known;
    for (const auto& [mask, id] : locked) {
        known.insert(id);
    }
    LockUpdate update;
    for (const Key& key : plan.keys) {
        update.ids[key.mask] = key.shaderId;
        const auto found = locked.find(key.mask);
        if (found == locked.end()) {
            update.added.push_back(key.mask);
        } else if (found->second != key.shaderId) {
            update.moved.push_back({key.mask, found->second, key.shaderId, !known.contains(key.shaderId)});
        }
    }
    for (const auto& [mask, id] : locked) {
        if (!update.ids.contains(mask)) {
            update.stale.push_back(mask);
        }
    }
    for (std::size_t i = 0; !prune && i < update.stale.size(); ++i) {
        update.ids[update.stale[i]] = locked.at(update.stale[i]);
    }
    return update;
}

namespace {

// A key takes less than a kilobyte.
constexpr std::uint64_t kMaxLockBytes = 1ULL << 26;

Diagnostic formatError(const std::string& file, const LockTextError& error,
                       const materials::MaterialModel& model) {
    std::vector<std::string> features;
    for (const materials::Feature& info : model.features) {
        features.emplace_back(info.name);
    }
    const std::string meant =
        error.unknownFeature.empty() ? std::string() : base::suggestion(error.unknownFeature, features);
    return makeError("lock-format", fmt::format("{}:{}", file, error.line), error.message + meant,
                     error.hint);
}

bool isToBeMade(const LockRequest& request) {
    std::error_code ignored;
    return request.isWritten && !request.frozen && !std::filesystem::exists(request.file, ignored);
}

// Returns "a; b; and 3 more" from the texts of `describe` for the elements.
template <typename List, typename Describe>
std::string listSome(const List& list, const Describe& describe) {
    std::vector<std::string> texts;
    std::ranges::transform(list, std::back_inserter(texts), describe);
    return base::someOf(texts, 8);
}

// Returns "clearcoat normals (Varnish)": the key as in the file, with a material that has it.
std::string describeKey(const materials::FeatureMask& mask, const Plan& plan, const gltf::SceneList& scenes) {
    const auto key = std::ranges::find(plan.keys, mask, &Key::mask);
    const bool known = key != plan.keys.end() && !key->materials.empty();
    return lockKeyName(mask, *plan.model) +
           (known ? fmt::format(" ({})", scenes.materialName(key->materials.front())) : std::string());
}

// Reports what changes in the file, and which materials it affects.
class Teller {
public:
    Teller(const LockRequest& request, const gltf::SceneList& scenes, const Plan& plan,
           const LockText& before, const LockUpdate& update)
        : request_(request), scenes_(scenes), plan_(plan), before_(before), update_(update) {
        for (const MovedKey& key : update.moved) {
            (key.lostId ? lost_ : moved_).push_back(key);
        }
    }

    bool changes() const {
        return update_.changes(before_.ids) || !before_.repeated.empty();
    }

    Diagnostic outdated() const {
        const std::string missing =
            update_.added.empty()
                ? std::string("IDs of keys change")
                : fmt::format("{} without a shader ID: {}", base::counted(update_.added.size(), "key"),
                              listSome(update_.added, [&](const materials::FeatureMask& mask) {
                                  return describeKey(mask, plan_, scenes_);
                              }));
        return makeError("lock-outdated", request_.file,
                         fmt::format("would change, and --locked forbids it: {}", missing),
                         "compile without --locked, and commit the file");
    }

    void tell(std::vector<Diagnostic>& messages) const {
        tellRepeated(messages);
        tellLost(messages);
        tellMoved(messages);
        tellStale(messages);
    }

private:
    void tellRepeated(std::vector<Diagnostic>& messages) const {
        for (const RepeatedLockKey& key : before_.repeated) {
            messages.push_back(
                makeWarning("lock-conflict", fmt::format("{}:{}", request_.file, key.line),
                            fmt::format("gives {} a second shader ID; {} counts, not {}",
                                        describeKey(key.mask, plan_, scenes_), key.kept, key.ignored),
                            "commit the file that is written now"));
        }
    }

    void tellLost(std::vector<Diagnostic>& messages) const {
        if (!lost_.empty()) {
            messages.push_back(makeWarning(
                "lock-conflict", request_.file,
                fmt::format("has IDs that several cases claim now; these keys get new IDs: {}", moves(lost_)),
                "commit the file that is written now"));
        }
    }

    void tellMoved(std::vector<Diagnostic>& messages) const {
        if (!moved_.empty()) {
            messages.push_back(
                {Severity::Note, "lock-moved", request_.file,
                 fmt::format("keys take the ID of the case that they share now: {}", moves(moved_)), ""});
        }
    }

    void tellStale(std::vector<Diagnostic>& messages) const {
        if (update_.stale.empty()) {
            return;
        }
        const std::string list = listSome(update_.stale, [&](const materials::FeatureMask& mask) {
            return fmt::format("{} {}", before_.ids.at(mask), lockKeyName(mask, *plan_.model));
        });
        const bool many = update_.stale.size() > 1;
        if (request_.prune) {
            messages.push_back({Severity::Note, "lock-stale", request_.file,
                                fmt::format("loses {} that no scene has: {}",
                                            base::counted(update_.stale.size(), "key"), list),
                                ""});
        } else {
            messages.push_back({Severity::Note, "lock-stale", request_.file,
                                fmt::format("keeps {} that no scene has: {}",
                                            base::counted(update_.stale.size(), "key"), list),
                                fmt::format("--lock-prune drops {}", many ? "them" : "it")});
        }
    }

    std::string moves(const std::vector<MovedKey>& keys) const {
        return listSome(keys, [&](const MovedKey& key) {
            return fmt::format("{}, {} -> {}", describeKey(key.mask, plan_, scenes_), key.from, key.to);
        });
    }

    const LockRequest& request_;
    const gltf::SceneList& scenes_;
    const Plan& plan_;
    const LockText& before_;
    const LockUpdate& update_;
    std::vector<MovedKey> lost_;
    std::vector<MovedKey> moved_;
};

}  // namespace

Result<LockText> readLock(const LockRequest& request, const materials::MaterialModel& model) {
    if (isToBeMade(request)) {
        GLINT_TRY_DO(base::checkOutputFile(request.file));
        return LockText{};
    }
    GLINT_TRY(const auto bytes, base::readFile(request.file, kMaxLockBytes));
    std::variant<LockText, LockTextError> parsed =
        parseLock({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, model);
    if (const auto* error = std::get_if<LockTextError>(&parsed)) {
        return formatError(request.file, *error, model);
    }
    return std::get<LockText>(std::move(parsed));
}

Result<std::optional<std::string>> updateLock(const LockRequest& request, const LockText& before,
                                              const gltf::SceneList& scenes, const Plan& plan,
                                              std::vector<Diagnostic>& messages) {
    const LockUpdate update = updateLock(before.ids, plan, request.prune);
    const Teller teller(request, scenes, plan, before, update);
    if (request.frozen && teller.changes()) {
        return teller.outdated();
    }
    teller.tell(messages);
    return teller.changes() || isToBeMade(request) ? std::optional(formatLock(update.ids, *plan.model))
                                                   : std::nullopt;
}

}  // namespace glint::compiler
