#include "plan/lock.h"

#include <cstddef>
#include <set>

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

}  // namespace glint::compiler
