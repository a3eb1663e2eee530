#include "materials/expression.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <iterator>
#include <map>
#include <utility>

namespace glint::materials {

namespace {

using Operation = Expression::Operation;

struct Function {
    std::string_view name;
    Operation operation;
    int arguments;
};

constexpr Function kFunctions[] = {
    {"min", Operation::Minimum, 2},     {"max", Operation::Maximum, 2},  {"abs", Operation::Absolute, 1},
    {"sqrt", Operation::SquareRoot, 1}, {"ln", Operation::Logarithm, 1}, {"exp", Operation::Exponential, 1},
    {"sin", Operation::Sine, 1},        {"cos", Operation::Cosine, 1},   {"select", Operation::Select, 3},
};

constexpr std::string_view kWords[] = {"and", "or", "not", "infinity"};
constexpr std::string_view kChannelNames = "rgba";

bool isLetter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

bool isDigit(char c) {
    return c >= '0' && c <= '9';
}

ValueInterval apply(Operation operation, ValueInterval a, ValueInterval b) {
    switch (operation) {
        case Operation::Add:
            return add(a, b);
        case Operation::Subtract:
            return subtract(a, b);
        case Operation::Multiply:
            return multiply(a, b);
        case Operation::Divide:
            return divide(a, b);
        case Operation::Minimum:
            return minimum(a, b);
        case Operation::Maximum:
            return maximum(a, b);
        case Operation::Absolute:
            return absolute(a);
        case Operation::SquareRoot:
            return squareRoot(a);
        case Operation::Logarithm:
            return logarithm(a);
        case Operation::Exponential:
            return exponential(a);
        case Operation::Sine:
            return sine(a);
        case Operation::Cosine:
            return cosine(a);
        default:
            return kAnything;
    }
}

Certainty compare(Operation operation, ValueInterval a, ValueInterval b) {
    switch (operation) {
        case Operation::Less:
            return isLess(a, b);
        case Operation::AtMost:
            return isAtMost(a, b);
        default:
            return isEqual(a, b);
    }
}

ValueInterval channelOf(const Channels& number, int channel) {
    return number.of[static_cast<std::size_t>(number.count == 1 ? 0 : channel)];
}

}  // namespace

// A recursive-descent parser. It appends nodes as it goes, and stops at the first error.
class ExpressionParser {
public:
    ExpressionParser(std::string_view text, const SymbolResolver& resolve, ExpressionError& error)
        : text_(text), resolve_(resolve), error_(error) {}

    std::optional<Expression> parse() {
        const int whole = alternatives();
        skipSpaces();
        if (whole >= 0 && place_ < text_.size()) {
            fail(fmt::format("expected the end, found \"{}\"", text_.substr(place_, 12)));
        }
        return failed_ ? std::nullopt : std::optional(std::move(made_));
    }

private:
    using Node = Expression::Node;

    // Deeper nesting could overflow the stack.
    static constexpr int kMaxDepth = 64;

    int fail(std::string message) {
        if (!failed_) {
            error_ = {place_, std::move(message)};
            failed_ = true;
        }
        return -1;
    }

    void skipSpaces() {
        while (place_ < text_.size() && (text_[place_] == ' ' || text_[place_] == '\n')) {
            ++place_;
        }
    }

    // Returns the name that starts here, without consuming it.
    std::string_view peekName() {
        skipSpaces();
        std::size_t end = place_;
        while (end < text_.size() && (isLetter(text_[end]) || (end > place_ && isDigit(text_[end])))) {
            ++end;
        }
        return text_.substr(place_, end - place_);
    }

    bool take(std::string_view token) {
        skipSpaces();
        if (!text_.substr(place_).starts_with(token)) {
            return false;
        }
        place_ += token.size();
        return true;
    }

    bool takeWord(std::string_view word) {
        if (peekName() != word) {
            return false;
        }
        place_ += word.size();
        return true;
    }

    int append(Node node) {
        made_.nodes_.push_back(node);
        return static_cast<int>(made_.nodes_.size()) - 1;
    }

    const Node& at(int node) const {
        return made_.nodes_[static_cast<std::size_t>(node)];
    }

    // Checks that all operands are conditions, or all of them numbers. Returns false after an error.
    bool accept(std::initializer_list<int> operands, bool conditions) {
        for (const int operand : operands) {
            if (operand < 0) {
                return false;
            }
            if (const auto named = named_.find(operand); named != named_.end()) {
                fail(fmt::format("a value with names is compared by == or != with one of {}",
                                 fmt::join(named->second.names, ", ")));
                return false;
            }
            if (at(operand).isCondition != conditions) {
                fail(conditions ? "expected a condition, found a number"
                                : "expected a number, found a condition");
                return false;
            }
        }
        return true;
    }

    int combineConditions(Operation operation, int a, int b) {
        return accept({a, b}, true) ? append({operation, true, 1, {a, b, -1}}) : -1;
    }

    int combineNumbers(Operation operation, int a, int b) {
        if (!accept({a, b}, false)) {
            return -1;
        }
        const int channels = std::max(at(a).channels, at(b).channels);
        if (std::min(at(a).channels, at(b).channels) != 1 && at(a).channels != at(b).channels) {
            return fail(
                fmt::format("one side has {} channels, the other {}", at(a).channels, at(b).channels));
        }
        const bool isComparison = operation == Operation::Equal || operation == Operation::Different ||
                                  operation == Operation::Less || operation == Operation::AtMost;
        return append({operation, isComparison, isComparison ? 1 : channels, {a, b, -1}});
    }

    int alternatives() {
        int left = conjunction();
        while (left >= 0 && takeWord("or")) {
            left = combineConditions(Operation::Or, left, conjunction());
        }
        return left;
    }

    int conjunction() {
        int left = negation();
        while (left >= 0 && takeWord("and")) {
            left = combineConditions(Operation::And, left, negation());
        }
        return left;
    }

    int negation() {
        if (!takeWord("not")) {
            return comparison();
        }
        if (++depth_ > kMaxDepth) {
            return fail("the expression is nested too deep");
        }
        const int operand = negation();
        --depth_;
        return accept({operand}, true) ? append({Operation::Not, true, 1, {operand, -1, -1}}) : -1;
    }

    int comparison() {
        const int left = sum();
        if (left < 0) {
            return left;
        }
        if (const auto named = named_.find(left); named != named_.end()) {
            return comparisonOfNames(left, named->second);
        }
        constexpr struct {
            std::string_view token;
            Operation operation;
            bool swaps;
        } kComparisons[] = {
            {"==", Operation::Equal, false},  {"!=", Operation::Different, false},
            {"<=", Operation::AtMost, false}, {">=", Operation::AtMost, true},
            {"<", Operation::Less, false},    {">", Operation::Less, true},
        };
        for (const auto& row : kComparisons) {
            if (take(row.token)) {
                const int right = sum();
                return row.swaps ? combineNumbers(row.operation, right, left)
                                 : combineNumbers(row.operation, left, right);
            }
        }
        return left;
    }

    // The value of a number whose values have names, which is the left operand.
    int comparisonOfNames(int left, const Symbol& symbol) {
        const bool isDifferent = take("!=");
        Node value;
        if (isDifferent || take("==")) {
            const std::string_view name = peekName();
            const auto found = std::ranges::find(symbol.names, name);
            if (found == symbol.names.end()) {
                return fail(fmt::format("\"{}\" is none of {}", name, fmt::join(symbol.names, ", ")));
            }
            place_ += name.size();
            value.value = static_cast<double>(found - symbol.names.begin());
        } else if (symbol.isTruth) {
            value.value = 1.0;
        } else {
            accept({left}, false);
            return -1;
        }
        return append(
            {isDifferent ? Operation::Different : Operation::Equal, true, 1, {left, append(value), -1}});
    }

    int sum() {
        return chain(&ExpressionParser::product, "+", Operation::Add, "-", Operation::Subtract);
    }

    int product() {
        return chain(&ExpressionParser::factor, "*", Operation::Multiply, "/", Operation::Divide);
    }

    // Reads operands that one of two operations joins, from left to right.
    int chain(int (ExpressionParser::*operand)(), const char* one, Operation first, const char* other,
              Operation second) {
        int left = (this->*operand)();
        while (left >= 0) {
            const bool isFirst = take(one);
            if (!isFirst && !take(other)) {
                break;
            }
            left = combineNumbers(isFirst ? first : second, left, (this->*operand)());
        }
        return left;
    }

    int factor() {
        if (++depth_ > kMaxDepth) {
            return fail("the expression is nested too deep");
        }
        int node = -1;
        if (take("-")) {
            const int zero = append({});
            node = combineNumbers(Operation::Subtract, zero, factor());
        } else {
            node = swizzled(primary());
        }
        --depth_;
        return node;
    }

    int swizzled(int node) {
        if (node < 0 || at(node).isCondition || named_.contains(node) || !take(".")) {
            return node;
        }
        const std::string_view name = peekName();
        Node swizzle{Operation::Swizzle, false, static_cast<int>(name.size()), {node, -1, -1}};
        if (name.empty() || name.size() > 4) {
            return fail("expected one to four of the channels r, g, b, a");
        }
        for (std::size_t i = 0; i < name.size(); ++i) {
            const std::size_t channel = kChannelNames.find(name[i]);
            if (channel == std::string_view::npos || static_cast<int>(channel) >= at(node).channels) {
                return fail(fmt::format("there is no channel \"{}\"", name.substr(i, 1)));
            }
            swizzle.swizzle[i] = static_cast<int>(channel);
        }
        place_ += name.size();
        return append(swizzle);
    }

    int primary() {
        skipSpaces();
        if (place_ < text_.size() && (isDigit(text_[place_]) || text_[place_] == '.')) {
            return constant();
        }
        if (take("(")) {
            const int inner = alternatives();
            return inner < 0 || take(")") ? inner : fail("expected \")\"");
        }
        const std::string_view name = peekName();
        if (name.empty()) {
            return fail("expected a number, a name or a condition");
        }
        if (name == "infinity") {
            place_ += name.size();
            Node node;
            node.value = kUnlimited;
            return append(node);
        }
        if (std::ranges::find(kWords, name) != std::end(kWords)) {
            return fail(fmt::format("\"{}\" cannot stand here", name));
        }
        const std::size_t start = place_;
        place_ += name.size();
        if (!take("(")) {
            return symbol(start, {}, {name});
        }
        const auto* const function = std::ranges::find(kFunctions, name, &Function::name);
        return function == std::end(kFunctions) ? symbolCall(start, name) : call(*function);
    }

    int constant() {
        Node node;
        const char* const begin = text_.data() + place_;
        const auto [end, failure] = std::from_chars(begin, text_.data() + text_.size(), node.value);
        if (failure != std::errc()) {
            return fail("the number is malformed, or too large");
        }
        place_ += static_cast<std::size_t>(end - begin);
        return append(node);
    }

    int call(const Function& function) {
        Node node{function.operation, false, 1, {-1, -1, -1}};
        for (int i = 0; i < function.arguments; ++i) {
            if (i > 0 && !take(",")) {
                return fail(fmt::format("{} takes {} arguments", function.name, function.arguments));
            }
            const int argument = alternatives();
            const bool isCondition = function.operation == Operation::Select && i == 0;
            if (!accept({argument}, isCondition)) {
                return -1;
            }
            node.operands[i] = argument;
            if (!isCondition) {
                const int channels = at(argument).channels;
                if (channels != 1 && node.channels != 1 && channels != node.channels) {
                    return fail("the arguments have different numbers of channels");
                }
                node.channels = std::max(node.channels, channels);
            }
        }
        return take(")") ? append(node) : fail("expected \")\"");
    }

    int symbolCall(std::size_t start, std::string_view function) {
        std::vector<std::string_view> names;
        do {
            const std::string_view name = peekName();
            if (name.empty()) {
                return fail("expected a name");
            }
            names.push_back(name);
            place_ += name.size();
        } while (take(","));
        return take(")") ? symbol(start, function, names) : fail("expected \")\"");
    }

    int symbol(std::size_t start, std::string_view function, const std::vector<std::string_view>& names) {
        const std::optional<Symbol> found = resolve_(function, names);
        if (!found) {
            place_ = start;
            return fail(
                fmt::format("there is no \"{}\"", text_.substr(start, endOf(start, function.empty()))));
        }
        if (!found->refusal.empty()) {
            place_ = start;
            return fail(found->refusal);
        }
        Node node{Operation::Name, found->isCondition, found->channels, {-1, -1, -1}};
        node.symbol = found->id;
        made_.symbols_.push_back(found->id);
        const int index = append(node);
        if (!found->names.empty()) {
            named_.emplace(index, *found);
        }
        return index;
    }

    // Returns the length of the name or call that starts at `start`.
    std::size_t endOf(std::size_t start, bool isName) const {
        std::size_t end = start;
        while (end < text_.size() && (isLetter(text_[end]) || isDigit(text_[end]))) {
            ++end;
        }
        return isName ? end - start : text_.find(')', end) + 1 - start;
    }

    std::string_view text_;
    const SymbolResolver& resolve_;
    ExpressionError& error_;
    std::size_t place_ = 0;
    int depth_ = 0;
    bool failed_ = false;
    std::map<int, Symbol> named_;  // the nodes whose values have names
    Expression made_;
};

std::optional<Expression> Expression::parse(std::string_view text, const SymbolResolver& resolve,
                                            ExpressionError& error) {
    return ExpressionParser(text, resolve, error).parse();
}

bool Expression::isCondition() const {
    return nodes_.back().isCondition;
}

int Expression::channels() const {
    return nodes_.back().channels;
}

std::uint32_t Expression::channelsOf(int symbol) const {
    std::uint32_t channels = 0;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        if (nodes_[i].operation != Operation::Name || nodes_[i].symbol != symbol) {
            continue;
        }
        bool isOperand = false;
        for (const Node& node : nodes_) {
            if (std::ranges::find(node.operands, static_cast<int>(i)) == std::end(node.operands)) {
                continue;
            }
            isOperand = true;
            for (int channel = 0; channel < node.channels && node.operation == Operation::Swizzle;
                 ++channel) {
                channels |= 1U << static_cast<unsigned>(node.swizzle[channel]);
            }
            channels |= node.operation == Operation::Swizzle ? 0U : 15U;
        }
        channels |= isOperand ? 0U : 15U;
    }
    return channels;
}

Certainty Expression::holds(const Facts& facts) const {
    assert(isCondition());
    return truthOf(static_cast<int>(nodes_.size()) - 1, facts);
}

Channels Expression::number(const Facts& facts) const {
    assert(!isCondition());
    return numberOf(static_cast<int>(nodes_.size()) - 1, facts);
}

Channels Expression::numberOf(int index, const Facts& facts) const {
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    switch (node.operation) {
        case Operation::Constant:
            return exactly(node.value);
        case Operation::Name:
            return facts.number(node.symbol);
        default:
            break;
    }
    Channels result;
    result.count = node.channels;
    if (node.operation == Operation::Swizzle) {
        const Channels operand = numberOf(node.operands[0], facts);
        for (int i = 0; i < node.channels; ++i) {
            result.of[static_cast<std::size_t>(i)] = operand.of[static_cast<std::size_t>(node.swizzle[i])];
        }
        return result;
    }
    const bool selects = node.operation == Operation::Select;
    const Certainty chosen = selects ? truthOf(node.operands[0], facts) : Certainty::Unknown;
    const Channels a = numberOf(node.operands[selects ? 1 : 0], facts);
    const int second = node.operands[selects ? 2 : 1];
    const Channels b = second < 0 ? a : numberOf(second, facts);
    for (int i = 0; i < node.channels; ++i) {
        const ValueInterval left = channelOf(a, i);
        const ValueInterval right = channelOf(b, i);
        ValueInterval& target = result.of[static_cast<std::size_t>(i)];
        if (selects) {
            target = chosen == Certainty::True    ? left
                     : chosen == Certainty::False ? right
                                                  : hull(left, right);
        } else {
            target = apply(node.operation, left, right);
        }
    }
    return result;
}

Certainty Expression::truthOf(int index, const Facts& facts) const {
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    switch (node.operation) {
        case Operation::Name:
            return facts.condition(node.symbol);
        case Operation::Not:
            return !truthOf(node.operands[0], facts);
        case Operation::And:
            return truthOf(node.operands[0], facts) && truthOf(node.operands[1], facts);
        case Operation::Or:
            return truthOf(node.operands[0], facts) || truthOf(node.operands[1], facts);
        default:
            break;
    }
    const Channels a = numberOf(node.operands[0], facts);
    const Channels b = numberOf(node.operands[1], facts);
    Certainty all = Certainty::True;
    for (int i = 0; i < std::max(a.count, b.count); ++i) {
        all = all && compare(node.operation, channelOf(a, i), channelOf(b, i));
    }
    return node.operation == Operation::Different ? !all : all;
}

}  // namespace glint::materials
