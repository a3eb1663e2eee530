#include "materials/material_model.h"

#include <algorithm>
#include <cctype>

namespace glint::materials {

namespace {

using package::EffectInfo;

// Calls `add` with each letter of a name, and whether a word begins with it.
template <typename Add>
std::string spelled(std::string_view name, const Add& add) {
    std::string text;
    bool begins = true;
    for (const char c : name) {
        if (c == '-') {
            begins = true;
        } else {
            add(text, c, begins);
            begins = false;
        }
    }
    return text;
}

char upper(char c) {
    return static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
}

}  // namespace

std::string EffectDeclaration::function() const {
    return spelled(name, [](std::string& text, char c, bool begins) { text += begins ? upper(c) : c; });
}

std::string EffectDeclaration::file() const {
    return spelled(name, [](std::string& text, char c, bool begins) {
        text += begins && !text.empty() ? "_" : "";
        text += c;
    });
}

std::string EffectDeclaration::macro() const {
    std::string text = file();
    std::ranges::transform(text, text.begin(), upper);
    return text;
}

std::uint32_t EffectDeclaration::abilities() const {
    return (start.empty() ? 0U : std::uint32_t{package::kEffectStartsOnScreen}) |
           (walk.empty() ? 0U : std::uint32_t{package::kEffectWalks});
}

const std::string& EffectDeclaration::main() const {
    return kind == EffectInfo::Kind::Light ? light : kind == EffectInfo::Kind::Surface ? apply : sample;
}

std::vector<const std::string*> EffectDeclaration::files() const {
    std::vector<const std::string*> present;
    for (const std::string* const one : {&light, &apply, &sample, &compose, &start, &walk, &hit}) {
        if (!one->empty()) {
            present.push_back(one);
        }
    }
    return present;
}

bool isEffectName(std::string_view name) {
    bool begins = true;
    for (const char c : name) {
        const bool isSmall = c >= 'a' && c <= 'z';
        const bool isDigit = c >= '0' && c <= '9';
        if (begins ? !isSmall : !isSmall && !isDigit && c != '-') {
            return false;
        }
        begins = c == '-';
    }
    return !begins;
}

package::EffectInfo infoOf(const EffectDeclaration& effect, std::size_t number) {
    return {package::Effect{1} << number, effect.kind, effect.abilities(), effect.name};
}

package::EffectSet effectSetOf(const std::vector<EffectDeclaration>& effects, std::uint32_t bits) {
    package::EffectSet set;
    for (std::size_t i = 0; i < effects.size(); ++i) {
        const package::EffectInfo info = infoOf(effects[i], i);
        if ((bits & info.effect) != 0) {
            set.add(info);
        }
    }
    return set;
}

package::Effect findEffect(const std::vector<EffectDeclaration>& effects, std::string_view name) {
    const auto found = std::ranges::find(effects, name, &EffectDeclaration::name);
    return found == effects.end() ? 0 : package::Effect{1} << (found - effects.begin());
}

}  // namespace glint::materials
