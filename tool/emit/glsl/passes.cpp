#include "emit/glsl/passes.h"

#include "emit/glsl/text.h"
#include "spirv/link.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstddef>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace glint::compiler {

// --- Flattening ---

namespace {

enum class FrameKind {
    Side,   // a condition on __cplusplus, decided here; its directives are dropped
    Guard,  // an include guard; its directives are dropped
    Other   // left to the compiler
};

struct Frame {
    FrameKind kind = FrameKind::Other;
    bool taken = true;
    int line = 0;  // where the conditional opens
};

Diagnostic errorAt(std::string id, std::string_view name, int line, std::string message, std::string hint) {
    return makeError(std::move(id), fmt::format("{}:{}", name, line), std::move(message), std::move(hint));
}

bool isActive(const std::vector<Frame>& frames) {
    return std::ranges::all_of(frames, &Frame::taken);
}
class Flattener {
public:
    Flattener(const SourceLookup& lookup, FlattenSide side) : lookup_(lookup), side_(side) {}

    Status addFile(std::string_view name, std::string_view text) {
        File file{std::string(name), splitLines(text), {}, 1};
        added_.insert(file.name);
        open_.push_back(file.name);
        for (std::size_t i = 0; i < file.lines.size(); ++i) {
            GLINT_TRY(auto handled, addDirective(file, i));
            if (!handled && isActive(file.frames)) {
                unit_.add(file.lines[i], file.name, static_cast<int>(i) + file.offset);
            }
        }
        if (!file.frames.empty()) {
            return errorAt("source-conditional", name, file.frames.back().line,
                           "the conditional has no #endif", "close it in the same file");
        }
        open_.pop_back();
        return okStatus();
    }
    GlslUnit takeUnit() {
        return std::move(unit_);
    }
    bool sawVersion() const {
        return sawVersion_;
    }

private:
    struct File {
        std::string name;
        std::vector<std::string_view> lines;
        std::vector<Frame> frames;
        int offset = 1;  // of a line's number from its index
    };

    // Handles the directive at `index` if flatten() decides it itself. Returns whether it did.
    Result<bool> addDirective(File& file, std::size_t index) {
        const Directive directive = parseDirective(file.lines[index]);
        if (directive.word.empty()) {
            return false;
        }
        const int line = static_cast<int>(index) + file.offset;
        if (directive.word == "include" && isActive(file.frames)) {
            const bool isSystem = directive.argument.starts_with('<');
            if (isSystem) {
                return side_ == FlattenSide::Glsl;
            }
            const Status status = addInclude(file, line, directive.argument);
            return status ? Result<bool>(true) : Result<bool>(status.error());
        }
        if (directive.word == "version" && side_ == FlattenSide::Glsl && !sawVersion_) {
            sawVersion_ = true;
            return false;
        }
        if (directive.word == "line") {
            int number = 0;
            std::from_chars(directive.argument.data(), directive.argument.data() + directive.argument.size(),
                            number);
            file.offset = number - static_cast<int>(index) - 1;
            return true;
        }
        // This is the guard's own #define.
        const bool inGuard = !file.frames.empty() && file.frames.back().kind == FrameKind::Guard;
        if (inGuard && directive.word == "define" && file.frames.back().line == line - 1) {
            return true;
        }
        return addConditional(file, index, directive);
    }
    Result<bool> addConditional(File& file, std::size_t index, const Directive& directive) {
        const int line = static_cast<int>(index) + file.offset;
        const std::string_view word = directive.word;
        std::vector<Frame>& frames = file.frames;
        if (word == "if" || word == "ifdef" || word == "ifndef") {
            if (word == "if" && directive.argument.find("__cplusplus") != std::string_view::npos) {
                return errorAt("source-conditional", file.name, line, "#if on __cplusplus can't be decided",
                               "write #ifdef __cplusplus or #ifndef __cplusplus");
            }
            Frame frame{FrameKind::Other, true, line};
            if (directive.argument == "__cplusplus") {
                frame = {FrameKind::Side, (word == "ifdef") == (side_ == FlattenSide::Cpp), line};
            } else if (word == "ifndef" && opensGuard(file, index)) {
                frame.kind = FrameKind::Guard;
            }
            frames.push_back(frame);
            return frame.kind != FrameKind::Other;
        }
        if (word != "else" && word != "elif" && word != "endif") {
            return false;
        }
        if (frames.empty()) {
            return errorAt("source-conditional", file.name, line, fmt::format("#{} without #if", word),
                           "open the conditional in the same file");
        }
        const bool isOwn = frames.back().kind != FrameKind::Other;
        if (word == "endif") {
            // The frame is popped first, because an #endif belongs to the text around the conditional.
            frames.pop_back();
            return isOwn;
        }
        if (isOwn && (word == "elif" || frames.back().kind == FrameKind::Guard)) {
            return errorAt("source-conditional", file.name, line,
                           fmt::format("#{} can't follow this conditional", word),
                           "use #else, with #ifdef __cplusplus");
        }
        if (isOwn) {
            frames.back().taken = !frames.back().taken;
        }
        return isOwn;
    }
    Status addInclude(const File& file, int line, std::string_view argument) {
        if (argument.size() < 3 || argument.front() != '"' || argument.back() != '"') {
            return errorAt("source-include", file.name, line, "#include without a name in quotes",
                           "write #include \"folder/file.glsl\"");
        }
        std::string name(argument.substr(1, argument.size() - 2));
        // Files of packs may include those beside them.
        const std::string beside = file.name.substr(0, file.name.rfind('/') + 1) + name;
        if (!lookup_(name) && lookup_(beside)) {
            name = beside;
        }
        if (std::ranges::find(open_, name) != open_.end()) {
            return errorAt("source-include", file.name, line, fmt::format("\"{}\" includes itself", name),
                           "break the cycle");
        }
        if (added_.contains(name)) {
            return okStatus();
        }
        const std::optional<std::string_view> text = lookup_(name);
        if (!text) {
            return errorAt("source-include", file.name, line, fmt::format("there is no \"{}\"", name),
                           "names are relative to the shader folder, or to the file that includes them");
        }
        if (name.ends_with(".spv")) {
            GLINT_TRY(const auto library, libraryLine(name, *text));
            return addFile(name, library);
        }
        return addFile(name, *text);
    }
    // C++ keeps its include guards, so that the result can be included next to the headers that it was made
    // from.
    bool opensGuard(const File& file, std::size_t index) const {
        if (side_ == FlattenSide::Cpp || !file.frames.empty() || index + 1 >= file.lines.size()) {
            return false;
        }
        const Directive next = parseDirective(file.lines[index + 1]);
        return next.word == "define" && next.argument == parseDirective(file.lines[index]).argument;
    }

    const SourceLookup& lookup_;
    FlattenSide side_;
    GlslUnit unit_;
    std::set<std::string, std::less<>> added_;
    std::vector<std::string> open_;  // files being flattened, outermost first
    bool sawVersion_ = false;
};
}  // namespace

Result<GlslUnit> flatten(std::string_view name, std::string_view text, const SourceLookup& lookup,
                         FlattenSide side) {
    Flattener flattener(lookup, side);
    GLINT_TRY_DO(flattener.addFile(name, text));
    if (side == FlattenSide::Glsl && !flattener.sawVersion()) {
        return errorAt("source-version", name, 1, "has no #version", "begin the file with #version 460");
    }
    return flattener.takeUnit();
}

// --- Pruning ---

namespace {

using Items = std::vector<GlslItem>;

// Marks the items that are reached from those that must stay.
std::vector<bool> findReached(const Items& items) {
    std::unordered_multimap<std::string_view, std::size_t> byName;
    std::vector<bool> reached(items.size());
    std::vector<std::size_t> open;
    const auto reach = [&](std::size_t item) {
        if (!reached[item]) {
            reached[item] = true;
            open.push_back(item);
        }
    };
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (items[i].name.empty()) {
            reach(i);
        } else {
            byName.emplace(items[i].name, i);
        }
    }
    while (!open.empty()) {
        const GlslItem& item = items[open.back()];
        open.pop_back();
        for (const std::string_view word : item.words) {
            const auto [begin, end] = byName.equal_range(word);
            std::for_each(begin, end, [&](const auto& entry) { reach(entry.second); });
        }
        for (const std::string_view fragment : item.pasted) {
            for (std::size_t i = 0; i < items.size(); ++i) {
                if (items[i].name.starts_with(fragment) || items[i].name.ends_with(fragment)) {
                    reach(i);
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

using Words = std::set<std::string_view>;

// The functions, macros and constants of a text.
Words namesOf(std::string_view glsl) {
    Words names;
    for (const GlslItem& item : splitGlsl(glsl)) {
        if (!item.name.empty() && !isPublic(item.name)) {
            names.insert(item.name);
        }
    }
    return names;
}

// The structs and blocks of a text.
Words typesOf(std::string_view glsl) {
    Words types;
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
    const Words names = namesOf(glsl);
    const Words types = typesOf(glsl);
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
