#include "materials/declaration_json.h"

namespace glint::materials {

namespace {

// The words of GLSL that names of members can't be (GLSL 4.60, section 3.6), but for types with digits in
// their names.
constexpr std::string_view kGlslWords =
    "attribute const uniform varying buffer shared coherent volatile restrict readonly writeonly layout "
    "centroid flat "
    "smooth noperspective patch sample break continue do for while switch case default if else subroutine in "
    "out inout "
    "int void bool true false float double invariant precise discard return lowp mediump highp precision "
    "struct uint "
    "common partition active asm class union enum typedef template this resource goto inline noinline public "
    "static "
    "extern external interface long short half fixed unsigned superp input output filter sizeof cast "
    "namespace using";
constexpr std::string_view kMembersOfRecords = "own textures";
constexpr std::string_view kGlslTypes[] = {"vec", "ivec", "uvec", "bvec", "dvec", "mat", "dmat"};

bool isWordOfGlsl(std::string_view name) {
    const std::size_t letters = name.find_first_of("0123456789");
    return hasWord(kGlslWords, name) ||
           (letters != std::string_view::npos &&
            std::ranges::find(kGlslTypes, name.substr(0, letters)) != std::end(kGlslTypes));
}

}  // namespace

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

void refuseWordOfGlsl(const Members& members, const std::string& name) {
    if (isWordOfGlsl(name)) {
        failAt(members.at("name"), fmt::format("\"{}\" is a word of GLSL, where the name stands", name));
    }
    if (hasWord(kMembersOfRecords, name)) {
        failAt(members.at("name"), fmt::format("\"{}\" is a member that all records have", name));
    }
}

}  // namespace glint::materials
