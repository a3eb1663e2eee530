#include "emit/glsl/prune.h"

#include "emit/glsl/items.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

namespace glint::compiler {

namespace {

using Items = std::vector<GlslItem>;

// Returns whether ## can form the item's name from one of `fragments`.
bool mayBePasted(const GlslItem& item, const std::vector<std::string_view>& fragments) {
    return std::ranges::any_of(fragments, [&](std::string_view fragment) {
        return item.name.starts_with(fragment) || item.name.ends_with(fragment);
    });
}

// Marks the items that are reached from those that must stay.
std::vector<bool> findReached(const Items& items) {
    std::unordered_multimap<std::string_view, std::size_t> byName;
    std::vector<std::string_view> fragments;
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (!items[i].name.empty()) {
            byName.emplace(items[i].name, i);
        }
        fragments.insert(fragments.end(), items[i].pasted.begin(), items[i].pasted.end());
    }
    std::vector<bool> reached(items.size());
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (items[i].name.empty() || mayBePasted(items[i], fragments)) {
            reached[i] = true;
            open.push_back(i);
        }
    }
    while (!open.empty()) {
        const GlslItem& item = items[open.back()];
        open.pop_back();
        for (const std::string_view word : item.words) {
            const auto [begin, end] = byName.equal_range(word);
            for (auto entry = begin; entry != end; ++entry) {
                if (!reached[entry->second]) {
                    reached[entry->second] = true;
                    open.push_back(entry->second);
                }
            }
        }
    }
    return reached;
}

// A comment is dropped together with what stands right below it, which may be a list of macros.
void dropComments(const Items& items, std::vector<bool>& kept) {
    // Says whether anything is kept of what stands below, up to the end of the list.
    bool keptBelow = true;
    for (std::size_t i = items.size(); i-- > 0;) {
        const GlslItemKind kind = items[i].kind;
        if (kind == GlslItemKind::Comment) {
            kept[i] = keptBelow;
        } else if (kind == GlslItemKind::Macro && i + 1 < items.size() &&
                   items[i + 1].kind == GlslItemKind::Macro) {
            keptBelow = keptBelow || kept[i];
        } else {
            keptBelow = kept[i];
        }
    }
}

}  // namespace

GlslUnit dropUnused(const GlslUnit& unit) {
    const Items items = splitGlsl(unit.text());
    std::vector<bool> kept = findReached(items);
    dropComments(items, kept);
    GlslUnit result;
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (kept[i]) {
            result.add(unit, items[i].firstLine, items[i].lineCount);
        }
    }
    return result;
}

std::string essentialText(std::string_view glsl) {
    std::string text;
    text.reserve(glsl.size());
    std::string line;
    const auto endLine = [&] {
        const std::string_view words = trim(line);
        if (!words.empty()) {
            text += words;
            text += '\n';
        }
        line.clear();
    };
    forEachPiece(glsl, [&](std::string_view piece) {
        const bool blank = piece.starts_with("/*") || piece == " " || piece == "\t";
        if (piece == "\n") {
            endLine();
        } else if (!blank && !piece.starts_with("//")) {
            line += piece;
        } else if (blank && !line.empty() && line.back() != ' ') {
            // GLSL has no literals that contain blanks, so one blank can replace several.
            line += ' ';
        }
    });
    endLine();
    return text;
}

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
