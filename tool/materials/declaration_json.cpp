#include "materials/declaration_json.h"

namespace glint::materials {

Members::Members(const DeclarationJson& json, std::string where, Place place)
    : json_(json), where_(std::move(where)) {
    if (!json.is_object()) {
        failAt(where_, "must be an object");
    }
    for (const auto& item : json.items()) {
        const std::string_view name = item.key();
        if (std::ranges::none_of(memberRows(), [&](const MemberRow& row) {
                return row.standsAt(place) && row.name == name;
            })) {
            std::vector<std::string> known;
            for (const MemberRow& row : memberRows()) {
                if (row.standsAt(place)) {
                    known.emplace_back(row.name);
                }
            }
            refuseOthers(known);
        }
    }
    for (const MemberRow& row : memberRows()) {
        if (row.isNeededAt(place)) {
            static_cast<void>((*this)[row.name]);
        }
    }
    for (const MemberRule& rule : memberRules()) {
        if (rule.place != place) {
            continue;
        }
        const auto hasAny = [&](std::string_view names) {
            return std::ranges::any_of(memberRows(), [&](const MemberRow& row) {
                return hasWord(names, row.name) && has(row.name);
            });
        };
        const bool broken = (!rule.with.empty() && !hasAny(rule.with)) || hasAny(rule.without);
        for (const auto& item : json.items()) {
            if (broken && hasWord(rule.members, item.key())) {
                failAt(at(item.key()), std::string(rule.message), std::string(rule.hint));
            }
        }
    }
}

}  // namespace glint::materials
