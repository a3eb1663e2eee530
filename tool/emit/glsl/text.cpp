#include "emit/glsl/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

namespace glint::compiler {

namespace {

bool isSpace(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

std::string_view skipBlanks(std::string_view text) {
    return {std::ranges::find_if_not(text, isSpace), text.end()};
}

}  // namespace

std::string_view trim(std::string_view text) {
    text = skipBlanks(text);
    while (!text.empty() && isSpace(text.back())) {
        text.remove_suffix(1);
    }
    return text;
}

std::vector<std::string_view> splitLines(std::string_view text) {
    std::vector<std::string_view> lines;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        std::string_view line = text.substr(0, end);
        if (!line.empty() && line.back() == '\r') {
            line.remove_suffix(1);
        }
        lines.push_back(line);
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return lines;
}

Directive parseDirective(std::string_view line) {
    line = trim(line);
    if (line.empty() || line.front() != '#') {
        return {};
    }
    line = trim(line.substr(1));
    const std::size_t end = std::min(line.find_first_of(" \t\"<"), line.size());
    std::string_view argument = line.substr(end);
    argument = trim(argument.substr(0, std::min(argument.find("//"), argument.size())));
    return {line.substr(0, end), argument};
}

std::size_t commentLength(std::string_view text) {
    if (text.empty() || text.front() != '/') {
        return 0;
    }
    if (text.starts_with("//")) {
        return std::min(text.find('\n'), text.size());
    }
    if (text.starts_with("/*")) {
        const std::size_t end = text.find("*/", 2);
        return end == std::string_view::npos ? text.size() : end + 2;
    }
    return 0;
}

std::vector<GlslToken> splitTokens(std::string_view glsl) {
    std::vector<GlslToken> tokens;
    std::vector<std::size_t> open;
    bool startsLine = true;
    bool isDirective = false;
    bool continues = false;
    forEachPiece(glsl, [&](std::string_view piece) {
        const char first = piece.front();
        if (first == '\n') {
            startsLine = true;
            isDirective = isDirective && continues;
        } else if (first != ' ' && commentLength(piece) == 0) {
            isDirective = isDirective || (startsLine && first == '#');
            startsLine = false;
            constexpr std::string_view kOpening = "({[";
            constexpr std::string_view kClosing = ")}]";
            const std::size_t closes = kClosing.find(first);
            if (kOpening.find(first) != std::string_view::npos && !isDirective) {
                open.push_back(tokens.size());
            }
            tokens.push_back({piece, isDirective});
            if (closes != std::string_view::npos && !isDirective && !open.empty() &&
                tokens[open.back()].text.front() == kOpening[closes]) {
                tokens.back().match = open.back();
                tokens[open.back()].match = tokens.size() - 1;
                open.pop_back();
            }
        }
        continues = first == '\\';
    });
    return tokens;
}

std::vector<std::string_view> identifiersOf(std::string_view line) {
    std::vector<std::string_view> words;
    forEachPiece(line, [&](std::string_view piece) {
        if (startsWord(piece.front())) {
            words.push_back(piece);
        }
    });
    return words;
}

namespace {

// Calls `visit` for each identifier and each punctuation character of `text`. Comments and numbers are
// skipped.
template <typename Visit>
void forEachToken(std::string_view text, const Visit& visit) {
    forEachPiece(text, [&](std::string_view piece) {
        const char first = piece.front();
        const bool isComment = first == '/' && piece.size() > 1;
        const bool isNumber = continuesWord(first) && !startsWord(first);
        if (!isComment && !isNumber && !isSpace(first)) {
            visit(piece);
        }
    });
}

// These words give the precision of a declaration, not its name or type.
bool isPrecision(std::string_view word) {
    return word == "GLINT_RELAXED" || word == "mediump" || word == "highp";
}

// Recognises the kind of a declaration from its tokens outside of all brackets.
class Shape {
public:
    void add(std::string_view token) {
        const char first = token.front();
        if (depth_ == 1 && isLayout() && token == "buffer_reference") {
            isReference_ = true;
        } else if (depth_ == 1 && begin_ == "GLINT_CONSTANT" && !isConstant_) {
            name_ = token;
            isConstant_ = true;
        }
        if (first == '(' || first == '[' || first == '{') {
            if (depth_++ == 0) {
                open(first);
            }
        } else if (first == ')' || first == ']' || first == '}') {
            if (--depth_ == 0) {
                ended_ = first == '}' && isFunction_;
            }
            pinned_ = pinned_ || depth_ < 0;
        } else if (depth_ == 0) {
            addOuter(token);
        }
    }
    void pin() {
        pinned_ = true;
    }
    bool ended() const {
        return ended_ && depth_ == 0;
    }
    bool isLoneWord() const {
        return words_ == 1 && groups_ == 0 && depth_ == 0 && !assigned_;
    }
    // Returns the name of a declaration that GlslItem::name knows, else an empty text.
    std::string_view name() const {
        const bool known = isFunction_ || isConstant_ || isType_ || isResource_;
        return known && !pinned_ && ended() && name_ != "main" ? name_ : std::string_view();
    }

private:
    bool isLayout() const {
        return begin_ == "layout";
    }
    void open(char bracket) {
        if (bracket == '{' && begin_ == "struct" && words_ == 2 && groups_ == 0) {
            name_ = last_;
            isType_ = true;
        } else if (bracket == '{' && isLayout() && groups_ == 1) {
            name_ = last_;
            isType_ = isReference_;
            isResource_ = false;
        } else if (bracket == '(' && words_ == 2 && !assigned_ && groups_ == 0) {
            name_ = last_;
            isHead_ = true;
        } else if (bracket == '{' && isHead_ && groups_ == 1) {
            isFunction_ = true;
        } else if (bracket != '[' || words_ != 3) {
            isHead_ = false;
        }
        ++groups_;
    }
    void addOuter(std::string_view token) {
        if (isPrecision(token)) {
            return;
        }
        ended_ = token == ";";
        if (startsWord(token.front()) && !assigned_) {
            begin_ = words_ == 0 ? token : begin_;
            ++words_;
            last_ = token;
            isHead_ = false;
            isResource_ = isResource_ || (isLayout() && token == "uniform" && groups_ == 1);
            name_ = isResource_ ? token : name_;
            // A variable of the type, or a block's, is declared with it.
            pinned_ = pinned_ || isType_;
        } else if (token == "=" && !assigned_) {
            assigned_ = true;
            // The words are const, type and name; an array's length may stand between them.
            isConstant_ = begin_ == "const" && words_ == 3;
            name_ = last_;
        } else if (token == ",") {
            pinned_ = true;
        }
    }

    int depth_ = 0;
    int words_ = 0;           // before a "="
    int groups_ = 0;          // pairs of brackets
    std::string_view begin_;  // the first word
    std::string_view last_;
    std::string_view name_;
    bool isHead_ = false;  // has seen "type name(…)"
    bool assigned_ = false;
    bool isFunction_ = false;
    bool isConstant_ = false;
    bool isReference_ = false;  // a buffer that is only a type
    bool isType_ = false;
    bool isResource_ = false;  // without members
    bool ended_ = false;
    bool pinned_ = false;
};

// Returns the identifiers beside the ## of `macro`, the text that follows a macro's name. An empty view means
// any identifier: parameters stand on both sides.
std::vector<std::string_view> pastedBy(std::string_view macro) {
    std::vector<std::string_view> parameters;
    if (macro.starts_with('(')) {
        const std::string_view list = macro.substr(0, macro.find(')'));
        forEachToken(list, [&](std::string_view token) { parameters.push_back(token); });
        macro.remove_prefix(list.size());
    }
    std::vector<std::string_view> pasted;
    std::string_view before;
    int signs = 0;
    forEachToken(macro, [&](std::string_view token) {
        if (token == "#") {
            ++signs;
            return;
        }
        if (signs == 2) {
            const bool fixedBefore = std::ranges::find(parameters, before) == parameters.end();
            const bool fixedAfter = std::ranges::find(parameters, token) == parameters.end();
            if (fixedBefore) {
                pasted.push_back(before);
            }
            if (fixedAfter) {
                pasted.push_back(token);
            }
            if (!fixedBefore && !fixedAfter) {
                pasted.emplace_back();
            }
        }
        signs = 0;
        before = token;
    });
    return pasted;
}

class Splitter {
public:
    explicit Splitter(std::string_view glsl) : rest_(glsl) {}

    std::vector<GlslItem> split() {
        while (!rest_.empty()) {
            addItem(skipBlanks(lineAhead()));
        }
        return std::move(items_);
    }

private:
    // Returns the rest of the line without its line break.
    std::string_view lineAhead() const {
        return rest_.substr(0, rest_.find('\n'));
    }
    // A directive continues while its lines end in a backslash.
    std::string_view directiveAhead() const {
        std::size_t end = rest_.find('\n');
        while (end != std::string_view::npos && end > 0 && rest_[end - 1] == '\\') {
            end = rest_.find('\n', end + 1);
        }
        return rest_.substr(0, end);
    }
    // Takes `text`, with which the rest begins, and the line break after it. A comment without an end has the
    // last line break itself.
    void take(std::string_view text) {
        const std::string_view taken = rest_.substr(0, text.size() + 1);
        line_ += static_cast<std::size_t>(std::ranges::count(taken, '\n')) + (taken.ends_with('\n') ? 0 : 1);
        rest_.remove_prefix(taken.size());
    }
    void addItem(std::string_view line) {
        GlslItem item;
        item.firstLine = line_;
        const char* const begin = rest_.data();
        if (line.empty()) {
            item.kind = GlslItemKind::Blank;
            take(lineAhead());
        } else if (line.starts_with("//")) {
            item.kind = GlslItemKind::Comment;
            take(lineAhead());
        } else if (line.front() == '#') {
            takeDirective(item);
        } else {
            takeCode(item);
        }
        item.text = {begin, static_cast<std::size_t>(rest_.data() - begin)};
        item.lineCount = line_ - item.firstLine;
        items_.push_back(std::move(item));
    }
    void takeDirective(GlslItem& item) {
        const std::string_view directive = directiveAhead();
        forEachToken(directive, [&](std::string_view token) {
            if (startsWord(token.front())) {
                item.words.push_back(token);
            }
        });
        if (item.words.size() >= 2 && item.words.front() == "define") {
            item.kind = GlslItemKind::Macro;
            item.name = item.words[1];
            const char* const end = item.name.data() + item.name.size();
            item.pasted =
                pastedBy({end, static_cast<std::size_t>(directive.data() + directive.size() - end)});
        }
        take(directive);
    }
    // Takes lines up to the end of the line that ends the declaration. A word alone on its line is a macro
    // that needs no semicolon, like GLINT_INTEROP_BEGIN.
    void takeCode(GlslItem& item) {
        Shape shape;
        int conditionals = 0;
        while (!rest_.empty()) {
            const std::string_view line = skipBlanks(lineAhead());
            if (line.starts_with('#')) {
                takeInnerDirective(item, shape, conditionals);
                continue;
            }
            if (takeCodeLine(item, shape) || shape.isLoneWord()) {
                break;
            }
        }
        if (conditionals != 0) {
            shape.pin();
        }
        item.name = shape.name();
    }
    void takeInnerDirective(GlslItem& item, Shape& shape, int& conditionals) {
        GlslItem directive;
        takeDirective(directive);
        item.words.insert(item.words.end(), directive.words.begin(), directive.words.end());
        const std::string_view word = directive.words.empty() ? std::string_view() : directive.words.front();
        if (word.starts_with("if")) {
            ++conditionals;
        } else if (word == "endif") {
            --conditionals;
        } else if (word != "else" && word != "elif") {
            shape.pin();
        }
        if (conditionals < 0) {
            shape.pin();
        }
    }
    // Takes a line, and all lines of a comment that begins on it. Returns whether the declaration ends there.
    bool takeCodeLine(GlslItem& item, Shape& shape) {
        std::size_t length = 0;
        while (length < rest_.size() && rest_[length] != '\n') {
            length += std::max<std::size_t>(commentLength(rest_.substr(length)), 1);
        }
        const std::string_view line = rest_.substr(0, length);
        forEachToken(line, [&](std::string_view token) {
            if (shape.ended()) {
                shape.pin();
            }
            shape.add(token);
            if (startsWord(token.front())) {
                item.words.push_back(token);
            }
        });
        take(line);
        return shape.ended();
    }

    std::string_view rest_;
    std::size_t line_ = 0;
    std::vector<GlslItem> items_;
};

}  // namespace

std::vector<GlslItem> splitGlsl(std::string_view glsl) {
    return Splitter(glsl).split();
}

std::uint32_t GlslUnit::fileNumber(std::string_view file) {
    // Most lines come from the file of the line before.
    if (!lines_.empty() && files_[lines_.back().file] == file) {
        return lines_.back().file;
    }
    const auto found = std::ranges::find(files_, file);
    if (found == files_.end()) {
        files_.emplace_back(file);
        return static_cast<std::uint32_t>(files_.size() - 1);
    }
    return static_cast<std::uint32_t>(found - files_.begin());
}

void GlslUnit::add(std::string_view line, std::string_view file, int number) {
    const bool blank = trim(line).empty();
    if (blank && afterBlank_) {
        return;
    }
    afterBlank_ = blank;
    lines_.push_back({text_.size(), fileNumber(file), number});
    text_ += line;
    text_ += '\n';
}

void GlslUnit::add(const GlslUnit& other, std::size_t first, std::size_t count) {
    for (std::size_t i = first; i < first + count; ++i) {
        add(other.line(i), other.file(i), other.number(i));
    }
}

std::string_view GlslUnit::line(std::size_t index) const {
    const std::size_t begin = lines_[index].begin;
    const std::size_t end = index + 1 < lines_.size() ? lines_[index + 1].begin : text_.size();
    return std::string_view(text_).substr(begin, end - begin - 1);
}

std::string GlslUnit::withPlaces() const {
    std::string placed;
    placed.reserve(text_.size() + text_.size() / 8);
    bool sawVersion = false;
    // The place that a compiler assumes for the next line.
    std::uint32_t nextFile = 0;
    int nextNumber = 0;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
        const std::string_view text = line(i);
        const Line& place = lines_[i];
        const bool isVersion = !sawVersion && parseDirective(text).word == "version";
        const bool follows = place.number == nextNumber && place.file == nextFile;
        if (sawVersion && !follows && !trim(text).empty()) {
            fmt::format_to(std::back_inserter(placed), "#line {} \"{}\"\n", place.number, files_[place.file]);
            nextFile = place.file;
            nextNumber = place.number;
        }
        placed += text;
        placed += '\n';
        ++nextNumber;
        if (isVersion) {
            placed += "#extension GL_GOOGLE_cpp_style_line_directive : require\n";
            sawVersion = true;
            nextNumber = 0;
        }
    }
    return placed;
}

}  // namespace glint::compiler
