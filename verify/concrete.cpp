#include "verify/concrete.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace glint::verify {
namespace {

double toFormat(double value, Format format) {
    if (format == Format::Single) {
        return static_cast<double>(static_cast<float>(value));
    }
    if (format == Format::Half && std::isfinite(value)) {
        const int exponent = value == 0.0 ? -14 : std::max(std::ilogb(value), -14);
        const double step = std::ldexp(1.0, exponent - 10);
        const double rounded = std::nearbyint(value / step) * step;
        return std::abs(rounded) > kLargestHalf ? std::copysign(kInfinity, rounded) : rounded;
    }
    return value;
}

double applySingle(Function function, float a) {
    switch (function) {
        case Function::Sqrt:
            return std::sqrt(a);
        case Function::InverseSqrt:
            return 1.0F / std::sqrt(a);
        case Function::Exp:
            return std::exp(a);
        case Function::Exp2:
            return std::exp2(a);
        case Function::Log:
            return std::log(a);
        case Function::Log2:
            return std::log2(a);
        case Function::Sin:
            return std::sin(a);
        case Function::Cos:
            return std::cos(a);
        case Function::Tan:
            return std::tan(a);
        case Function::Asin:
            return std::asin(a);
        case Function::Acos:
            return std::acos(a);
        case Function::Atan:
            return std::atan(a);
    }
    return 0.0;
}

std::uint32_t reverseBits(std::uint32_t bits) {
    std::uint32_t result = 0;
    for (int i = 0; i < 32; ++i) {
        result = result << 1U | (bits >> static_cast<unsigned>(i) & 1U);
    }
    return result;
}

double asInteger(std::uint32_t bits, bool isSigned) {
    return isSigned ? static_cast<double>(static_cast<std::int32_t>(bits)) : static_cast<double>(bits);
}

std::uint32_t bitsOf(double value) {
    return static_cast<std::uint32_t>(static_cast<std::int64_t>(value));
}

double evaluateInteger(const Node& node, double a, double b) {
    const std::uint32_t x = bitsOf(a);
    const std::uint32_t y = bitsOf(b);
    switch (node.op) {
        case Op::IntegerAdd:
            return asInteger(x + y, node.isSigned);
        case Op::IntegerSubtract:
            return asInteger(x - y, node.isSigned);
        case Op::IntegerMultiply:
            return asInteger(x * y, node.isSigned);
        case Op::IntegerDivide:
            return b == 0.0 ? 0.0 : std::trunc(a / b);
        case Op::IntegerRemainder:
            return b == 0.0 ? 0.0 : std::fmod(a, b);
        case Op::BitAnd:
            return asInteger(x & y, node.isSigned);
        case Op::BitOr:
            return asInteger(x | y, node.isSigned);
        case Op::BitXor:
            return asInteger(x ^ y, node.isSigned);
        case Op::BitNot:
            return asInteger(~x, node.isSigned);
        case Op::ShiftLeft:
            return asInteger(y > 31U ? 0U : x << y, node.isSigned);
        case Op::ShiftRight:
            return node.isSigned ? static_cast<double>(static_cast<std::int32_t>(x) >> (y & 31U))
                                 : static_cast<double>(y > 31U ? 0U : x >> y);
        case Op::BitReverse:
            return asInteger(reverseBits(x), node.isSigned);
        case Op::FromInteger:
            return toFormat(a, node.format);
        case Op::OfBits:
            return std::bit_cast<float>(x);
        case Op::ChangeSign:
            return asInteger(x, node.isSigned);
        default:
            return 0.0;
    }
}

double splitHigh(double a) {
    const auto x = static_cast<float>(a);
    const float big = 4097.0F * x;
    return big - (big - x);
}

double sumError(double a, double b, Format format) {
    const double sum = toFormat(a + b, format);
    const double part = toFormat(sum - a, format);
    return toFormat(toFormat(a - toFormat(sum - part, format), format) + toFormat(b - part, format), format);
}

double mixOf(const Node& node, double x, double y, double t) {
    const Format format = node.format;
    const double left = toFormat(x * toFormat(1.0 - t, format), format);
    return toFormat(left + toFormat(y * t, format), format);
}

bool holds(Relation relation, double a, double b) {
    switch (relation) {
        case Relation::Less:
            return a < b;
        case Relation::LessEqual:
            return a <= b;
        case Relation::Greater:
            return a > b;
        case Relation::GreaterEqual:
            return a >= b;
        case Relation::Equal:
            return a == b;
        case Relation::NotEqual:
            return a != b;
    }
    return false;
}

// Comparisons, and operations on truth values.
bool isTrue(Op op, double a, double b) {
    switch (op) {
        case Op::Less:
            return a < b;
        case Op::LessEqual:
            return a <= b;
        case Op::Equal:
            return a == b;
        case Op::And:
            return a > 0.0 && b > 0.0;
        case Op::Or:
            return a > 0.0 || b > 0.0;
        default:
            return a == 0.0;
    }
}

}  // namespace

double evaluateNode(const Node& node, double a, double b, double c) {
    const Format format = node.format;
    if (isBound(node.op)) {
        return std::array{a, b, c}[boundedOperand(node.op)];
    }
    switch (node.op) {
        case Op::Constant:
        case Op::Input:
        case Op::Merge:
            return node.value;
        case Op::Add:
            return toFormat(a + b, format);
        case Op::Subtract:
            return toFormat(a - b, format);
        case Op::Multiply:
            return toFormat(a * b, format);
        case Op::Square:
            return toFormat(a * a, format);
        case Op::Divide:
            return toFormat(a / b, format);
        case Op::Negate:
            return -a;
        case Op::Absolute:
            return std::abs(a);
        case Op::Sign:
            return signOf(a);
        case Op::Floor:
            return std::floor(a);
        case Op::Ceil:
            return std::ceil(a);
        case Op::Trunc:
            return std::trunc(a);
        case Op::RoundEven:
            return std::nearbyint(a);
        case Op::Apply:
            return toFormat(applySingle(node.function, static_cast<float>(a)), format);
        case Op::Power:
            return toFormat(std::pow(static_cast<float>(a), static_cast<float>(b)), format);
        case Op::ArcTangent:
            return toFormat(std::atan2(static_cast<float>(a), static_cast<float>(b)), format);
        case Op::Minimum:
            return b < a ? b : a;
        case Op::Maximum:
            return a < b ? b : a;
        case Op::Mix:
            return mixOf(node, a, b, c);
        case Op::Lerp:
            return toFormat(a + toFormat(toFormat(b - a, format) * c, format), format);
        case Op::Normalized:
            return toFormat(a * toFormat(1.0 / toFormat(std::sqrt(c), format), format), format);
        case Op::Convert:
            return toFormat(a, format);
        case Op::SplitHigh:
            return splitHigh(a);
        case Op::SplitLow:
            return toFormat(a - splitHigh(a), format);
        case Op::ProductError:
            return toFormat(a * b - toFormat(a * b, format), format);
        case Op::SumError:
            return sumError(a, b, format);
        case Op::Less:
        case Op::LessEqual:
        case Op::Equal:
        case Op::And:
        case Op::Or:
        case Op::Not:
            return isTrue(node.op, a, b) ? 1.0 : 0.0;
        case Op::Select:
            return a > 0.0 ? b : c;
        case Op::Refine:
            return holds(node.relation, a, b) ? a : std::nan("");
        case Op::ToInteger:
            return std::trunc(a);
        case Op::BitsOf:
            return asInteger(std::bit_cast<std::uint32_t>(static_cast<float>(a)), node.isSigned);
        default:
            return evaluateInteger(node, a, b);
    }
}

PointResult PointEvaluator::run(std::span<const double> inputs) {
    PointResult result;
    for (NodeId id = 0; id < program_.nodes.size(); ++id) {
        const Node& node = program_.nodes[id];
        // A guard within a branch that is not taken has no value.
        if (node.guard != kNoNode && !(values_[node.guard] > 0.0)) {
            values_[id] = std::nan("");
            continue;
        }
        const auto operand = [this](NodeId from) { return from == kNoNode ? 0.0 : values_[from]; };
        if (node.op == Op::Input) {
            const auto number = static_cast<std::size_t>(node.value);
            values_[id] = number < inputs.size() ? inputs[number] : 0.0;
            continue;
        }
        if (node.op == Op::Merge) {
            for (std::uint32_t k = 0; k < node.count; ++k) {
                const Edge& edge = program_.edges[node.first + k];
                if (edge.guard == kNoNode || values_[edge.guard] > 0.0) {
                    values_[id] = values_[edge.value];
                    break;
                }
            }
            continue;
        }
        const double a = operand(node.a);
        const double b = operand(node.b);
        const double c = operand(node.c);
        const bool joins = node.op == Op::Select || node.op == Op::And || node.op == Op::Or;
        // A choice whose condition has no value belongs to a branch that is not taken.
        const bool isUndecided = node.op == Op::Select && std::isnan(a);
        if (isUndecided || (!joins && (std::isnan(a) || std::isnan(b) || std::isnan(c)))) {
            values_[id] = std::nan("");
            continue;
        }
        values_[id] = evaluateNode(node, a, b, c);
        const bool selects = node.op == Op::Select || node.op == Op::Refine;
        if (!result.failed && !selects && !std::isfinite(values_[id]) && std::isfinite(a) &&
            std::isfinite(b) && std::isfinite(c)) {
            result.failed = id;
        }
    }
    for (const NodeId output : program_.outputs) {
        result.outputs.push_back(values_[output]);
    }
    return result;
}

}  // namespace glint::verify
