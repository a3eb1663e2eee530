#include "emit/glsl/macros.h"

#include "emit/glsl/text.h"

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <utility>

namespace glint::compiler {

namespace {

// Returns the arguments of a macro between the brackets at the start of `text`, and the length with the
// brackets; length 0 if the brackets do not close.
std::pair<std::vector<std::string_view>, std::size_t> argumentsIn(std::string_view text) {
    std::vector<std::string_view> arguments;
    int depth = 0;
    std::size_t begin = 1;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        depth += c == '(' ? 1 : c == ')' ? -1 : 0;
        if (depth == 0 || (depth == 1 && c == ',')) {
            arguments.push_back(trim(text.substr(begin, i - begin)));
            begin = i + 1;
        }
        if (depth == 0) {
            return {std::move(arguments), i + 1};
        }
    }
    return {};
}

// Returns `body` with its parameters replaced and ## removed.
std::string substitute(std::string_view body, const std::vector<std::string>& parameters,
                       const std::vector<std::string>& arguments) {
    std::string text;
    forEachPiece(body, [&](std::string_view piece) {
        const auto place =
            static_cast<std::size_t>(std::ranges::find(parameters, piece) - parameters.begin());
        const bool isParameter = place < parameters.size() && place < arguments.size();
        text += isParameter ? arguments[place] : piece;
    });
    for (std::size_t at = text.find("##"); at != std::string::npos; at = text.find("##", at)) {
        text.erase(at, 2);
    }
    return text;
}

using Value = std::optional<std::uint32_t>;

// Parses and evaluates an expression without macros. What it can't read has no value.
class Evaluator {
public:
    Evaluator(std::string_view text, const std::map<std::string, std::uint32_t, std::less<>>& constants)
        : constants_(constants) {
        forEachPiece(text, [&](std::string_view piece) {
            if (piece.front() != ' ' && piece.front() != '\t' && piece.front() != '\n') {
                tokens_.push_back(piece);
            }
        });
    }
    Value evaluate() {
        const Value value = choice();
        return at_ == tokens_.size() ? value : std::nullopt;
    }

private:
    std::string_view ahead(std::size_t distance = 0) const {
        return at_ + distance < tokens_.size() ? tokens_[at_ + distance] : std::string_view();
    }
    // Returns the operator of one or two characters ahead that is in `level`, or an empty text.
    std::string_view operatorOf(int level) const {
        struct Operator {
            std::string_view name;
            int level;
        };
        static constexpr Operator kOperators[] = {
            {"||", 0}, {"&&", 1}, {"==", 5}, {"!=", 5}, {"<=", 6}, {">=", 6}, {"<<", 7}, {">>", 7}, {"|", 2},
            {"^", 3},  {"&", 4},  {"<", 6},  {">", 6},  {"+", 8},  {"-", 8},  {"*", 9},  {"/", 9},  {"%", 9},
        };
        for (const Operator& one : kOperators) {
            const bool isAhead = ahead() == one.name.substr(0, 1) &&
                                 (one.name.size() == 1 || (ahead(1) == one.name.substr(1) && isJoined()));
            if (isAhead) {
                return one.level == level ? one.name : std::string_view();
            }
        }
        return {};
    }
    // Returns whether the next two tokens touch.
    bool isJoined() const {
        return ahead().data() + 1 == ahead(1).data();
    }
    Value choice() {
        const Value condition = binary(0);
        if (ahead() != "?") {
            return condition;
        }
        ++at_;
        const Value yes = choice();
        if (ahead() != ":") {
            return fail();
        }
        ++at_;
        const Value no = choice();
        return !condition ? std::nullopt : *condition != 0 ? yes : no;
    }
    Value binary(int level) {
        constexpr int kLevels = 10;
        if (level == kLevels) {
            return unary();
        }
        Value left = binary(level + 1);
        for (std::string_view name = operatorOf(level); !name.empty(); name = operatorOf(level)) {
            at_ += name.size();
            left = apply(name, left, binary(level + 1));
        }
        return left;
    }
    static Value apply(std::string_view name, Value left, Value right) {
        if (name == "&&" || name == "||") {
            const std::uint32_t decides = name == "||" ? 1 : 0;
            const auto is = [&](Value side) { return side && (*side != 0 ? 1U : 0U) == decides; };
            return is(left) || is(right) ? Value(decides) : left && right ? Value(1 - decides) : std::nullopt;
        }
        if (name == "&" && (left == Value(0) || right == Value(0))) {
            return 0;
        }
        // Comparisons and divisions depend on the sign.
        constexpr std::uint32_t kSign = 0x80000000U;
        if (!left || !right) {
            return std::nullopt;
        }
        const bool isPlain = ((*left | *right) & kSign) == 0;
        switch (name.front()) {
            case '=':
                return *left == *right ? 1 : 0;
            case '!':
                return *left != *right ? 1 : 0;
            case '|':
                return *left | *right;
            case '^':
                return *left ^ *right;
            case '&':
                return *left & *right;
            case '+':
                return *left + *right;
            case '-':
                return *left - *right;
            case '*':
                return *left * *right;
            case '<':
                return !isPlain || name == "<<" ? std::nullopt
                                                : Value(name == "<" ? *left < *right : *left <= *right);
            case '>':
                return !isPlain || name == ">>" ? std::nullopt
                                                : Value(name == ">" ? *left > *right : *left >= *right);
            default:
                return std::nullopt;
        }
    }
    Value unary() {
        const std::string_view sign = ahead();
        if (sign == "!" || sign == "~" || sign == "-") {
            ++at_;
            const Value value = unary();
            return !value ? std::nullopt
                          : Value(sign == "!"   ? (*value == 0 ? 1 : 0)
                                  : sign == "~" ? ~*value
                                                : 0U - *value);
        }
        return primary();
    }
    Value primary() {
        Value value;
        if (ahead() == "(") {
            ++at_;
            value = choice();
            if (ahead() != ")") {
                return fail();
            }
            ++at_;
        } else if (ahead().empty() || !continuesWord(ahead().front())) {
            return fail();
        } else {
            const std::string_view word = ahead();
            ++at_;
            const auto constant = constants_.find(word);
            value = word == "true"                 ? Value(1)
                    : word == "false"              ? Value(0)
                    : constant != constants_.end() ? Value(constant->second)
                                                   : numberIn(word);
        }
        // Calls, members and elements have no known value.
        while (ahead() == "(" || ahead() == "[" || ahead() == ".") {
            value = std::nullopt;
            if (ahead() == ".") {
                at_ += 2;
            } else {
                skipBrackets();
            }
        }
        return value;
    }
    void skipBrackets() {
        int depth = 0;
        do {
            const char first = ahead().front();
            depth += first == '(' || first == '[' ? 1 : first == ')' || first == ']' ? -1 : 0;
            ++at_;
        } while (depth > 0 && at_ < tokens_.size());
    }
    // Ends the evaluation without a value.
    Value fail() {
        at_ = tokens_.size() + 1;
        return std::nullopt;
    }

    const std::map<std::string, std::uint32_t, std::less<>>& constants_;
    std::vector<std::string_view> tokens_;
    std::size_t at_ = 0;
};

}  // namespace

std::string_view nameIn(std::string_view argument) {
    return argument.substr(0, std::min(argument.find_first_of(" \t("), argument.size()));
}

std::optional<std::uint32_t> numberIn(std::string_view text) {
    if (text.ends_with('u')) {
        text.remove_suffix(1);
    }
    const bool hex = text.starts_with("0x");
    text.remove_prefix(hex ? 2 : 0);
    std::uint32_t value = 0;
    const char* const end = text.data() + text.size();
    const auto parsed = std::from_chars(text.data(), end, value, hex ? 16 : 10);
    return parsed.ec == std::errc() && parsed.ptr == end ? std::optional(value) : std::nullopt;
}

void Macros::define(std::string_view argument) {
    const std::string_view name = nameIn(argument);
    std::string_view rest = argument.substr(name.size());
    Macro macro;
    if (rest.starts_with('(')) {
        const auto [parameters, length] = argumentsIn(rest);
        macro.takesArguments = true;
        macro.parameters.assign(parameters.begin(), parameters.end());
        rest.remove_prefix(length);
    }
    macro.body = trim(rest);
    macros_.insert_or_assign(std::string(name), std::move(macro));
}

void Macros::undefine(std::string_view name) {
    const auto found = macros_.find(name);
    if (found != macros_.end()) {
        macros_.erase(found);
    }
}

void Macros::setConstant(std::string_view name, std::uint32_t value) {
    constants_.insert_or_assign(std::string(name), value);
}

void Macros::expandInto(std::string_view text, std::vector<std::string_view>& active,
                        std::string& result) const {
    while (!text.empty()) {
        const std::string_view piece = takePiece(text);
        const auto found = startsWord(piece.front()) ? macros_.find(piece) : macros_.end();
        const bool isReplaced = found != macros_.end() &&
                                std::ranges::find(active, found->first) == active.end() &&
                                (!found->second.takesArguments || text.starts_with('('));
        if (!isReplaced) {
            result += piece;
            continue;
        }
        std::vector<std::string> arguments;
        if (found->second.takesArguments) {
            const auto [given, whole] = argumentsIn(text);
            for (const std::string_view argument : given) {
                expandInto(argument, active, arguments.emplace_back());
            }
            text.remove_prefix(whole);
        }
        const std::string body = substitute(found->second.body, found->second.parameters, arguments);
        active.push_back(found->first);
        expandInto(body, active, result);
        active.pop_back();
    }
}

std::string Macros::expand(std::string_view text) const {
    std::string result;
    std::vector<std::string_view> active;
    expandInto(text, active, result);
    return result;
}

std::optional<std::uint32_t> Macros::evaluate(std::string_view expression) const {
    return Evaluator(expand(expression), constants_).evaluate();
}

}  // namespace glint::compiler
