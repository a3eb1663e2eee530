#include "emit/glsl/prefix.h"

#include "emit/glsl/glsl_items.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <vector>

namespace glint {

namespace {

constexpr std::string_view kPublic[] = {"glint", "Glint"};
constexpr std::string_view kMacro = "GLINT_";

bool isWordCharacter(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

// A word, a comment or one other character.
struct Token {
    std::string_view text;
    bool isName = false;
};

std::vector<Token> tokensOf(std::string_view glsl) {
    std::vector<Token> tokens;
    while (!glsl.empty()) {
        std::size_t length = 1;
        if (glsl.starts_with("//")) {
            length = std::min(glsl.find('\n'), glsl.size());
        } else if (glsl.starts_with("/*")) {
            const std::size_t end = glsl.find("*/", 2);
            length = end == std::string_view::npos ? glsl.size() : end + 2;
        } else if (isWordCharacter(glsl.front())) {
            length = static_cast<std::size_t>(std::ranges::find_if_not(glsl, isWordCharacter) - glsl.begin());
        }
        const bool isName =
            isWordCharacter(glsl.front()) && std::isdigit(static_cast<unsigned char>(glsl.front())) == 0;
        tokens.push_back({glsl.substr(0, length), isName});
        glsl.remove_prefix(length);
    }
    return tokens;
}

bool isPublic(std::string_view name) {
    return std::ranges::any_of(kPublic, [&](std::string_view begin) { return name.starts_with(begin); });
}

// Returns whether a name can only be a macro or a constant, which members use and never are.
bool isConstant(std::string_view name) {
    return name.starts_with(kMacro) ||
           (name.size() > 1 && name[0] == 'k' && std::isupper(static_cast<unsigned char>(name[1])) != 0);
}

std::string renamedOf(std::string_view name) {
    return name.starts_with(kMacro) ? "GLINT_LIBRARY_" + std::string(name.substr(kMacro.size()))
                                    : "glint_" + std::string(name);
}

using Names = std::set<std::string_view>;

// The functions, macros and constants of a text.
Names namesOf(std::string_view glsl) {
    Names names;
    for (const GlslItem& item : splitGlsl(glsl)) {
        if (!item.name.empty() && !isPublic(item.name)) {
            names.insert(item.name);
        }
    }
    return names;
}

// The structs and blocks of a text.
Names typesOf(const std::vector<Token>& tokens) {
    Names types;
    std::string_view before;
    for (const Token& token : tokens) {
        if (token.isName && (before == "struct" || before == "buffer") && !isPublic(token.text)) {
            types.insert(token.text);
        }
        before = token.isName ? token.text : token.text == " " ? before : std::string_view();
    }
    return types;
}

// Follows which braces are those of structs and blocks, whose members keep their names.
class Members {
public:
    void add(const Token& token) {
        if (token.text == "struct" || token.text == "buffer") {
            begins_ = true;
        } else if (token.text == "{") {
            inside_ = begins_;
            begins_ = false;
        } else if (token.text == "}") {
            inside_ = false;
        } else if (token.text == ";") {
            begins_ = false;
        }
    }
    bool inside() const {
        return inside_;
    }

private:
    bool begins_ = false;
    bool inside_ = false;
};

}  // namespace

std::string prefixNames(std::string_view glsl) {
    const std::vector<Token> tokens = tokensOf(glsl);
    const Names names = namesOf(glsl);
    const Names types = typesOf(tokens);
    std::string text;
    text.reserve(glsl.size() + glsl.size() / 8);
    Members members;
    char last = '\n';
    for (const Token& token : tokens) {
        members.add(token);
        const bool renamed = token.isName && last != '.' &&
                             (types.contains(token.text) ||
                              (names.contains(token.text) && (!members.inside() || isConstant(token.text))));
        text += renamed ? renamedOf(token.text) : std::string(token.text);
        last = token.text.back();
    }
    return text;
}

}  // namespace glint
