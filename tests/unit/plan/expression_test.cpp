// Tests conditions on intervals: against plain arithmetic at every value of small intervals, and what they
// refuse.
#include "materials/expression.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace {

using namespace glint;

// The symbols a, b (numbers), c (three channels), p, q (conditions), and has(p).
std::optional<materials::Symbol> resolve(std::string_view function,
                                         const std::vector<std::string_view>& names) {
    if (function == "has" && names.size() == 1 && names[0] == "p") {
        return materials::Symbol{3, true, 1};
    }
    if (!function.empty()) {
        return std::nullopt;
    }
    if (names[0] == "a" || names[0] == "b") {
        return materials::Symbol{names[0] == "a" ? 0 : 1, false, 1};
    }
    if (names[0] == "c") {
        return materials::Symbol{2, false, 3};
    }
    if (names[0] == "p" || names[0] == "q") {
        return materials::Symbol{names[0] == "p" ? 3 : 4, true, 1};
    }
    return std::nullopt;
}

class GivenFacts final : public materials::Facts {
public:
    std::array<materials::ValueInterval, 2> numbers{};
    materials::Channels color{{}, 3};
    std::array<materials::Certainty, 2> conditions{};

    materials::Channels number(int symbol) const override {
        return symbol == 2 ? color : materials::Channels{{numbers[static_cast<std::size_t>(symbol)]}, 1};
    }
    materials::Certainty condition(int symbol) const override {
        return conditions[static_cast<std::size_t>(symbol - 3)];
    }
};

materials::Expression expressionOf(const std::string& text) {
    materials::ExpressionError error;
    std::optional<materials::Expression> expression = materials::Expression::parse(text, resolve, error);
    EXPECT_TRUE(expression) << text << ": " << error.message;
    return expression ? *expression : *materials::Expression::parse("0 == 0", resolve, error);
}

std::string refusal(const std::string& text) {
    materials::ExpressionError error;
    EXPECT_FALSE(materials::Expression::parse(text, resolve, error)) << text;
    return fmt::format("{}: {}", error.offset, error.message);
}

double exactValue(const std::string& text, double a = 0.0, double b = 0.0) {
    GivenFacts facts;
    facts.numbers = {materials::ValueInterval{a, a}, materials::ValueInterval{b, b}};
    const materials::Channels number = expressionOf(text).number(facts);
    EXPECT_TRUE(number.of[0].isExact()) << text;
    return number.of[0].low;
}

TEST(Expression, ComputesAsDoubleArithmeticDoes) {
    EXPECT_EQ(exactValue("1 + 2 * 3"), 7.0);
    EXPECT_EQ(exactValue("(1 + 2) * 3"), 9.0);
    EXPECT_EQ(exactValue("7 - 2 - 1"), 4.0);
    EXPECT_EQ(exactValue("8 / 2 / 2"), 2.0);
    EXPECT_EQ(exactValue("-a * b", 2.0, 3.0), -6.0);
    EXPECT_EQ(exactValue("1e-6 + .5"), 1e-6 + 0.5);
    EXPECT_EQ(exactValue("min(a, b) + max(a, b) * 10", 2.0, 3.0), 32.0);
    EXPECT_EQ(exactValue("ln(a) + exp(b)", 0.3, 0.7), std::log(0.3) + std::exp(0.7));
    EXPECT_EQ(exactValue("sin(a) * cos(b)", 0.3, 0.7), std::sin(0.3) * std::cos(0.7));
    EXPECT_EQ(exactValue("sqrt(abs(a))", -4.0), 2.0);
    EXPECT_EQ(exactValue("select(a < b, a, b)", 2.0, 3.0), 2.0);
    EXPECT_EQ(exactValue("min(-ln(a), 1e18)", 0.0), 1e18);
}

TEST(Expression, ChannelsAreDoneOneByOne) {
    GivenFacts facts;
    facts.color = {{materials::ValueInterval{0.0, 0.0}, {0.5, 0.5}, {1.0, 1.0}}, 3};
    facts.numbers[0] = {2.0, 2.0};
    const materials::Channels product = expressionOf("c * a + 1").number(facts);
    ASSERT_EQ(product.count, 3);
    EXPECT_EQ(product.of[1].low, 2.0);
    EXPECT_EQ(expressionOf("c.gb").number(facts).of[1].low, 1.0);
    // A comparison holds if it holds for every channel; a != b is not (a == b).
    EXPECT_EQ(expressionOf("c >= 0").holds(facts), materials::Certainty::True);
    EXPECT_EQ(expressionOf("c > 0").holds(facts), materials::Certainty::False);
    EXPECT_EQ(expressionOf("c == 0").holds(facts), materials::Certainty::False);
    EXPECT_EQ(expressionOf("c != 0").holds(facts), materials::Certainty::True);
    EXPECT_EQ(expressionOf("c.r == 0").holds(facts), materials::Certainty::True);
}

// All three values of two conditions.
TEST(Expression, ConditionsHaveThreeValues) {
    const materials::Certainty all[] = {materials::Certainty::False, materials::Certainty::True,
                                        materials::Certainty::Unknown};
    for (const materials::Certainty p : all) {
        for (const materials::Certainty q : all) {
            GivenFacts facts;
            facts.conditions = {p, q};
            const auto isIn = [](materials::Certainty certainty, bool value) {
                return certainty == materials::Certainty::Unknown || certainty == materials::certain(value);
            };
            // A result is certain exactly if it is the same for all values that the operands can have.
            for (const char* const operation : {"and", "or"}) {
                bool canHold = false;
                bool canFail = false;
                for (const bool x : {false, true}) {
                    for (const bool y : {false, true}) {
                        if (isIn(p, x) && isIn(q, y)) {
                            const bool value = std::string(operation) == "and" ? x && y : x || y;
                            canHold = canHold || value;
                            canFail = canFail || !value;
                        }
                    }
                }
                const materials::Certainty expected =
                    canHold && canFail ? materials::Certainty::Unknown : materials::certain(canHold);
                EXPECT_EQ(expressionOf(fmt::format("p {} q", operation)).holds(facts), expected);
                EXPECT_EQ(expressionOf(fmt::format("not (p {} q)", operation)).holds(facts), !expected);
            }
            EXPECT_EQ(expressionOf("has(p)").holds(facts), p);
        }
    }
}

// What holds for an interval holds for each of its values: small grids, every operation, every comparison.
TEST(Expression, IntervalsContainEveryValue) {
    const char* const numbers[] = {"a + b",
                                   "a - b",
                                   "a * b",
                                   "a / b",
                                   "min(a, b)",
                                   "max(a, b)",
                                   "abs(a)",
                                   "sqrt(a)",
                                   "ln(a)",
                                   "exp(a)",
                                   "sin(a)",
                                   "cos(b)",
                                   "select(a < b, a, 2 * b)",
                                   "a * a - b",
                                   "1 - a * b",
                                   "-a"};
    const char* const comparisons[] = {"a == b", "a != b", "a < b",     "a <= b",
                                       "a > b",  "a >= b", "a * b == 0"};
    const double grid[] = {-2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 3.0};
    const auto forEachInterval = [&](const auto& use) {
        for (const double low : grid) {
            for (const double high : grid) {
                if (low <= high) {
                    use(materials::ValueInterval{low, high});
                }
            }
        }
    };
    for (const char* const text : numbers) {
        const materials::Expression expression = expressionOf(text);
        forEachInterval([&](materials::ValueInterval a) {
            forEachInterval([&](materials::ValueInterval b) {
                GivenFacts facts;
                facts.numbers = {a, b};
                const materials::ValueInterval whole = expression.number(facts).of[0];
                ASSERT_LE(whole.low, whole.high) << text;
                for (const double x : grid) {
                    for (const double y : grid) {
                        if (x < a.low || x > a.high || y < b.low || y > b.high) {
                            continue;
                        }
                        facts.numbers = {materials::ValueInterval{x, x}, materials::ValueInterval{y, y}};
                        const materials::ValueInterval part = expression.number(facts).of[0];
                        ASSERT_LE(whole.low, part.low) << text << " at " << x << ", " << y;
                        ASSERT_GE(whole.high, part.high) << text << " at " << x << ", " << y;
                    }
                }
            });
        });
    }
    for (const char* const text : comparisons) {
        const materials::Expression expression = expressionOf(text);
        forEachInterval([&](materials::ValueInterval a) {
            forEachInterval([&](materials::ValueInterval b) {
                GivenFacts facts;
                facts.numbers = {a, b};
                const materials::Certainty whole = expression.holds(facts);
                for (const double x : {a.low, a.high}) {
                    for (const double y : {b.low, b.high}) {
                        facts.numbers = {materials::ValueInterval{x, x}, materials::ValueInterval{y, y}};
                        const materials::Certainty part = expression.holds(facts);
                        ASSERT_TRUE(whole == materials::Certainty::Unknown || whole == part)
                            << text << " at " << x << ", " << y;
                    }
                }
            });
        });
    }
}

TEST(Expression, WhatHasNoValueIsUnknown) {
    GivenFacts facts;
    facts.numbers = {materials::ValueInterval{-1.0, -1.0}, materials::ValueInterval{0.0, 0.0}};
    for (const char* const text :
         {"1 / b == 1", "b / b == 1", "sqrt(a) > 0", "ln(a) < 0", "infinity - infinity == 0"}) {
        EXPECT_EQ(expressionOf(text).holds(facts), materials::Certainty::Unknown) << text;
    }
    EXPECT_EQ(expressionOf("b * infinity == 0").holds(facts), materials::Certainty::True);
}

TEST(Expression, SaysWhatItRefusesAndWhere) {
    EXPECT_EQ(refusal(""), "0: expected a number, a name or a condition");
    EXPECT_EQ(refusal("a +"), "3: expected a number, a name or a condition");
    EXPECT_EQ(refusal("a b"), "2: expected the end, found \"b\"");
    EXPECT_EQ(refusal("1 + colour"), "4: there is no \"colour\"");
    EXPECT_EQ(refusal("has(colour)"), "0: there is no \"has(colour)\"");
    EXPECT_EQ(refusal("p + 1"), "5: expected a number, found a condition");
    EXPECT_EQ(refusal("a and p"), "7: expected a condition, found a number");
    EXPECT_EQ(refusal("not"), "3: expected a number, a name or a condition");
    EXPECT_EQ(refusal("(a"), "2: expected \")\"");
    EXPECT_EQ(refusal("min(a)"), "5: min takes 2 arguments");
    EXPECT_EQ(refusal("c.a"), "2: there is no channel \"a\"");
    EXPECT_EQ(refusal("c == c.rg"), "9: one side has 3 channels, the other 2");
    EXPECT_EQ(refusal("1e999 == a"), "0: the number is malformed, or too large");
    EXPECT_EQ(refusal("and"), "0: \"and\" cannot stand here");
    EXPECT_NE(refusal(std::string(1000, '(')).find("nested too deep"), std::string::npos);
    EXPECT_NE(refusal(std::string(1000, '-') + "1").find("nested too deep"), std::string::npos);
}

// Random texts of the language's own words: each is refused, or evaluates.
TEST(Expression, AnyTextIsRefusedOrEvaluates) {
    const char* const words[] = {"a",   "b",  "c",   "p",    "q",       "1",  "0.5", "infinity", "+",  "-",
                                 "*",   "/",  "(",   ")",    "==",      "!=", "<",   "<=",       ">",  ">=",
                                 "and", "or", "not", "min(", "select(", ",",  ".r",  "has(",     "ln("};
    std::mt19937 random(7);
    int accepted = 0;
    for (int i = 0; i < 200000; ++i) {
        std::string text;
        for (std::uint32_t count = 1 + random() % 8; count > 0; --count) {
            text += words[random() % std::size(words)];
            text += ' ';
        }
        materials::ExpressionError error;
        const std::optional<materials::Expression> expression =
            materials::Expression::parse(text, resolve, error);
        ASSERT_EQ(expression.has_value(), error.message.empty()) << text;
        if (!expression) {
            ASSERT_LE(error.offset, text.size()) << text;
            continue;
        }
        ++accepted;
        GivenFacts facts;
        facts.numbers = {materials::ValueInterval{0.0, 1.0}, materials::ValueInterval{-1.0, 2.0}};
        if (expression->isCondition()) {
            expression->holds(facts);
        } else {
            const materials::Channels number = expression->number(facts);
            for (int channel = 0; channel < number.count; ++channel) {
                const materials::ValueInterval interval = number.of[static_cast<std::size_t>(channel)];
                ASSERT_LE(interval.low, interval.high) << text;
            }
        }
    }
    EXPECT_GT(accepted, 1000);
}

}  // namespace
