#include "cli/options/lock_option.h"

#include "base/files.h"
#include "base/suggest.h"
#include "cli/options/options.h"
#include "cli/report.h"
#include "plan/lock.h"
#include "plan/lock_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>
#include <variant>

namespace glint::cli {

namespace {

// A key takes less than a kilobyte.
constexpr std::uint64_t kMaxLockBytes = 1ULL << 26;

Diagnostic formatError(const std::string& file, const compiler::LockTextError& error,
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

const materials::MaterialModel& modelOf(const gltf::SceneList& scenes) {
    return scenes.materials().empty() ? materials::builtinMaterialModel()
                                      : scenes.materials().front().model();
}

bool isToBeMade(const LockArguments& arguments) {
    std::error_code ignored;
    return arguments.isWritten && !arguments.frozen && !std::filesystem::exists(arguments.file, ignored);
}

// The result is empty if there is no file yet.
Result<compiler::LockText> readLock(const LockArguments& arguments, const materials::MaterialModel& model) {
    if (isToBeMade(arguments)) {
        GLINT_TRY_DO(base::checkOutputFile(arguments.file));
        return compiler::LockText{};
    }
    GLINT_TRY(const auto bytes, base::readFile(arguments.file, kMaxLockBytes));
    std::variant<compiler::LockText, compiler::LockTextError> parsed =
        compiler::parseLock({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, model);
    if (const auto* error = std::get_if<compiler::LockTextError>(&parsed)) {
        return formatError(arguments.file, *error, model);
    }
    return std::get<compiler::LockText>(std::move(parsed));
}

// Returns "a; b; and 3 more" from the texts of `describe` for the elements.
template <typename List, typename Describe>
std::string listSome(const List& list, const Describe& describe) {
    constexpr std::size_t kShown = 8;
    std::string text;
    for (std::size_t i = 0; i < std::min(list.size(), kShown); ++i) {
        text += (i == 0 ? "" : "; ") + describe(list[i]);
    }
    return list.size() > kShown ? text + fmt::format("; and {} more", list.size() - kShown) : text;
}

std::string count(std::size_t number, std::string_view what) {
    return fmt::format("{} {}{}", number, what, number == 1 ? "" : "s");
}

// Returns "clearcoat normals (Varnish)": the key as in the file, with a material that has it.
std::string describeKey(materials::FeatureMask mask, const compiler::Plan& plan,
                        const gltf::SceneList& scenes) {
    const auto key = std::ranges::find(plan.keys, mask, &compiler::Key::mask);
    const bool known = key != plan.keys.end() && !key->materials.empty();
    return compiler::lockKeyName(mask, *plan.model) +
           (known ? fmt::format(" ({})", scenes.materialName(key->materials.front())) : std::string());
}

// Reports what changes in the file, and which materials it affects.
class Teller {
public:
    Teller(const LockArguments& arguments, const gltf::SceneList& scenes, const compiler::Plan& plan,
           const compiler::LockText& before, const compiler::LockUpdate& update)
        : arguments_(arguments), scenes_(scenes), plan_(plan), before_(before), update_(update) {
        for (const compiler::MovedKey& key : update.moved) {
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
                : fmt::format("{} without a shader ID: {}", count(update_.added.size(), "key"),
                              listSome(update_.added, [&](materials::FeatureMask mask) {
                                  return describeKey(mask, plan_, scenes_);
                              }));
        return makeError("lock-outdated", arguments_.file,
                         fmt::format("would change, and --locked forbids it: {}", missing),
                         "compile without --locked, and commit the file");
    }

    void tell(LockChoice& choice) const {
        tellRepeated(choice);
        tellLost(choice);
        tellMoved(choice);
        tellStale(choice);
    }

private:
    void tellRepeated(LockChoice& choice) const {
        for (const compiler::RepeatedLockKey& key : before_.repeated) {
            choice.warnings.push_back(
                makeWarning("lock-conflict", fmt::format("{}:{}", arguments_.file, key.line),
                            fmt::format("gives {} a second shader ID; {} counts, not {}",
                                        describeKey(key.mask, plan_, scenes_), key.kept, key.ignored),
                            "commit the file that is written now"));
        }
    }

    void tellLost(LockChoice& choice) const {
        if (!lost_.empty()) {
            choice.warnings.push_back(makeWarning(
                "lock-conflict", arguments_.file,
                fmt::format("has IDs that several cases claim now; these keys get new IDs: {}", moves(lost_)),
                "commit the file that is written now"));
        }
    }

    void tellMoved(LockChoice& choice) const {
        if (!moved_.empty()) {
            choice.notes.push_back(
                {Severity::Note, "lock-moved", arguments_.file,
                 fmt::format("keys take the ID of the case that they share now: {}", moves(moved_)), ""});
        }
    }

    void tellStale(LockChoice& choice) const {
        if (update_.stale.empty()) {
            return;
        }
        const std::string list = listSome(update_.stale, [&](materials::FeatureMask mask) {
            return fmt::format("{} {}", before_.ids.at(mask), compiler::lockKeyName(mask, *plan_.model));
        });
        const bool many = update_.stale.size() > 1;
        if (arguments_.prune) {
            choice.notes.push_back(
                {Severity::Note, "lock-stale", arguments_.file,
                 fmt::format("loses {} that no scene has: {}", count(update_.stale.size(), "key"), list),
                 ""});
        } else {
            choice.notes.push_back(
                {Severity::Note, "lock-stale", arguments_.file,
                 fmt::format("keeps {} that no scene has: {}", count(update_.stale.size(), "key"), list),
                 fmt::format("--lock-prune drops {}", many ? "them" : "it")});
        }
    }

    std::string moves(const std::vector<compiler::MovedKey>& keys) const {
        return listSome(keys, [&](const compiler::MovedKey& key) {
            return fmt::format("{}, {} -> {}", describeKey(key.mask, plan_, scenes_), key.from, key.to);
        });
    }

    const LockArguments& arguments_;
    const gltf::SceneList& scenes_;
    const compiler::Plan& plan_;
    const compiler::LockText& before_;
    const compiler::LockUpdate& update_;
    std::vector<compiler::MovedKey> lost_;
    std::vector<compiler::MovedKey> moved_;
};

}  // namespace

void addLockOptions(CLI::App& command, LockArguments& arguments, bool isWritten) {
    arguments.isWritten = isWritten;
    CLI::Option& lock = addText(command, "--lock", arguments.file, "FILE",
                                isWritten ? "keep shader IDs from build to build in this file, which\n"
                                            "is created, and extended by new keys; commit it"
                                          : "take shader IDs from this file, which glint compile\n"
                                            "--lock keeps");
    lock.group("Shaders");
    if (!isWritten) {
        return;
    }
    CLI::Option& frozen = addFlag(command, "--locked", arguments.frozen,
                                  "fail, and write nothing, if the lock file would change\n(needs --lock)");
    CLI::Option& prune = addFlag(command, "--lock-prune", arguments.prune,
                                 "remove keys that no scene has from the lock file, which\n"
                                 "frees their IDs (needs --lock, excludes --locked)");
    frozen.needs(&lock);
    prune.needs(&lock)->excludes(&frozen);
    for (CLI::Option* option : {&frozen, &prune}) {
        option->group("Shaders");
    }
}

Result<LockChoice> applyLock(const LockArguments& arguments, const gltf::SceneList& scenes,
                             compiler::PlanOptions& options) {
    LockChoice choice;
    if (arguments.file.empty()) {
        return choice;
    }
    GLINT_TRY(const auto before, readLock(arguments, modelOf(scenes)));
    options.lockedIds = before.ids;
    compiler::Plan plan = makePlan(scenes.materials(), scenes.primitives(), options);
    const compiler::LockUpdate update = updateLock(before.ids, plan, arguments.prune);
    const Teller teller(arguments, scenes, plan, before, update);
    if (arguments.frozen && teller.changes()) {
        return teller.outdated();
    }
    teller.tell(choice);
    if (teller.changes() || isToBeMade(arguments)) {
        choice.text = compiler::formatLock(update.ids, *plan.model);
    }
    choice.plan = std::move(plan);
    return choice;
}

}  // namespace glint::cli
