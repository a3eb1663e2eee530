// Expressions of material declarations: "metallicFactor == 1", "ior > 1 and not has(volume)". They are parsed
// once and evaluated on intervals. Pure functions.
//
//   condition   a or b, a and b, not a, a == b, a != b, a < b, a <= b, a > b, a >= b
//               flag, enumeration == soft, enumeration != soft
//   number      a + b, a - b, a * b, a / b, -a, 0.5, 1e-6, infinity, name, name.rgb
//               min(a, b), max(a, b), abs(a), sqrt(a), ln(a), exp(a), sin(a), cos(a), select(condition, a, b)
//
// The declarations define the names, and the functions that are not listed here: has(volume). Numbers have
// one to four channels; operations are done for each channel, and one channel serves for all. A comparison
// holds if it holds for every channel, except a != b, which is not (a == b).
#pragma once

#include "materials/interval.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace glint::materials {

// The meaning of a name, or of a function with names for arguments.
struct Symbol {
    int id = 0;
    bool isCondition = false;
    int channels = 1;  // of a number
    // A number that counts these names is compared with one of them, and with nothing else. One that counts
    // "false" and "true" is a condition without a comparison.
    std::vector<std::string> names{};
    bool isTruth = false;
    std::string refusal{};  // why no expression may name it; empty: each may
};

// Returns the symbol, or no value if there is none. `function` is empty for a plain name, which is then the
// only element of `names`.
using SymbolResolver = std::function<std::optional<Symbol>(std::string_view function,
                                                           const std::vector<std::string_view>& names)>;

// Gives the values of symbols.
class Facts {
public:
    Facts() = default;
    Facts(const Facts&) = delete;
    Facts& operator=(const Facts&) = delete;
    virtual ~Facts() = default;
    virtual Channels number(int symbol) const = 0;
    virtual Certainty condition(int symbol) const = 0;
};

struct ExpressionError {
    std::size_t offset = 0;  // into the text, in bytes
    std::string message;
};

class Expression {
public:
    // Returns no value and fills `error` if the text is no expression.
    static std::optional<Expression> parse(std::string_view text, const SymbolResolver& resolve,
                                           ExpressionError& error);

    bool isCondition() const;
    // Requires a condition.
    Certainty holds(const Facts& facts) const;
    // Requires a number.
    Channels number(const Facts& facts) const;
    // The number of channels that number() returns.
    int channels() const;
    // Returns the channels of the symbol that the expression reads: bit 0 for red, to bit 3 for alpha.
    std::uint32_t channelsOf(int symbol) const;
    // The symbols that occur, in the order of the text.
    const std::vector<int>& symbols() const {
        return symbols_;
    }

    enum class Operation : std::uint8_t {
        Constant,
        Name,
        Swizzle,
        Add,
        Subtract,
        Multiply,
        Divide,
        Minimum,
        Maximum,
        Absolute,
        SquareRoot,
        Logarithm,
        Exponential,
        Sine,
        Cosine,
        Select,
        Equal,
        Different,
        Less,
        AtMost,
        And,
        Or,
        Not,
    };

private:
    friend class ExpressionParser;

    // A node's operands stand before it; the last node is the whole.
    struct Node {
        Operation operation = Operation::Constant;
        bool isCondition = false;
        int channels = 1;
        int operands[3] = {-1, -1, -1};
        int symbol = 0;
        double value = 0.0;
        int swizzle[4] = {0, 0, 0, 0};
    };

    Channels numberOf(int node, const Facts& facts) const;
    Certainty truthOf(int node, const Facts& facts) const;

    std::vector<Node> nodes_;
    std::vector<int> symbols_;
};

}  // namespace glint::materials
