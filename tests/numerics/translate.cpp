#include "translate.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <utility>
#include <vector>

namespace glint::numerics {
namespace {

enum class Kind { Word, Number, Space, Directive, Mark };

struct Token {
    Kind kind = Kind::Mark;
    std::string text;
};

bool startsWord(char c) {
    return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_';
}

bool isDigit(char c) {
    return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

std::size_t wordEnd(std::string_view text, std::size_t at) {
    while (at < text.size() && (startsWord(text[at]) || isDigit(text[at]))) {
        ++at;
    }
    return at;
}

// Finds the end of a number; "1.5e-3" and "0x1Fu" are one number each.
std::size_t numberEnd(std::string_view text, std::size_t at) {
    const bool hexadecimal = text.substr(at, 2) == "0x" || text.substr(at, 2) == "0X";
    while (at < text.size()) {
        const bool exponentSign = !hexadecimal && (text[at] == '+' || text[at] == '-') &&
                                  (text[at - 1] == 'e' || text[at - 1] == 'E');
        if (!startsWord(text[at]) && !isDigit(text[at]) && text[at] != '.' && !exponentSign) {
            break;
        }
        ++at;
    }
    return at;
}

// Skips spaces and comments.
std::size_t spaceEnd(std::string_view text, std::size_t at) {
    if (text.substr(at, 2) == "//") {
        return std::min(text.find('\n', at), text.size());
    }
    if (text.substr(at, 2) == "/*") {
        const std::size_t end = text.find("*/", at + 2);
        return end == std::string_view::npos ? text.size() : end + 2;
    }
    while (at < text.size() && std::isspace(static_cast<unsigned char>(text[at])) != 0) {
        ++at;
    }
    return at;
}

std::vector<Token> tokenize(std::string_view text) {
    std::vector<Token> tokens;
    std::size_t at = 0;
    while (at < text.size()) {
        Kind kind = Kind::Mark;
        std::size_t end = at + 1;
        const bool pointFirst = text[at] == '.' && at + 1 < text.size() && isDigit(text[at + 1]);
        if (const std::size_t space = spaceEnd(text, at); space > at) {
            kind = Kind::Space;
            end = space;
        } else if (startsWord(text[at])) {
            kind = Kind::Word;
            end = wordEnd(text, at);
        } else if (isDigit(text[at]) || pointFirst) {
            kind = Kind::Number;
            end = numberEnd(text, at + (pointFirst ? 1 : 0));
        } else if (text[at] == '#') {
            // Macros are translated like any text. A directive is its first word, or one of the whole lines
            // below.
            const std::size_t word = text.find_first_not_of(" \t", at + 1);
            const std::string_view name = text.substr(word, wordEnd(text, word) - word);
            const bool whole = name == "line" || name == "version" || name == "extension";
            kind = Kind::Directive;
            end = whole ? std::min(text.find('\n', at), text.size()) : wordEnd(text, word);
        }
        tokens.push_back({kind, std::string(text.substr(at, end - at))});
        at = end;
    }
    return tokens;
}

bool isFloatLiteral(const std::string& text) {
    const bool hexadecimal = text.starts_with("0x") || text.starts_with("0X");
    return !hexadecimal && text.find_first_of(".eE") != std::string::npos;
}

bool isSwizzle(const std::string& text) {
    if (text.size() < 2 || text.size() > 4) {
        return false;
    }
    return std::ranges::any_of(
        std::vector<std::string_view>{"xyzw", "rgba", "stpq"},
        [&](std::string_view set) { return text.find_first_not_of(set) == std::string::npos; });
}

class Translator {
public:
    explicit Translator(std::vector<Token> tokens) : tokens_(std::move(tokens)) {}

    Result<std::string> run() {
        for (std::size_t i = 0; i < tokens_.size(); ++i) {
            GLINT_TRY_DO(translate(i));
        }
        std::string text;
        for (const Token& token : tokens_) {
            text += token.text;
        }
        return text;
    }

private:
    Status translate(std::size_t i);
    Status translateWord(std::size_t i);
    Status translateSwizzle(std::size_t i);
    // Translates the constructor of a structure or an array, from the bracket at `open`.
    Status makeBraces(std::size_t open);

    // Returns the next token that is no space; an empty one at the end.
    std::size_t next(std::size_t i) const {
        do {
            ++i;
        } while (i < tokens_.size() && tokens_[i].kind == Kind::Space);
        return i;
    }
    const std::string& text(std::size_t i) const {
        static const std::string kNone;
        return i < tokens_.size() ? tokens_[i].text : kNone;
    }
    std::string place() const {
        return line_.empty() ? "glsl" : line_;
    }

    std::vector<Token> tokens_;
    std::set<std::string> structures_;
    std::string line_;  // the last #line directive
};

Status Translator::translate(std::size_t i) {
    Token& token = tokens_[i];
    switch (token.kind) {
        case Kind::Number:
            if (isFloatLiteral(token.text)) {
                token.text = "Real(" + token.text + ")";
            }
            break;
        case Kind::Directive:
            if (token.text.starts_with("#line")) {
                line_ = "after " + token.text;
            } else if (token.text.starts_with("#version") || token.text.starts_with("#extension")) {
                token.text.clear();
            }
            break;
        case Kind::Word:
            return translateWord(i);
        case Kind::Mark:
        case Kind::Space:
            break;
    }
    return okStatus();
}

Status Translator::translateWord(std::size_t i) {
    std::string& word = tokens_[i].text;
    if (i > 0 && tokens_[i - 1].text == ".") {
        return isSwizzle(word) ? translateSwizzle(i) : okStatus();
    }
    if (word == "struct") {
        structures_.insert(text(next(i)));
    } else if (word == "precise" || word == "highp" || word == "in") {
        word.clear();
    } else if (word == "out" || word == "inout") {
        word.clear();
        const std::size_t type = next(i);
        if (type < tokens_.size()) {
            tokens_[type].text = (text(type) == "float" ? "Real" : text(type)) + "&";
        }
    } else if (structures_.contains(word) && text(next(i)) == "(") {
        return makeBraces(next(i));
    } else if (text(next(i)) == "[") {
        // This is T[N](…), where N is a number or nothing.
        const std::size_t open = next(i);
        const std::size_t close = text(next(open)) == "]" ? next(open) : next(next(open));
        if (text(close) == "]" && text(next(close)) == "(") {
            const std::size_t bracket = next(close);
            for (std::size_t k = i; k < bracket; ++k) {
                tokens_[k] = {Kind::Space, ""};
            }
            return makeBraces(bracket);
        }
    }
    if (word == "float") {
        word = "Real";
    }
    return okStatus();
}

Status Translator::translateSwizzle(std::size_t i) {
    const std::string first = text(next(i));
    const std::string second = text(next(i) + 1);
    const bool plain = first == "=" && second != "=";
    const bool compound =
        first.size() == 1 && std::string_view("+-*/").find(first) != std::string_view::npos && second == "=";
    if (plain || compound) {
        return makeError("glsl-swizzle", place(), "a value is assigned to the swizzle ." + tokens_[i].text,
                         "assign to the components one by one");
    }
    tokens_[i].text += "()";
    return okStatus();
}

Status Translator::makeBraces(std::size_t open) {
    int depth = 0;
    for (std::size_t i = open; i < tokens_.size(); ++i) {
        if (text(i) == "(") {
            ++depth;
        } else if (text(i) == ")" && --depth == 0) {
            tokens_[open].text.assign(1, '{');
            tokens_[i].text.assign(1, '}');
            return okStatus();
        }
    }
    return makeError("glsl-bracket", place(), "a constructor's bracket is never closed", "");
}

}  // namespace

Result<std::string> translateToCpp(std::string_view glsl) {
    return Translator(tokenize(glsl)).run();
}

}  // namespace glint::numerics
