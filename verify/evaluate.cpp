#include "verify/evaluate.h"

#include "verify/concrete.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace glint::verify {
namespace {

constexpr double kLeastInt = -2147483648.0;
constexpr double kGreatestInt = 2147483647.0;
constexpr double kGreatestUint = 4294967295.0;

Interval rangeOfInteger(bool isSigned) {
    return isSigned ? Interval{kLeastInt, kGreatestInt} : Interval{0.0, kGreatestUint};
}

Interval monotone(const Interval& a, double (*function)(double)) {
    return {function(a.low), function(a.high)};
}

double bitsOf(double value, bool isSigned) {
    Node node;
    node.op = Op::BitsOf;
    node.isSigned = isSigned;
    return evaluateNode(node, value, 0.0, 0.0);
}

double ofBits(double bits) {
    Node node;
    node.op = Op::OfBits;
    return evaluateNode(node, bits, 0.0, 0.0);
}

Interval negated(const Interval& a) {
    return {-a.high, -a.low};
}

Interval absolute(const Interval& a) {
    return a.low >= 0.0 ? a : a.high <= 0.0 ? negated(a) : Interval{0.0, a.magnitude()};
}

// Errors of rounding in both directions of a sum or product with this magnitude.
Interval roundingError(double magnitude) {
    const double error = magnitude * 0x1p-24 * (1.0 + 0x1p-50) + 0x1p-147;
    Hazard ignored = Hazard::None;
    return Arithmetic(Format::Single).convert({-error, error}, ignored);
}

// The squared length from which on vectors are divided by their length, which neither underflows nor is below
// the least length that the shader divides by.
double leastSquaredLength(double leastLength) {
    return std::max(4.0 * kSmallestNormalSingle, leastLength * leastLength * (1.0 + 0x1p-10));
}

Interval lessThan(const Interval& a, const Interval& b) {
    return a.high < b.low ? kTrue : a.low >= b.high ? kFalse : kUndecided;
}

Interval notGreater(const Interval& a, const Interval& b) {
    return a.high <= b.low ? kTrue : a.low > b.high ? kFalse : kUndecided;
}

Interval notOf(const Interval& a) {
    return {1.0 - a.high, 1.0 - a.low};
}

// The next number of the format below.
double before(double value, Format format) {
    if (format == Format::Integer) {
        return value - 1.0;
    }
    return format == Format::Single && std::abs(value) <= kLargestSingle
               ? static_cast<double>(nextFloatBelow(static_cast<float>(value)))
               : value;
}

double after(double value, Format format) {
    return -before(-value, format);
}

// A conversion between floats and integers.
Interval converted(const Node& node, const Interval& a, Hazard& hazard) {
    const Interval all = rangeOfInteger(node.isSigned);
    switch (node.op) {
        case Op::ToInteger: {
            const Interval truncated = monotone(a, std::trunc);
            if (!truncated.isWithin(all)) {
                hazard |= Hazard::Conversion;
            }
            const Interval held = meet(truncated, all);
            return held.isEmpty() ? all : held;
        }
        case Op::FromInteger: {
            Hazard none = Hazard::None;
            return Arithmetic(node.format).convert(a, none);
        }
        case Op::BitsOf:
            if (a.low >= 0.0) {
                return {bitsOf(a.low, node.isSigned), bitsOf(a.high, node.isSigned)};
            }
            return a.high < 0.0 ? Interval{bitsOf(a.high, node.isSigned), bitsOf(a.low, node.isSigned)} : all;
        case Op::OfBits: {
            constexpr double kInfinityBits = 0x7F800000;
            if (a.low >= 0.0 && a.high < kInfinityBits) {
                return {ofBits(a.low), ofBits(a.high)};
            }
            if (a.low >= kLeastInt && a.high < kLeastInt + kInfinityBits && a.high < 0.0) {
                return {ofBits(a.high), ofBits(a.low)};
            }
            hazard |= Hazard::Overflow;
            return {};
        }
        default:
            return all;
    }
}

}  // namespace

const char* nameOf(Hazard hazard) {
    switch (hazard) {
        case Hazard::None:
            return "nothing";
        case Hazard::DivisionByZero:
            return "division by zero";
        case Hazard::RootOfNegative:
            return "square root of a negative number";
        case Hazard::LogOfNonPositive:
            return "logarithm of a number that is not positive";
        case Hazard::ArcBeyondOne:
            return "arc function beyond 1";
        case Hazard::PowerOfNegative:
            return "power of a number that is not positive";
        case Hazard::Overflow:
            return "overflow";
        case Hazard::IndefiniteForm:
            return "indefinite form of infinities";
        case Hazard::Conversion:
            return "conversion of a number that the integer can't hold";
        case Hazard::ArcOfOrigin:
            return "atan(0, 0)";
    }
    return "several hazards";
}

BoxEvaluator::BoxEvaluator(const Program& program)
    : program_(program), identities_(program), values_(program.nodes.size()) {}

void BoxEvaluator::know(NodeId node, const Interval& range) {
    known_.emplace_back(node, range);
    std::sort(known_.begin(), known_.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
}

void BoxEvaluator::run(std::span<const Interval> box, bool withAffineForms) {
    box_ = box;
    findings_.clear();
    identities_.forgetBox();
    withForms_ = withAffineForms;
    if (withForms_) {
        symbols_.clear();
        for (std::size_t input = 0; input < box.size(); ++input) {
            if (!box[input].isPoint() && box[input].isFinite()) {
                symbols_.push_back(input);
            }
        }
        slopes_.resize(program_.nodes.size() * symbols_.size());
        forms_.resize(program_.nodes.size());
        for (std::size_t id = 0; id < forms_.size(); ++id) {
            forms_[id].isValid = false;
            forms_[id].slopes = std::span(slopes_).subspan(id * symbols_.size(), symbols_.size());
        }
        for (std::vector<double>& scratch : scratch_) {
            scratch.resize(symbols_.size());
        }
    }
    auto known = known_.begin();
    for (NodeId id = 0; id < program_.nodes.size(); ++id) {
        evaluate(id);
        for (; known != known_.end() && known->first == id; ++known) {
            values_[id] = meet(values_[id], known->second);
        }
    }
}

double BoxEvaluator::change(NodeId node, std::size_t input) const {
    const auto found = std::find(symbols_.begin(), symbols_.end(), input);
    if (!withForms_ || found == symbols_.end() || !forms_[node].isValid) {
        return 0.0;
    }
    return std::abs(forms_[node].slopes[static_cast<std::size_t>(found - symbols_.begin())]);
}

void BoxEvaluator::evaluate(NodeId id) {
    const Node& node = program_.nodes[id];
    if (node.guard != kNoNode && (of(node.guard).isFalse() || of(node.guard).isEmpty())) {
        values_[id] = Interval::nothing();
        return;
    }
    const bool joins =
        node.op == Op::Merge || node.op == Op::Select || node.op == Op::And || node.op == Op::Or;
    if (!joins) {
        for (const NodeId operand : {node.a, node.b, node.c}) {
            if (operand != kNoNode && of(operand).isEmpty()) {
                values_[id] = Interval::nothing();
                return;
            }
        }
    }
    Hazard hazard = Hazard::None;
    values_[id] = valueOf(node, hazard);
    if (node.format == Format::Single) {
        const Interval bound = identities_.bound(id, values_);
        values_[id] =
            meet(values_[id], {roundDown(bound.low, node.format), roundUp(bound.high, node.format)});
    }
    if (withForms_ && node.format != Format::Integer) {
        evaluateForm(id);
    }
    if (hazard == Hazard::Overflow) {
        // An infinity that was given is no overflow, and the forms may know better than the intervals.
        const bool wasInfinite = (node.a != kNoNode && !of(node.a).isFinite()) ||
                                 (node.b != kNoNode && !of(node.b).isFinite()) ||
                                 (node.c != kNoNode && !of(node.c).isFinite());
        if (wasInfinite || values_[id].isFinite()) {
            return;
        }
    }
    if (hazard != Hazard::None && !node.isAuxiliary) {
        findings_.push_back({id, hazard});
    }
}

Interval BoxEvaluator::valueOf(const Node& node, Hazard& hazard) {
    const Arithmetic arithmetic(node.format == Format::Half ? Format::Half : Format::Single);
    const Interval& a = node.a == kNoNode ? kFalse : of(node.a);
    const Interval& b = node.b == kNoNode ? kFalse : of(node.b);
    const Interval& c = node.c == kNoNode ? kFalse : of(node.c);
    switch (node.op) {
        case Op::Constant:
            return Interval::of(node.value);
        case Op::Input:
            return inputOf(node);
        case Op::Merge:
            return merged(node);
        case Op::Add:
            return arithmetic.add(a, b, hazard);
        case Op::Subtract:
            return difference(node, arithmetic.subtract(a, b, hazard));
        case Op::Multiply:
            return arithmetic.multiply(a, b, hazard);
        case Op::Square:
            return arithmetic.square(a, hazard);
        case Op::Divide:
            return arithmetic.divide(a, b, hazard);
        case Op::Negate:
            return negated(a);
        case Op::Absolute:
            return absolute(a);
        case Op::Sign:
            return monotone(a, signOf);
        case Op::Floor:
            return monotone(a, std::floor);
        case Op::Ceil:
            return monotone(a, std::ceil);
        case Op::Trunc:
            return monotone(a, std::trunc);
        case Op::RoundEven:
            return monotone(a, std::nearbyint);
        case Op::Apply:
            return arithmetic.apply(node.function, a, hazard);
        case Op::Power:
            return arithmetic.power(a, b, hazard);
        case Op::ArcTangent:
            return arithmetic.arcTangent(a, b, hazard);
        case Op::Minimum:
            return {std::min(a.low, b.low), std::min(a.high, b.high)};
        case Op::Maximum:
            return {std::max(a.low, b.low), std::max(a.high, b.high)};
        case Op::Mix:
        case Op::Lerp:
            return arithmetic.mix(a, b, c, hazard);
        case Op::Normalized: {
            const Interval scale = arithmetic.apply(Function::InverseSqrt, c, hazard);
            const Interval plain = arithmetic.multiply(a, scale, hazard);
            return c.low >= 4.0 * kSmallestNormalSingle && c.isFinite()
                       ? meet(plain, arithmetic.normalized(a, b))
                       : plain;
        }
        case Op::Convert:
            return arithmetic.convert(a, hazard);
        case Op::SplitHigh:
            return arithmetic.convert(
                {a.low - std::abs(a.low) * 0x1p-12, a.high + std::abs(a.high) * 0x1p-12}, hazard);
        case Op::SplitLow:
            return arithmetic.convert({-a.magnitude() * 0x1p-12, a.magnitude() * 0x1p-12}, hazard);
        case Op::ProductError:
            return roundingError(a.magnitude() * b.magnitude());
        case Op::SumError:
            return roundingError(std::max(std::abs(a.low + b.low), std::abs(a.high + b.high)));
        default:
            return isBound(node.op) ? bounded(node) : choice(node, hazard);
    }
}

Interval BoxEvaluator::bounded(const Node& node) {
    const Arithmetic arithmetic(node.format == Format::Half ? Format::Half : Format::Single);
    const double unit = unitRoundoff(node.format);
    const Interval& a = node.a == kNoNode ? kFalse : of(node.a);
    const Interval& b = node.b == kNoNode ? kFalse : of(node.b);
    const Interval& c = node.c == kNoNode ? kFalse : of(node.c);
    // Narrows a value that lies in `exact` but for relative and absolute errors.
    const auto narrowed = [&](const Interval& value, const Interval& exact, double relative,
                              double absolute) {
        Hazard ignored = Hazard::None;
        return meet(value, arithmetic.convert({exact.low * (1.0 - relative) - absolute,
                                               exact.high * (1.0 + relative) + absolute},
                                              ignored));
    };
    const auto square = [&](const Interval& x) {
        Hazard ignored = Hazard::None;
        return arithmetic.square(x, ignored);
    };
    switch (node.op) {
        case Op::CircleSum:
            // The sine, the cosine and the products on the way are off by less than this.
            return narrowed(c, hull(square(a), square(b)), 32.0 * unit, 8.0 * halfDenormal(node.format));
        case Op::SquareOfRoot:
            return narrowed(b, a, 4.0 * unit, 2.0 * halfDenormal(node.format));
        case Op::SphereSum:
            return narrowed(b, square(a), 40.0 * unit, 0.0);
        case Op::WeightedUnit:
            // Each weight and each square is rounded a few times, and the sum twice.
            return narrowed(a, {b.low, c.high}, 40.0 * unit, 0x1p-140);
        case Op::Bounded: {
            // The squared lengths are rounded down by less than this, and the sum up.
            const double length = std::sqrt(std::max(b.high, 0.0)) * (1.0 + 16.0 * unit) + 0x1p-60;
            return meet(a, {roundDown(-length, node.format), roundUp(length, node.format)});
        }
        case Op::UnitSum:
        case Op::PartOfUnit: {
            // As for normalized(), the squared length must not underflow or overflow.
            const double error = 32.0 * unit;
            if (b.low < leastSquaredLength(node.value) || !b.isFinite() || node.format == Format::Half) {
                return a;
            }
            return meet(a, {node.op == Op::UnitSum ? 1.0 - error : 0.0, 1.0 + error});
        }
        case Op::MirroredSum: {
            // The result is |v|² + 4 (v·h)² (|h|² - 1), where (v·h)² <= |v|² |h|²; rounding is relative to
            // the terms.
            const double most = b.high * (1.0 + 2.0 * c.high) * (1.0 + 2.0 * c.high);
            const double error =
                4.0 * b.high * c.high * std::max(std::abs(c.low - 1.0), std::abs(c.high - 1.0)) +
                64.0 * unit * most;
            if (!std::isfinite(error) || b.low < 0.0 || c.low < 0.0) {
                return a;
            }
            return meet(a, {roundDown(b.low - error, node.format), roundUp(b.high + error, node.format)});
        }
        case Op::TriangleSum:
            return meet(a, {a.low, roundUp(b.high * (1.0 + 40.0 * unit), node.format)});
        case Op::UnitQuotient:
            return unitQuotient(node);
        default:
            return share(node);
    }
}

Interval BoxEvaluator::choice(const Node& node, Hazard& hazard) {
    const Interval& a = of(node.a);
    const Interval& b = node.b == kNoNode ? kFalse : of(node.b);
    switch (node.op) {
        case Op::Less:
        case Op::LessEqual:
        case Op::Equal:
            return compared(node);
        // An operand without a value belongs to a branch that is not taken. It decides nothing. The other
        // operand may be the condition of that branch, and then has the same result, or that of another
        // branch.
        case Op::And:
            return {a.isEmpty() || b.isEmpty() ? 0.0 : std::min(a.low, b.low),
                    std::min(a.isEmpty() ? 1.0 : a.high, b.isEmpty() ? 1.0 : b.high)};
        case Op::Or:
            return {std::max(a.isEmpty() ? 0.0 : a.low, b.isEmpty() ? 0.0 : b.low),
                    a.isEmpty() || b.isEmpty() ? 1.0 : std::max(a.high, b.high)};
        case Op::Not:
            return notOf(a);
        case Op::Select:
            return selected(node);
        case Op::Refine:
            return refined(node);
        default:
            return integer(node, hazard);
    }
}

// A quotient by a sum that is not 0 does not overflow.
void BoxEvaluator::forgiveOverflow(NodeId id) {
    std::erase_if(findings_, [&](const Finding& finding) {
        return finding.node == id && finding.hazard == Hazard::Overflow;
    });
}

Interval BoxEvaluator::share(const Node& node) {
    const Interval& a = of(node.a);
    const Interval& b = of(node.b);
    const Interval& c = of(node.c);
    if (b.low < 0.0 || c.low < 0.0 || !b.isFinite()) {
        return a;
    }
    if (const Node& quotient = program_.nodes[node.a];
        quotient.op == Op::Divide && of(quotient.b).low > 0.0) {
        forgiveOverflow(node.a);
    }
    // Each term and the sum are rounded some ten times, all in the same direction at worst.
    const double error = 48.0 * unitRoundoff(node.format);
    const double least = b.low > 0.0 && std::isfinite(c.high) ? b.low / (b.low + c.high) : 0.0;
    const double greatest = b.high > 0.0 ? b.high / (b.high + c.low) : 0.0;
    // Small terms may have lost digits below the smallest normal number.
    const double lost = b.low + c.low >= 0x1p-100 ? 0x1p-40 : 1.0;
    Hazard ignored = Hazard::None;
    return meet(a, Arithmetic(node.format)
                       .convert({std::max(least * (1.0 - error) - lost, 0.0),
                                 std::min(greatest + lost, 1.0) * (1.0 + error)},
                                ignored));
}

Interval BoxEvaluator::unitQuotient(const Node& node) {
    const Interval& plain = of(node.a);
    const Interval& length2 = of(node.c);
    const Node& quotient = program_.nodes[node.a];
    const bool isPositive = length2.low > 0.0 || (quotient.op == Op::Divide && of(quotient.b).low > 0.0);
    if (!isPositive || !length2.isFinite()) {
        return plain;
    }
    // The square of the component may have lost the smallest number, which the others need not make up for.
    Interval result = meet(plain, {-1.5, 1.5});
    if (length2.low >= leastSquaredLength(node.value)) {
        const bool isFirst = quotient.op == Op::Divide || program_.nodes[quotient.b].op == Op::Apply;
        result = meet(result,
                      Arithmetic(node.format).normalized(of(isFirst ? quotient.a : quotient.b), of(node.b)));
    }
    forgiveOverflow(node.a);
    return result;
}

// (x + y) - x is not negative if y is not: rounding is monotone.
Interval BoxEvaluator::difference(const Node& node, const Interval& plain) const {
    NodeId sum = node.a;
    while (program_.nodes[sum].op == Op::Bounded || program_.nodes[sum].op == Op::Refine) {
        sum = program_.nodes[sum].a;
    }
    const Node& from = program_.nodes[sum];
    if (from.op != Op::Add || (from.a != node.b && from.b != node.b)) {
        return plain;
    }
    const Interval& added = of(from.a == node.b ? from.b : from.a);
    return {added.low >= 0.0 ? std::max(plain.low, 0.0) : plain.low,
            added.high <= 0.0 ? std::min(plain.high, 0.0) : plain.high};
}

// Inputs that the claim does not have are 0.
Interval BoxEvaluator::inputOf(const Node& node) const {
    const auto number = static_cast<std::size_t>(node.value);
    return number < box_.size() ? box_[number] : kFalse;
}

Interval BoxEvaluator::compared(const Node& node) {
    const Interval& a = of(node.a);
    const Interval& b = of(node.b);
    if (node.op == Op::Equal) {
        if (a.isPoint() && a == b) {
            return kTrue;
        }
        return meet(a, b).isEmpty() ? kFalse : kUndecided;
    }
    const Interval plain = node.op == Op::Less ? lessThan(a, b) : notGreater(a, b);
    if (plain != kUndecided || !withForms_ || !forms_[node.a].isValid || !forms_[node.b].isValid) {
        return plain;
    }
    // The common part of both cancels.
    Affine difference;
    difference.slopes = scratch_[0];
    addAffine(forms_[node.a], forms_[node.b], -1.0, difference);
    if (!difference.isValid) {
        return plain;
    }
    return node.op == Op::Less ? lessThan(difference.range(), kFalse)
                               : notGreater(difference.range(), kFalse);
}

Interval BoxEvaluator::selected(const Node& node) const {
    const Interval& condition = of(node.a);
    if (condition.isEmpty()) {
        return Interval::nothing();
    }
    if (condition.isTrue()) {
        return of(node.b);
    }
    return condition.isFalse() ? of(node.c) : hull(of(node.b), of(node.c));
}

Interval BoxEvaluator::merged(const Node& node) const {
    Interval result = Interval::nothing();
    for (std::uint32_t k = 0; k < node.count; ++k) {
        const Edge& edge = program_.edges[node.first + k];
        const Interval guard = edge.guard == kNoNode ? kTrue : of(edge.guard);
        if (!guard.isFalse() && !guard.isEmpty()) {
            result = hull(result, of(edge.value));
        }
    }
    return result;
}

Interval BoxEvaluator::refined(const Node& node) const {
    const Interval& a = of(node.a);
    const Interval& b = of(node.b);
    switch (node.relation) {
        case Relation::Less:
            return meet(a, {-kInfinity, before(b.high, node.format)});
        case Relation::LessEqual:
            return meet(a, {-kInfinity, b.high});
        case Relation::Greater:
            return meet(a, {after(b.low, node.format), kInfinity});
        case Relation::GreaterEqual:
            return meet(a, {b.low, kInfinity});
        case Relation::Equal:
            return meet(a, b);
        case Relation::NotEqual:
            break;
    }
    Interval result = a;
    if (b.isPoint()) {
        if (result.low == b.low) {
            result.low = after(result.low, node.format);
        }
        if (result.high == b.low) {
            result.high = before(result.high, node.format);
        }
    }
    return result;
}

Interval BoxEvaluator::integer(const Node& node, Hazard& hazard) const {
    const Interval& a = of(node.a);
    const Interval b = node.b == kNoNode ? kFalse : of(node.b);
    const Interval all = rangeOfInteger(node.isSigned);
    if (node.op >= Op::ToInteger && node.op <= Op::OfBits) {
        return converted(node, a, hazard);
    }
    if (a.isPoint() && b.isPoint()) {
        return Interval::of(evaluateNode(node, a.low, b.low, 0.0));
    }
    Interval result = all;
    switch (node.op) {
        case Op::IntegerAdd:
            result = {a.low + b.low, a.high + b.high};
            break;
        case Op::IntegerSubtract:
            result = {a.low - b.high, a.high - b.low};
            break;
        case Op::IntegerMultiply:
            result = a.low >= 0.0 && b.low >= 0.0 ? Interval{a.low * b.low, a.high * b.high} : all;
            break;
        case Op::IntegerDivide:
            result = a.low >= 0.0 && b.low > 0.0
                         ? Interval{std::trunc(a.low / b.high), std::trunc(a.high / b.low)}
                         : all;
            break;
        case Op::IntegerRemainder:
            result = a.low >= 0.0 && b.low > 0.0 ? Interval{0.0, std::min(a.high, b.high - 1.0)} : all;
            break;
        case Op::BitAnd:
            result = a.low >= 0.0 && b.low >= 0.0 ? Interval{0.0, std::min(a.high, b.high)} : all;
            break;
        case Op::BitOr:
        case Op::BitXor:
            // No bit above the highest of either.
            if (a.low >= 0.0 && b.low >= 0.0) {
                result = {0.0, std::exp2(std::floor(std::log2(std::max({a.high, b.high, 1.0}))) + 1.0) - 1.0};
            }
            break;
        case Op::ShiftRight:
            if (a.low >= 0.0 && b.low >= 0.0 && b.high < 32.0) {
                result = {std::floor(std::ldexp(a.low, -static_cast<int>(b.high))),
                          std::floor(std::ldexp(a.high, -static_cast<int>(b.low)))};
            }
            break;
        case Op::ChangeSign:
            result = a;
            break;
        default:
            break;
    }
    return result.isWithin(all) ? result : all;
}

}  // namespace glint::verify
