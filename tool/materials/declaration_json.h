// Reads the JSON of declarations, and fails with the place of the fault.
#pragma once

#include "base/text.h"
#include "materials/declaration_files.h"
#include "materials/declaration_members.h"
#include "materials/interval.h"
#include "materials/material_model.h"

#include <glint/result.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glint::materials {

using DeclarationJson = nlohmann::ordered_json;

// Carries a diagnostic to readDeclarations(), which returns it.
struct DeclarationFault {
    Diagnostic diagnostic;
};

[[noreturn]] inline void failAt(const std::string& where, std::string message, std::string hint = {}) {
    throw DeclarationFault{makeError("declaration", where, std::move(message), std::move(hint))};
}

// One object of a declaration. Unknown members are errors, so that a misspelt one is found.
class Members {
public:
    // An object of a material feature: the table of members says what it may have, and beside what.
    Members(const DeclarationJson& json, std::string where, Place place);
    Members(const DeclarationJson& json, std::string where, std::initializer_list<std::string_view> known)
        : Members(json, std::move(where), std::span(known.begin(), known.size())) {}
    Members(const DeclarationJson& json, std::string where, std::span<const std::string_view> known)
        : json_(json), where_(std::move(where)) {
        refuseOthers({known.begin(), known.end()});
    }

    const std::string& where() const {
        return where_;
    }
    std::string at(std::string_view member) const {
        return fmt::format("{}/{}", where_, member);
    }
    bool has(std::string_view member) const {
        return json_.contains(member);
    }
    const DeclarationJson& operator[](std::string_view member) const {
        const auto found = json_.find(member);
        if (found == json_.end()) {
            failAt(where_, fmt::format("has no \"{}\"", member));
        }
        return *found;
    }
    std::string text(std::string_view member) const {
        const DeclarationJson& value = (*this)[member];
        if (!value.is_string() || value.get_ref<const std::string&>().empty()) {
            failAt(at(member), "must be a text that is not empty");
        }
        return value.get<std::string>();
    }
    std::string text(std::string_view member, std::string fallback) const {
        return has(member) ? text(member) : std::move(fallback);
    }
    bool flag(std::string_view member, bool fallback) const {
        if (!has(member)) {
            return fallback;
        }
        if (!(*this)[member].is_boolean()) {
            failAt(at(member), "must be true or false");
        }
        return (*this)[member].get<bool>();
    }
    double number(std::string_view member, double fallback) const {
        return has(member) ? toNumber((*this)[member], at(member)) : fallback;
    }
    // Returns the elements of an array, with their places; none if there is no such member.
    std::vector<std::pair<const DeclarationJson*, std::string>> list(std::string_view member) const {
        std::vector<std::pair<const DeclarationJson*, std::string>> elements;
        if (has(member)) {
            const DeclarationJson& array = (*this)[member];
            const std::string place = at(member);
            if (!array.is_array()) {
                failAt(place, "must be an array");
            }
            for (std::size_t i = 0; i < array.size(); ++i) {
                elements.emplace_back(&array[i], fmt::format("{}/{}", place, i));
            }
        }
        return elements;
    }
    std::vector<std::string> texts(std::string_view member) const {
        std::vector<std::string> result;
        for (const auto& [value, place] : list(member)) {
            if (!value->is_string()) {
                failAt(place, "must be a text");
            }
            result.push_back(value->get<std::string>());
        }
        return result;
    }

    // A number, or "infinity".
    static double toNumber(const DeclarationJson& value, const std::string& place) {
        if (value.is_string() && value.get_ref<const std::string&>() == "infinity") {
            return kUnlimited;
        }
        if (!value.is_number()) {
            failAt(place, "must be a number, or \"infinity\"");
        }
        return value.get<double>();
    }

private:
    void refuseOthers(const std::vector<std::string>& known) const {
        if (!json_.is_object()) {
            failAt(where_, "must be an object");
        }
        for (const auto& [name, value] : json_.items()) {
            if (std::ranges::find(known, name) == known.end()) {
                failAt(at(name),
                       fmt::format("there is no member \"{}\"{}", name, base::suggestion(name, known)));
            }
        }
    }

    const DeclarationJson& json_;
    std::string where_;
};

// A declaration whose objects have their members: what is known of a file without others. Members refer to
// `json`.
struct ParsedDeclaration {
    // Throws DeclarationFault.
    explicit ParsedDeclaration(const DeclarationFile& file);
    ParsedDeclaration(const ParsedDeclaration&) = delete;
    ParsedDeclaration& operator=(const ParsedDeclaration&) = delete;
    ~ParsedDeclaration() = default;

    std::string name;
    std::string text;
    bool isOfPack;
    DeclarationJson json;
    std::optional<EffectDeclaration> effect{};  // Declarations of effects have nothing of the following.
    std::optional<Members> members{};
    std::vector<Members> parameters{};
    std::vector<Members> textures{};
    std::vector<Members> attributes{};
    std::vector<Members> features{};
};

// Refuses the object whose name in GLSL, where it is that of a member, would be `name`.
void refuseWordOfGlsl(const Members& members, const std::string& name);

// A name that an #include may have, and that stays in its folder.
inline bool isDeclaredFile(std::string_view name, std::string_view extension) {
    return name.ends_with(extension) && name.front() != '.' && std::ranges::all_of(name, [](unsigned char c) {
               return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.';
           });
}

// Returns the row of `table` that is called `name`.
template <typename Row, std::size_t Count>
const Row& choose(const Row (&table)[Count], const Members& members, std::string_view member,
                  std::string_view name) {
    const auto found = std::ranges::find(table, name, &Row::name);
    if (found == std::end(table)) {
        std::vector<std::string> names;
        for (const Row& row : table) {
            names.emplace_back(row.name);
        }
        failAt(members.at(member),
               fmt::format("there is no \"{}\"{}", name, base::suggestion(std::string(name), names)));
    }
    return *found;
}

}  // namespace glint::materials
