#include "plan/lock_ids.h"

#include <algorithm>
#include <cstddef>
#include <set>

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

}  // namespace glint::compiler
