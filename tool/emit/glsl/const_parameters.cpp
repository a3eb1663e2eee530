#include "emit/glsl/passes.h"
#include "emit/glsl/text.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace glint::compiler {

namespace {

// Functions of GLSL that write arguments, by the beginnings of their names.
constexpr std::string_view kWriting[] = {"frexp",        "modf",         "uaddCarry",       "usubBorrow",
                                         "umulExtended", "imulExtended", "rayQuery",        "atomic",
                                         "image",        "traceRay",     "executeCallable", "hitObject"};

// The tokens of a text, without those of directives.
class GlslTokens {
public:
    explicit GlslTokens(std::string_view glsl) : all_(splitTokens(glsl)) {}

    std::size_t size() const {
        return all_.size();
    }
    std::string_view at(std::size_t index) const {
        return index < all_.size() && !all_[index].isDirective ? all_[index].text : std::string_view();
    }
    bool isWord(std::size_t index) const {
        return !at(index).empty() && startsWord(at(index).front());
    }
    bool touches(std::size_t index) const {
        return !at(index + 1).empty() && at(index).data() + 1 == at(index + 1).data();
    }
    // Returns whether the token is a bracket that another one closes, or that closes another one.
    bool opens(std::size_t index) const {
        return index < all_.size() && all_[index].match != GlslToken::kNone && all_[index].match > index;
    }
    bool closes(std::size_t index) const {
        return all_[index].match < index;
    }
    // Returns the bracket that closes the one at `open`; size() if there is none.
    std::size_t closing(std::size_t open) const {
        return opens(open) ? all_[open].match : all_.size();
    }

private:
    std::vector<GlslToken> all_;
};

struct Parameter {
    std::size_t first = 0;  // token
    std::string_view name;
    bool isPlain = false;  // passed by value, and no array
};

struct Definition {
    std::string_view name;
    std::vector<Parameter> parameters;
    std::size_t body = 0;  // its brackets
    std::size_t end = 0;
};

std::vector<Parameter> parametersOf(const GlslTokens& tokens, std::size_t open, std::size_t close) {
    std::vector<Parameter> parameters;
    for (std::size_t first = open + 1; first < close;) {
        Parameter parameter{first, {}, true};
        std::size_t at = first;
        for (; at < close && tokens.at(at) != ","; ++at) {
            const std::string_view token = tokens.at(at);
            parameter.isPlain = parameter.isPlain && tokens.isWord(at) && token != "out" &&
                                token != "inout" && token != "const";
            parameter.name = token;
        }
        parameter.isPlain = parameter.isPlain && at >= first + 2;
        parameters.push_back(parameter);
        first = at + 1;
    }
    return parameters;
}

// The functions of a text, and the names of those that write arguments or have a prototype.
struct Functions {
    std::vector<Definition> definitions;
    std::set<std::string_view> writing;
    std::set<std::string_view> declared;
};

Functions functionsOf(const GlslTokens& tokens) {
    Functions functions;
    for (std::size_t at = 0; at < tokens.size(); ++at) {
        if (tokens.at(at) == "{") {
            at = tokens.closing(at);
        }
        if (tokens.at(at) != "(" || at < 2 || !tokens.isWord(at - 1) || !tokens.isWord(at - 2)) {
            continue;
        }
        const std::string_view name = tokens.at(at - 1);
        const std::size_t close = tokens.closing(at);
        for (std::size_t i = at + 1; i < close; ++i) {
            if (tokens.at(i) == "out" || tokens.at(i) == "inout") {
                functions.writing.insert(name);
            }
        }
        const std::size_t end = tokens.closing(close + 1);
        if (tokens.at(close + 1) == "{" && end < tokens.size()) {
            functions.definitions.push_back({name, parametersOf(tokens, at, close), close + 1, end});
        } else {
            functions.declared.insert(name);
        }
        at = close;
    }
    return functions;
}

bool mayWrite(std::string_view called, const std::set<std::string_view>& writing) {
    return writing.contains(called) ||
           std::ranges::any_of(kWriting, [&](std::string_view begin) { return called.starts_with(begin); });
}

// Returns whether the tokens from `at` on assign to what is before them.
bool assigns(const GlslTokens& tokens, std::size_t at) {
    const std::string_view sign = tokens.at(at);
    const std::string_view next = tokens.touches(at) ? tokens.at(at + 1) : std::string_view();
    if (sign == "=") {
        return next != "=";
    }
    const bool isShift = (sign == "<" || sign == ">") && next == sign && tokens.touches(at + 1);
    constexpr std::string_view kSigns = "+-*/%&|^";
    return ((sign == "+" || sign == "-") && next == sign) ||
           (!sign.empty() && kSigns.find(sign) != std::string_view::npos && next == "=") ||
           (isShift && tokens.at(at + 2) == "=");
}

// The names among `names` that the body of a function may write, or of which it needs a variable.
std::set<std::string_view> findWritten(const GlslTokens& tokens, const Definition& function,
                                       const std::set<std::string_view>& names,
                                       const std::set<std::string_view>& writing) {
    std::set<std::string_view> written;
    std::vector<bool> open;  // whether an argument within these brackets may be written
    for (std::size_t at = function.body; at < function.end; ++at) {
        const std::string_view token = tokens.at(at);
        if (tokens.opens(at)) {
            open.push_back((!open.empty() && open.back()) ||
                           (tokens.isWord(at - 1) && mayWrite(tokens.at(at - 1), writing)));
        } else if (tokens.closes(at)) {
            open.pop_back();
        }
        if (!names.contains(token) || tokens.at(at - 1) == ".") {
            continue;
        }
        std::size_t next = at + 1;
        bool byVariable = false;
        for (bool isMember = true; isMember;) {
            isMember = tokens.at(next) == "." || tokens.at(next) == "[";
            if (tokens.at(next) == ".") {
                next += 2;
            } else if (tokens.at(next) == "[") {
                byVariable = byVariable || tokens.isWord(next + 1) || tokens.at(next + 2) != "]";
                next = tokens.closing(next) + 1;
            }
        }
        const bool isChangedBefore = (tokens.at(at - 1) == "+" || tokens.at(at - 1) == "-") &&
                                     tokens.at(at - 2) == tokens.at(at - 1) && tokens.touches(at - 2);
        if (open.back() || byVariable || isChangedBefore || assigns(tokens, next)) {
            written.insert(token);
        }
    }
    return written;
}

}  // namespace

std::string withConstParameters(std::string_view glsl, std::span<const std::string> fixed) {
    const GlslTokens tokens(glsl);
    const Functions functions = functionsOf(tokens);
    std::string text;
    const char* copied = glsl.data();
    for (const Definition& function : functions.definitions) {
        if (functions.declared.contains(function.name) ||
            std::ranges::find(fixed, function.name) != fixed.end()) {
            continue;
        }
        std::set<std::string_view> names;
        for (const Parameter& parameter : function.parameters) {
            if (parameter.isPlain) {
                names.insert(parameter.name);
            }
        }
        const std::set<std::string_view> written = findWritten(tokens, function, names, functions.writing);
        for (const Parameter& parameter : function.parameters) {
            if (parameter.isPlain && !written.contains(parameter.name)) {
                const char* const place = tokens.at(parameter.first).data();
                text.append(copied, place);
                text += "const ";
                copied = place;
            }
        }
    }
    text.append(copied, glsl.data() + glsl.size());
    return text;
}

}  // namespace glint::compiler
