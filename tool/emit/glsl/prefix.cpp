#include "emit/glsl/prefix.h"

#include "emit/glsl/items.h"
#include "emit/glsl/tokens.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <string>

namespace glint::compiler {

namespace {

constexpr std::string_view kPublic[] = {"glint", "Glint"};
constexpr std::string_view kMacro = "GLINT_";

bool isName(std::string_view piece) {
    return startsWord(piece.front());
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
Names typesOf(std::string_view glsl) {
    Names types;
    std::string_view before;
    forEachPiece(glsl, [&](std::string_view piece) {
        if (isName(piece) && (before == "struct" || before == "buffer") && !isPublic(piece)) {
            types.insert(piece);
        }
        before = isName(piece) ? piece : piece == " " ? before : std::string_view();
    });
    return types;
}

// Follows which braces are those of structs and blocks, whose members keep their names.
class Members {
public:
    void add(std::string_view piece) {
        if (piece == "struct" || piece == "buffer") {
            begins_ = true;
        } else if (piece == "{") {
            inside_ = begins_;
            begins_ = false;
        } else if (piece == "}") {
            inside_ = false;
        } else if (piece == ";") {
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
    const Names names = namesOf(glsl);
    const Names types = typesOf(glsl);
    std::string text;
    text.reserve(glsl.size() + glsl.size() / 8);
    Members members;
    char last = '\n';
    forEachPiece(glsl, [&](std::string_view piece) {
        members.add(piece);
        const bool renamed =
            isName(piece) && last != '.' &&
            (types.contains(piece) || (names.contains(piece) && (!members.inside() || isConstant(piece))));
        text += renamed ? renamedOf(piece) : std::string(piece);
        last = piece.back();
    });
    return text;
}

}  // namespace glint::compiler
