#include "materials/declaration_json.h"

#include <bit>
#include <cassert>
#include <cstdint>

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

// The members that objects of a place may have, each with a bit.
struct MembersOfPlace {
    struct Rule {
        const MemberRule* row;
        std::uint64_t members;
        std::uint64_t with;
        std::uint64_t without;
    };

    std::vector<std::string_view> names;
    std::uint64_t needed = 0;
    std::vector<Rule> rules;

    // Returns the bits of the members that `isOne` is true for.
    template <typename IsOne>
    std::uint64_t bitsWhere(const IsOne& isOne) const {
        std::uint64_t bits = 0;
        for (std::size_t i = 0; i < names.size(); ++i) {
            bits |= isOne(names[i]) ? std::uint64_t{1} << i : 0;
        }
        return bits;
    }
    std::uint64_t bitsOf(std::string_view name) const {
        return bitsWhere([name](std::string_view one) { return one == name; });
    }
};

MembersOfPlace makeMembersOf(Place place) {
    MembersOfPlace members;
    for (const MemberRow& row : memberRows()) {
        if (row.standsAt(place)) {
            members.needed |= row.isNeededAt(place) ? std::uint64_t{1} << members.names.size() : 0;
            members.names.push_back(row.name);
        }
    }
    assert(members.names.size() <= 64);
    for (const MemberRule& rule : memberRules()) {
        const auto bits = [&](std::string_view words) {
            return members.bitsWhere([words](std::string_view name) { return hasWord(words, name); });
        };
        if (rule.place == place) {
            members.rules.push_back({&rule, bits(rule.members), bits(rule.with), bits(rule.without)});
        }
    }
    return members;
}

const MembersOfPlace& membersOf(Place place) {
    static const std::vector<MembersOfPlace> kAll = [] {
        std::vector<MembersOfPlace> all;
        for (std::size_t i = 0; i < static_cast<std::size_t>(Place::Count); ++i) {
            all.push_back(makeMembersOf(static_cast<Place>(i)));
        }
        return all;
    }();
    return kAll[static_cast<std::size_t>(place)];
}

}  // namespace

Members::Members(const DeclarationJson& json, std::string where, Place place)
    : json_(json), where_(std::move(where)) {
    if (!json.is_object()) {
        failAt(where_, "must be an object");
    }
    const MembersOfPlace& table = membersOf(place);
    std::uint64_t present = 0;
    for (const auto& item : json.items()) {
        const std::uint64_t bit = table.bitsOf(item.key());
        if (bit == 0) {
            refuseOthers({table.names.begin(), table.names.end()});
        }
        present |= bit;
    }
    if (const std::uint64_t missing = table.needed & ~present; missing != 0) {
        static_cast<void>((*this)[table.names[static_cast<std::size_t>(std::countr_zero(missing))]]);
    }
    for (const MembersOfPlace::Rule& rule : table.rules) {
        const bool broken = (rule.with != 0 && (rule.with & present) == 0) || (rule.without & present) != 0;
        if (!broken || (rule.members & present) == 0) {
            continue;
        }
        for (const auto& item : json.items()) {
            if ((rule.members & table.bitsOf(item.key())) != 0) {
                failAt(at(item.key()), std::string(rule.row->message), std::string(rule.row->hint));
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
