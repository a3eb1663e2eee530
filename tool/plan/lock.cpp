#include "plan/lock.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

namespace glint::compiler {

namespace {

constexpr int kNoId = -1;

// An ID that a case can claim because some of its keys have it in the lock.
struct IdClaim {
    int keys = 0;  // keys of the case that have this ID
    double share = 0.0;
    int id = 0;
    std::size_t shaderCase = 0;
};

// Returns whether claim `a` wins over `b`.
bool isStronger(const IdClaim& a, const IdClaim& b) {
    if (a.keys != b.keys) {
        return a.keys > b.keys;
    }
    if (a.share != b.share) {
        return a.share > b.share;
    }
    return a.id != b.id ? a.id < b.id : a.shaderCase < b.shaderCase;
}

std::vector<IdClaim> claimsOf(std::span<const WeightedKey> keys, std::span<const CaseKeys> cases,
                              const LockedIds& locked) {
    std::vector<IdClaim> claims;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        double share = 0.0;
        std::map<int, int> keysById;
        for (const int index : cases[i].keys) {
            const WeightedKey& key = keys[static_cast<std::size_t>(index)];
            share += key.share;
            if (const auto found = locked.find(key.mask); found != locked.end()) {
                ++keysById[found->second];
            }
        }
        for (const auto& [id, count] : keysById) {
            claims.push_back({count, share, id, i});
        }
    }
    std::ranges::sort(claims, isStronger);
    return claims;
}

}  // namespace

std::vector<int> assignShaderIds(std::span<const WeightedKey> keys, std::span<const CaseKeys> cases,
                                 const LockedIds& locked) {
    std::vector<int> ids(cases.size(), kNoId);
    std::set<int> taken;
    for (const IdClaim& claim : claimsOf(keys, cases, locked)) {
        if (ids[claim.shaderCase] == kNoId && taken.insert(claim.id).second) {
            ids[claim.shaderCase] = claim.id;
        }
    }
    // IDs of the lock stay reserved for their keys, which may return.
    for (const auto& [mask, id] : locked) {
        taken.insert(id);
    }
    int next = 0;
    for (int& id : ids) {
        if (id == kNoId) {
            while (taken.contains(next)) {
                ++next;
            }
            id = next++;
        }
    }
    return ids;
}

namespace {

constexpr std::string_view kHeader =
    "# Shader IDs of Glint: a line a key, with its ID and its features. Written by glint compile --lock; "
    "commit\n"
    "# it, so that IDs stay the same from build to build. In a merge conflict keep the lines of both sides, "
    "in\n"
    "# any order: where two keys claim one ID, the next compile gives one of them a new one, and says so.\n";
constexpr std::string_view kVersionWord = "version";
constexpr int kVersion = 1;
constexpr std::string_view kNoFeatures = "-";
constexpr std::array<std::string_view, 4> kMarkers{"<<<<<<<", "|||||||", "=======", ">>>>>>>"};

// Quotes at most the beginning of a word that may be anything, for a message.
std::string quote(std::string_view word) {
    constexpr std::size_t kMaxLength = 40;
    std::string text;
    for (const char character : word.substr(0, kMaxLength)) {
        text += character >= ' ' && character <= '~' ? character : '?';
    }
    return fmt::format("\"{}{}\"", text, word.size() > kMaxLength ? "..." : "");
}

// Takes the next word off the front of `rest`. Returns an empty word if there is none.
std::string_view takeWord(std::string_view& rest) {
    constexpr std::string_view kBlanks = " \t\r";
    rest.remove_prefix(std::min(rest.find_first_not_of(kBlanks), rest.size()));
    const std::string_view word = rest.substr(0, rest.find_first_of(kBlanks));
    rest.remove_prefix(word.size());
    return word;
}

std::optional<int> parseNumber(std::string_view word, int max) {
    int value = 0;
    const char* end = word.data() + word.size();
    const auto parsed = std::from_chars(word.data(), end, value);
    const bool isWhole = parsed.ec == std::errc() && parsed.ptr == end && !word.empty();
    return isWhole && value >= 0 && value <= max ? std::optional(value) : std::nullopt;
}

class Parser {
public:
    explicit Parser(const materials::MaterialModel& model) : model_(model) {}

    std::variant<LockText, LockTextError> parse(std::string_view text) {
        constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
        if (text.starts_with(kByteOrderMark)) {
            text.remove_prefix(kByteOrderMark.size());
        }
        while (!text.empty() && !error_) {
            const std::string_view line = text.substr(0, text.find('\n'));
            text.remove_prefix(std::min(line.size() + 1, text.size()));
            ++line_;
            parseLine(line);
        }
        if (!error_ && !hasVersion_) {
            line_ = std::max(line_, 1);
            fail(fmt::format("ends without a line \"{} {}\"", kVersionWord, kVersion),
                 "this is no lock file");
        }
        return error_ ? std::variant<LockText, LockTextError>(*error_) : std::move(lock_);
    }

private:
    void fail(std::string message, std::string hint, std::string_view unknownFeature = {}) {
        error_ = {line_, std::move(message), std::move(hint), std::string(unknownFeature)};
    }

    void parseLine(std::string_view line) {
        std::string_view rest = line;
        const std::string_view first = takeWord(rest);
        if (first.empty() || first.starts_with('#')) {
            return;
        }
        const auto isMarker = [&](std::string_view marker) { return first.starts_with(marker); };
        if (std::ranges::any_of(kMarkers, isMarker)) {
            fail("a merge conflict was left unresolved",
                 "keep the lines of both sides, and take out the markers");
        } else if (first == kVersionWord) {
            parseVersion(rest);
        } else if (!hasVersion_) {
            fail(fmt::format("{} comes before a line \"{} {}\"", quote(first), kVersionWord, kVersion),
                 "this is not a lock file, or a merge removed its first line");
        } else {
            parseKey(first, rest);
        }
    }

    // The version line may occur twice: a merge of two branches that both created the file has it twice.
    void parseVersion(std::string_view rest) {
        const std::string_view word = takeWord(rest);
        if (word != fmt::format("{}", kVersion) || !takeWord(rest).empty()) {
            fail(fmt::format("is of version {}; this glint reads {}", quote(word), kVersion),
                 "use the version of Glint that wrote the file");
        }
        hasVersion_ = true;
    }

    void parseKey(std::string_view first, std::string_view rest) {
        const std::optional<int> id = parseNumber(first, kMaxLockedId);
        if (!id) {
            fail(fmt::format("{} is no shader ID, a number from 0 to {}", quote(first), kMaxLockedId),
                 "a line is a shader ID and the names of features");
            return;
        }
        const materials::FeatureMask mask = parseFeatures(rest);
        if (error_) {
            return;
        }
        const auto [known, isNew] = lock_.ids.emplace(mask, *id);
        if (!isNew && known->second != *id) {
            const auto [low, high] = std::minmax({known->second, *id});
            lock_.repeated.push_back({line_, mask, low, high});
            known->second = low;
        }
    }

    materials::FeatureMask parseFeatures(std::string_view rest) {
        materials::FeatureMask mask = 0;
        std::string_view word = takeWord(rest);
        if (word.empty()) {
            fail("has a shader ID and no features",
                 fmt::format("a key without features is written \"{}\"", kNoFeatures));
        }
        if (word == kNoFeatures) {
            word = takeWord(rest);
            if (!word.empty()) {
                fail(fmt::format("{} follows \"{}\", which stands for no features", quote(word), kNoFeatures),
                     fmt::format("take out \"{}\"", kNoFeatures));
            }
            return mask;
        }
        for (; !word.empty() && !error_; word = takeWord(rest)) {
            const int feature = model_.findFeature(word);
            if (feature < 0) {
                fail(fmt::format("{} is no feature", quote(word)),
                     "correct the name, or use the version of Glint that wrote it", word);
                break;
            }
            mask |= model_.features[static_cast<std::size_t>(feature)].mask();
        }
        return mask;
    }

    const materials::MaterialModel& model_;
    LockText lock_;
    std::optional<LockTextError> error_;
    int line_ = 0;
    bool hasVersion_ = false;
};

}  // namespace

std::variant<LockText, LockTextError> parseLock(std::string_view text,
                                                const materials::MaterialModel& model) {
    return Parser(model).parse(text);
}

std::string formatLock(const LockedIds& ids, const materials::MaterialModel& model) {
    std::vector<std::pair<std::string, int>> lines;
    lines.reserve(ids.size());
    for (const auto& [mask, id] : ids) {
        lines.emplace_back(lockKeyName(mask, model), id);
    }
    std::ranges::sort(lines);
    std::string text = fmt::format("{}{} {}\n", kHeader, kVersionWord, kVersion);
    for (const auto& [features, id] : lines) {
        text += fmt::format("{} {}\n", id, features);
    }
    return text;
}

std::string lockKeyName(const materials::FeatureMask& mask, const materials::MaterialModel& model) {
    const std::vector<std::string> names = model.names(mask);
    return names.empty() ? std::string(kNoFeatures) : fmt::format("{}", fmt::join(names, " "));
}

}  // namespace glint::compiler
