#include "verify/gradient.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace glint::verify {
namespace {

// A bound above the roundoff of every format in which gradients are taken, and above the error of the doubles
// here.
constexpr double kRounding = 0x1p-20;

double productOf(double a, double b) {
    return a == 0.0 || b == 0.0 ? 0.0 : a * b;
}

Interval times(const Interval& a, const Interval& b) {
    const double p[] = {productOf(a.low, b.low), productOf(a.low, b.high), productOf(a.high, b.low),
                        productOf(a.high, b.high)};
    return {std::min({p[0], p[1], p[2], p[3]}), std::max({p[0], p[1], p[2], p[3]})};
}

Interval plus(const Interval& a, const Interval& b) {
    const double low = addDown(a.low, b.low);
    const double high = addUp(a.high, b.high);
    return {std::isnan(low) ? -kInfinity : low, std::isnan(high) ? kInfinity : high};
}

// Times 1 ± the rounding.
Interval widened(const Interval& a) {
    return {a.low - std::abs(a.low) * kRounding, a.high + std::abs(a.high) * kRounding};
}

Interval inverse(const Interval& a) {
    if (a.low > 0.0 || a.high < 0.0) {
        return {1.0 / a.high, 1.0 / a.low};
    }
    if (a.low == 0.0 && a.high > 0.0) {
        return {1.0 / a.high, kInfinity};
    }
    return {};
}

Interval negative(const Interval& a) {
    return {-a.high, -a.low};
}

Interval squareRoot(const Interval& a) {
    return {std::sqrt(std::max(a.low, 0.0)), std::sqrt(std::max(a.high, 0.0))};
}

Interval plusOne(const Interval& a, double sign) {
    return sign > 0.0 ? Interval{1.0 + a.low, 1.0 + a.high} : Interval{1.0 - a.high, 1.0 - a.low};
}

Interval squared(const Interval& a) {
    const double least = a.contains(0.0) ? 0.0 : std::min(std::abs(a.low), std::abs(a.high));
    return {least * least, a.magnitude() * a.magnitude()};
}

Interval cosineOf(const Interval& a) {
    Hazard ignored = Hazard::None;
    return Arithmetic(Format::Single).apply(Function::Cos, a, ignored);
}

Interval sineOf(const Interval& a) {
    Hazard ignored = Hazard::None;
    return Arithmetic(Format::Single).apply(Function::Sin, a, ignored);
}

constexpr Interval kOne{1.0, 1.0};

// The derivative of z = function(a).
Interval slopeOf(Function function, const Interval& a, const Interval& z) {
    switch (function) {
        case Function::Sqrt:
            return times({0.5, 0.5}, inverse(z));
        case Function::InverseSqrt:
            return times({-0.5, -0.5}, times(z, inverse(a)));
        case Function::Exp:
            return z;
        case Function::Exp2:
            return times({0.69314718, 0.69314719}, z);
        case Function::Log:
            return inverse(a);
        case Function::Log2:
            return times({1.44269504, 1.44269505}, inverse(a));
        case Function::Sin:
            return cosineOf(a);
        case Function::Cos:
            return negative(sineOf(a));
        case Function::Tan:
            return plusOne(squared(z), 1.0);
        case Function::Atan:
            return inverse(plusOne(squared(a), 1.0));
        case Function::Asin:
            return inverse(squareRoot(plusOne(squared(a), -1.0)));
        case Function::Acos:
            return negative(inverse(squareRoot(plusOne(squared(a), -1.0))));
    }
    return {};
}

// The derivative of an operation z on one operand. Integers and steps have none: they are points, or they
// jump.
std::optional<Interval> slopeOf(const Node& node, const Interval& a, const Interval& z) {
    switch (node.op) {
        case Op::Square:
            return times({2.0, 2.0}, a);
        case Op::Negate:
            return Interval{-1.0, -1.0};
        case Op::Absolute:
            return Interval{a.low >= 0.0 ? 1.0 : -1.0, a.high <= 0.0 ? -1.0 : 1.0};
        case Op::Apply:
            return slopeOf(node.function, a, z);
        case Op::Convert:
            // One rounding of 16 bits exceeds the slack above.
            return node.format == Format::Half ? Interval{1.0 - 0x1p-10, 1.0 + 0x1p-10} : kOne;
        case Op::Refine:
            return kOne;
        case Op::SplitHigh:
            return Interval{1.0 - 0x1p-12, 1.0 + 0x1p-12};
        case Op::SplitLow:
            return Interval{-0x1p-12, 0x1p-12};
        default:
            return std::nullopt;
    }
}

}  // namespace

void GradientEvaluator::give(NodeId to, const Interval& adjoint, const Interval& factor) {
    adjoints_[to] = plus(adjoints_[to], widened(times(adjoint, factor)));
}

bool GradientEvaluator::run(const BoxEvaluator& values, NodeId of, std::size_t inputs) {
    std::fill(adjoints_.begin(), adjoints_.end(), kFalse);
    derivatives_.assign(inputs, kFalse);
    adjoints_[of] = kOne;
    for (NodeId id = of + 1; id-- > 0;) {
        if (adjoints_[id] == kFalse || values.value(id).isPoint()) {
            continue;
        }
        // Where a branch is taken for some inputs only, its extrema need not lie at the ends of the box.
        const NodeId guard = program_.nodes[id].guard;
        if ((guard != kNoNode && !values.value(guard).isTrue()) || !spread(values, id)) {
            return false;
        }
    }
    return true;
}

void GradientEvaluator::spreadExtremum(const Node& node, const Interval& a, const Interval& b,
                                       const Interval& adjoint) {
    const bool isMaximum = node.op == Op::Maximum;
    const bool isA = isMaximum ? a.low >= b.high : a.high <= b.low;
    const bool isB = isMaximum ? b.low >= a.high : b.high <= a.low;
    const Interval either{0.0, 1.0};
    give(node.a, adjoint, isA ? kOne : isB ? kFalse : either);
    give(node.b, adjoint, isA ? kFalse : isB ? kOne : either);
}

bool GradientEvaluator::spreadPower(const Node& node, const Interval& a, const Interval& b, const Interval& z,
                                    const Interval& adjoint) {
    if (a.low <= 0.0) {
        return false;
    }
    give(node.a, adjoint, times(times(b, z), inverse(a)));
    give(node.b, adjoint, times(z, widened({std::log(a.low), std::log(a.high)})));
    return true;
}

bool GradientEvaluator::spreadChoice(const BoxEvaluator& values, const Node& node, const Interval& adjoint) {
    const NodeId only = onlyChoice(values, node);
    if (only != kNoNode) {
        give(only, adjoint, kOne);
    }
    return only != kNoNode;
}

NodeId GradientEvaluator::onlyChoice(const BoxEvaluator& values, const Node& node) const {
    if (node.op == Op::Select) {
        const Interval& condition = values.value(node.a);
        return condition.isTrue() ? node.b : condition.isFalse() ? node.c : kNoNode;
    }
    NodeId only = kNoNode;
    for (std::uint32_t k = 0; k < node.count; ++k) {
        const Edge& edge = program_.edges[node.first + k];
        const Interval guard = edge.guard == kNoNode ? kTrue : values.value(edge.guard);
        if (guard.isFalse() || guard.isEmpty()) {
            continue;
        }
        if (only != kNoNode) {
            return kNoNode;
        }
        only = edge.value;
    }
    return only;
}

bool GradientEvaluator::spread(const BoxEvaluator& values, NodeId id) {
    const Node& node = program_.nodes[id];
    const Interval adjoint = adjoints_[id];
    const Interval& z = values.value(id);
    const auto value = [&](NodeId of) -> const Interval& { return values.value(of); };
    if (isBound(node.op)) {
        const bool isSquare = isRoundedSquare(node);
        give(node.op == Op::CircleSum && !isSquare ? node.c : node.a, adjoint,
             isSquare ? times({2.0, 2.0}, value(node.a)) : kOne);
        return true;
    }
    switch (node.op) {
        case Op::Constant:
            return true;
        case Op::Input: {
            const auto number = static_cast<std::size_t>(node.value);
            if (number < derivatives_.size()) {
                derivatives_[number] = plus(derivatives_[number], adjoint);
            }
            return true;
        }
        case Op::Add:
        case Op::Subtract:
            give(node.a, adjoint, kOne);
            give(node.b, adjoint, node.op == Op::Add ? kOne : Interval{-1.0, -1.0});
            return true;
        case Op::Multiply:
            give(node.a, adjoint, value(node.b));
            give(node.b, adjoint, value(node.a));
            return true;
        case Op::Divide: {
            const Interval over = inverse(value(node.b));
            give(node.a, adjoint, over);
            give(node.b, adjoint, negative(times(z, over)));
            return true;
        }
        case Op::Power:
            return spreadPower(node, value(node.a), value(node.b), z, adjoint);
        case Op::Minimum:
        case Op::Maximum:
            spreadExtremum(node, value(node.a), value(node.b), adjoint);
            return true;
        case Op::Mix:
        case Op::Lerp:
            give(node.a, adjoint, plusOne(value(node.c), -1.0));
            give(node.b, adjoint, value(node.c));
            give(node.c, adjoint, plus(value(node.b), negative(value(node.a))));
            return true;
        case Op::Normalized: {
            const Interval& c = value(node.c);
            if (c.low <= 0.0) {
                return false;
            }
            const Interval over = inverse(times(c, squareRoot(c)));
            give(node.a, adjoint, times(value(node.b), over));
            give(node.b, adjoint, times({-0.5, -0.5}, times(value(node.a), over)));
            return true;
        }
        case Op::ProductError:
            give(node.a, adjoint, times({-0x1p-24, 0x1p-24}, value(node.b)));
            give(node.b, adjoint, times({-0x1p-24, 0x1p-24}, value(node.a)));
            return true;
        case Op::SumError:
            give(node.a, adjoint, {-0x1p-24, 0x1p-24});
            give(node.b, adjoint, {-0x1p-24, 0x1p-24});
            return true;
        case Op::Select:
        case Op::Merge:
            return spreadChoice(values, node, adjoint);
        default:
            break;
    }
    const std::optional<Interval> slope = slopeOf(node, value(node.a), z);
    if (slope) {
        give(node.a, adjoint, *slope);
    }
    return slope.has_value();
}

}  // namespace glint::verify
