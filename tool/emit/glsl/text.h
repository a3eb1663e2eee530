// Reads GLSL text: words, comments, lines and directives, the items at its top level, and where lines come
// from.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace glint::compiler {

// Returns `text` without blanks at both ends.
std::string_view trim(std::string_view text);

// Returns the lines without their line breaks, which may be of either kind.
std::vector<std::string_view> splitLines(std::string_view text);

// A directive: "#ifdef X // why" is {"ifdef", "X"}. A line without a directive has an empty word.
struct Directive {
    std::string_view word;
    std::string_view argument;
};
Directive parseDirective(std::string_view line);

// Returns whether an identifier may begin with, or contain, the character.
constexpr bool startsWord(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
constexpr bool continuesWord(char c) {
    return startsWord(c) || (c >= '0' && c <= '9');
}

// Returns the length in bytes of a comment at the start of `text`, or 0 if there is none.
std::size_t commentLength(std::string_view text);

// Removes the first piece of `text`, which is not empty, and returns it: a comment, a word or number, or one
// other character.
inline std::string_view takePiece(std::string_view& text) {
    std::size_t length = commentLength(text);
    while (length == 0 || (length < text.size() && continuesWord(text[0]) && continuesWord(text[length]))) {
        ++length;
    }
    const std::string_view piece = text.substr(0, length);
    text.remove_prefix(length);
    return piece;
}

// Calls `visit` with each piece of `text` in order.
template <typename Visit>
void forEachPiece(std::string_view text, const Visit& visit) {
    while (!text.empty()) {
        visit(takePiece(text));
    }
}

// Returns the identifiers of a line in order, without those in comments.
std::vector<std::string_view> identifiersOf(std::string_view line);

// A word, a number or one other character of code.
struct GlslToken {
    static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

    std::string_view text;
    bool isDirective = false;
    // Of a bracket outside of directives: its partner. Pairs of partners nest; a bracket that would break
    // this has none.
    std::size_t match = kNone;
};

// Returns the tokens of a text in order, without blanks and comments.
std::vector<GlslToken> splitTokens(std::string_view glsl);

// --- Splits GLSL into the items at its top level ---

enum class GlslItemKind : std::uint8_t {
    Blank,    // one line
    Comment,  // whole lines
    Macro,    // a #define with its continued lines
    Code      // declarations and all other directives; whole lines
};

struct GlslItem {
    GlslItemKind kind = GlslItemKind::Code;
    std::string_view text;  // whole lines, including the line breaks
    // The name of a macro, a function's definition, a constant, a structure, a buffer that is only a type or
    // a resource without members, which can be dropped if nothing uses it. An item without a name stays.
    std::string_view name;
    std::vector<std::string_view> words;   // identifiers
    std::vector<std::string_view> pasted;  // in a macro: the words that ## makes names of; "" means any name
    std::size_t firstLine = 0;             // counts the lines of the whole text, from 0
    std::size_t lineCount = 0;
};

// Returns all lines in order. Views point into `glsl`. An item that is not clearly one definition (several on
// a line, a prototype, directives that cross its borders) has no name.
std::vector<GlslItem> splitGlsl(std::string_view glsl);

// --- Units: the lines that the passes of the emitter hand on, and where each of them comes from ---

// The text of one shader without #include and #line.
class GlslUnit {
public:
    // Adds a line, which has no line break. `file` is named as an #include names it; `number` counts from 1.
    // A blank line at the start, or after a blank line, is left out.
    void add(std::string_view line, std::string_view file, int number);
    // Adds lines of another unit.
    void add(const GlslUnit& other, std::size_t first, std::size_t count);

    // The lines, each with a line break.
    const std::string& text() const {
        return text_;
    }
    // Returns the lines for a compiler: GL_GOOGLE_cpp_style_line_directive is asked for after #version, and a
    // #line directive stands wherever a line does not follow the one before it, so that messages name the
    // real place. A unit without #version has no directives.
    std::string withPlaces() const;

    std::size_t size() const {
        return lines_.size();
    }
    // The index is less than size(). Views live until the unit changes.
    std::string_view line(std::size_t index) const;
    std::string_view file(std::size_t index) const {
        return files_[lines_[index].file];
    }
    int number(std::size_t index) const {
        return lines_[index].number;
    }

private:
    struct Line {
        std::size_t begin = 0;  // in text_
        std::uint32_t file = 0;
        int number = 0;
    };
    std::uint32_t fileNumber(std::string_view file);

    std::string text_;
    std::vector<Line> lines_;
    std::vector<std::string> files_;
    bool afterBlank_ = true;
};

}  // namespace glint::compiler
