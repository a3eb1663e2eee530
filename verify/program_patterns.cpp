// Sequences of operations with a known meaning, which have tighter bounds than their single operations.
#include "verify/concrete.h"
#include "verify/program_builder.h"

#include <algorithm>
#include <utility>

namespace glint::verify {
namespace {

constexpr double kSplitFactor = 4097.0;  // Veltkamp's, in shaders/bsdf/exact.glsl

}  // namespace

NodeId ProgramBuilder::plainOf(NodeId id) const {
    for (;;) {
        const Node& known = node(id);
        if (known.op == Op::SphereSum || known.op == Op::SquareOfRoot) {
            id = known.b;
        } else if (known.op == Op::Bounded || known.op == Op::UnitSum || known.op == Op::PartOfUnit ||
                   known.op == Op::WeightedUnit || known.op == Op::UnitQuotient || known.op == Op::Share ||
                   known.op == Op::TriangleSum || known.op == Op::MirroredSum) {
            id = known.a;
        } else if (known.op == Op::CircleSum) {
            id = known.c;
        } else {
            return id;
        }
    }
}

bool ProgramBuilder::isHighOf(NodeId high, NodeId of) const {
    if (isConstant(of)) {
        const Node split{.op = Op::SplitHigh};
        return isConstant(high, evaluateNode(split, node(of).value, 0.0, 0.0));
    }
    return node(high).op == Op::SplitHigh && node(high).a == of;
}

bool ProgramBuilder::isLowOf(NodeId low, NodeId of) const {
    if (isConstant(of)) {
        const Node split{.op = Op::SplitLow};
        return isConstant(low, evaluateNode(split, node(of).value, 0.0, 0.0));
    }
    return node(low).op == Op::SplitLow && node(low).a == of;
}

bool ProgramBuilder::isProductOf(NodeId product, NodeId a, NodeId b) const {
    const Node& found = node(plainOf(product));
    if (a == b) {
        return found.op == Op::Square && found.a == a;
    }
    return found.op == Op::Multiply && ((found.a == a && found.b == b) || (found.a == b && found.b == a));
}

bool ProgramBuilder::isSumOf(NodeId sum, NodeId a, NodeId b) const {
    const Node& found = node(plainOf(sum));
    return found.op == Op::Add && ((found.a == a && found.b == b) || (found.a == b && found.b == a));
}

// Finds the sequences of shaders/bsdf/exact.glsl; a hit is sound whatever it was written for, because the
// operations are the same.
NodeId ProgramBuilder::errorFree(const Node& node) {
    if (node.format != Format::Single) {
        return kNoNode;
    }
    const auto at = [this](NodeId id) -> const Node& { return this->node(id); };
    if (node.op == Op::Subtract) {
        // big - (big - x), where big = 4097 x
        const Node& big = at(node.a);
        const Node& rest = at(node.b);
        if (big.op == Op::Multiply && rest.op == Op::Subtract && rest.a == node.a &&
            ((isConstant(big.a, kSplitFactor) && big.b == rest.b) ||
             (isConstant(big.b, kSplitFactor) && big.a == rest.b))) {
            return make(Op::SplitHigh, node.format, rest.b);
        }
        if (rest.op == Op::SplitHigh && rest.a == node.a) {
            return make(Op::SplitLow, node.format, node.a);
        }
        return kNoNode;
    }
    // Both orders of a sum, because operands are sorted.
    for (const auto& [left, right] : {std::pair(node.a, node.b), std::pair(node.b, node.a)}) {
        // (a - (sum - part)) + (b - part), where part = sum - a
        const Node& first = at(left);
        const Node& second = at(right);
        if (first.op == Op::Subtract && second.op == Op::Subtract) {
            const Node& part = at(second.b);
            const Node& kept = at(first.b);
            if (part.op == Op::Subtract && part.b == first.a && kept.op == Op::Subtract && kept.a == part.a &&
                kept.b == second.b && isSumOf(part.a, first.a, second.a)) {
                return make(Op::SumError, node.format, first.a, second.a);
            }
        }
        // (((hh - product) + hl) + lh) + ll
        if (first.op != Op::Add || (second.op != Op::Multiply && second.op != Op::Square)) {
            continue;
        }
        const auto factors = [&](NodeId id) {
            return at(id).op == Op::Square ? std::pair(at(id).a, at(id).a) : std::pair(at(id).a, at(id).b);
        };
        const auto [low1, low2] = factors(right);
        if (at(low1).op != Op::SplitLow || at(low2).op != Op::SplitLow) {
            continue;
        }
        const NodeId a = at(low1).a;
        const NodeId b = at(low2).a;
        const auto isCross = [&](NodeId id) {
            if (at(id).op != Op::Multiply) {
                return false;
            }
            const auto [x, y] = factors(id);
            return (isHighOf(x, a) && isLowOf(y, b)) || (isHighOf(y, a) && isLowOf(x, b)) ||
                   (isHighOf(x, b) && isLowOf(y, a)) || (isHighOf(y, b) && isLowOf(x, a));
        };
        for (const auto& [inner, cross2] : {std::pair(first.a, first.b), std::pair(first.b, first.a)}) {
            if (!isCross(cross2) || at(inner).op != Op::Add) {
                continue;
            }
            for (const auto& [start, cross1] :
                 {std::pair(at(inner).a, at(inner).b), std::pair(at(inner).b, at(inner).a)}) {
                if (!isCross(cross1) || at(start).op != Op::Subtract) {
                    continue;
                }
                const NodeId highs = at(start).a;
                const auto [x, y] = factors(highs);
                const bool areHighs =
                    (isHighOf(x, a) && isHighOf(y, b)) || (isHighOf(x, b) && isHighOf(y, a));
                if (areHighs && isProductOf(at(start).b, a, b)) {
                    return make(Op::ProductError, node.format, std::min(a, b), std::max(a, b));
                }
            }
        }
    }
    return kNoNode;
}

// a + (b - a) c
NodeId ProgramBuilder::interpolation(const Node& given) {
    for (const auto& [start, product] : {std::pair(given.a, given.b), std::pair(given.b, given.a)}) {
        const Node times = node(product);
        if (times.op != Op::Multiply) {
            continue;
        }
        for (const auto& [difference, share] : {std::pair(times.a, times.b), std::pair(times.b, times.a)}) {
            const Node between = node(difference);
            if (between.op == Op::Subtract && between.b == start && given.format == Format::Single) {
                return make(Op::Lerp, given.format, start, between.a, share);
            }
        }
    }
    return kNoNode;
}

// (x >> a) >> b, which is 0 if nothing is left.
NodeId ProgramBuilder::shifted(const Node& given) {
    NodeId shiftedBefore = given.a;
    while (node(shiftedBefore).op == Op::Refine) {
        shiftedBefore = node(shiftedBefore).a;
    }
    const Node before = node(shiftedBefore);
    if (before.op != Op::ShiftRight || !isConstant(before.b) || !isConstant(given.b) || given.isSigned ||
        before.isSigned) {
        return kNoNode;
    }
    const double places = node(before.b).value + node(given.b).value;
    if (places > 31.0) {
        return constant(0.0, Format::Integer);
    }
    Node all = given;
    all.a = before.a;
    all.b = constant(places, Format::Integer);
    return make(all);
}

ProgramBuilder::Angular ProgramBuilder::angularOf(NodeId id) {
    const Node node = this->node(id);
    switch (node.op) {
        case Op::Apply:
            if (node.function == Function::Sin || node.function == Function::Cos) {
                return {node.a, node.function == Function::Sin, constant(1.0, node.format)};
            }
            return {};
        case Op::Negate:
        case Op::Refine:
            return angularOf(node.a);
        case Op::Multiply:
            for (const auto& [angular, factor] : {std::pair(node.a, node.b), std::pair(node.b, node.a)}) {
                Angular found = angularOf(angular);
                if (found.angle != kNoNode) {
                    found.rest = make(Op::Multiply, node.format, found.rest, factor);
                    return found;
                }
            }
            return {};
        case Op::Divide: {
            Angular found = angularOf(node.a);
            if (found.angle != kNoNode) {
                found.rest = make(Op::Divide, node.format, found.rest, node.b);
            }
            return found;
        }
        default:
            return {};
    }
}

NodeId ProgramBuilder::sumOfSquares(const Node& node) {
    const Node& first = this->node(node.a);
    const Node& second = this->node(node.b);
    if (first.op != Op::Square || second.op != Op::Square) {
        return kNoNode;
    }
    const NodeId x = first.a;
    const NodeId y = second.a;
    const bool wasAuxiliary = std::exchange(makesAuxiliary_, true);
    const Angular ofX = angularOf(x);
    const Angular ofY = angularOf(y);
    makesAuxiliary_ = wasAuxiliary;
    if (ofX.angle == kNoNode || ofX.angle != ofY.angle || ofX.isSine == ofY.isSine) {
        return kNoNode;
    }
    return make(Op::CircleSum, node.format, ofX.rest, ofY.rest, appendOnce(node));
}

// x / y where a branch has found x < y.
NodeId ProgramBuilder::quotientOfLess(const Node& given) {
    std::vector<NodeId> known;
    if (guard_ != kNoNode) {
        operandsOf(Op::And, guard_, known);
    }
    const bool isLess = std::any_of(known.begin(), known.end(), [&](NodeId id) {
        const Node& condition = node(id);
        return condition.op == Op::Less && bareOf(condition.a) == bareOf(given.a) &&
               bareOf(condition.b) == bareOf(given.b);
    });
    if (!isLess) {
        return kNoNode;
    }
    const NodeId quotient = appendOnce(given);
    const bool wasAuxiliary = std::exchange(makesAuxiliary_, true);
    const NodeId rest = refine(make(Op::Subtract, given.format, given.b, given.a), Relation::GreaterEqual,
                               constant(0.0, given.format));
    makesAuxiliary_ = wasAuxiliary;
    return make(Op::Share, given.format, quotient, given.a, rest);
}

// max(1 - x, 0) is 1 - min(x, 1), and min(1 - x, 1) is 1 - max(x, 0), bit-exact. min comes after max.
NodeId ProgramBuilder::limited(const Node& given) {
    if (given.format != Format::Single) {
        return kNoNode;
    }
    const bool isMaximum = given.op == Op::Maximum;
    const Op other = isMaximum ? Op::Minimum : Op::Maximum;
    for (const auto& [value, limit] : {std::pair(given.a, given.b), std::pair(given.b, given.a)}) {
        if (!isConstant(limit)) {
            continue;
        }
        const Node within = node(value);
        const NodeId one = constant(1.0, given.format);
        if (within.op == Op::Subtract && within.a == one && isConstant(limit, isMaximum ? 0.0 : 1.0)) {
            const NodeId opposite =
                make(other, given.format, within.b, constant(isMaximum ? 1.0 : 0.0, given.format));
            return make(Op::Subtract, given.format, one, opposite);
        }
        if (isMaximum && within.op == Op::Minimum && isConstant(within.b) &&
            node(limit).value <= node(within.b).value) {
            return make(Op::Minimum, given.format, make(Op::Maximum, given.format, within.a, limit),
                        within.b);
        }
    }
    return kNoNode;
}

namespace {

// Longer products and sums are no shares that anybody wrote.
constexpr std::size_t kMostTermsOfShares = 16;
constexpr std::size_t kMostFactorsOfShares = 6;
constexpr int kMostDepth = 10;

}  // namespace

NodeId ProgramBuilder::withoutRefinement(NodeId id) const {
    while (node(id).op == Op::Refine || plainOf(id) != id) {
        id = node(id).op == Op::Refine ? node(id).a : plainOf(id);
    }
    return id;
}

// Collects the factors of a product. The quotient by `divisor` gives its numerator.
void ProgramBuilder::factorsOf(NodeId id, NodeId divisor, Factors& factors) const {
    const NodeId bare = withoutRefinement(id);
    const Node& at = node(bare);
    if (at.op == Op::Multiply) {
        factorsOf(at.a, divisor, factors);
        factorsOf(at.b, divisor, factors);
    } else if (at.op == Op::Divide && withoutRefinement(at.b) == divisor) {
        factorsOf(at.a, kNoNode, factors);
    } else if (!isConstant(bare, 1.0)) {
        factors.push_back(bare);
    }
}

// Collects the sums by which a product divides.
void ProgramBuilder::divisorsOf(NodeId id, std::vector<NodeId>& divisors) const {
    const Node& at = node(withoutRefinement(id));
    if (at.op == Op::Multiply) {
        divisorsOf(at.a, divisors);
        divisorsOf(at.b, divisors);
    } else if (at.op == Op::Divide && node(withoutRefinement(at.b)).op == Op::Add) {
        divisors.push_back(withoutRefinement(at.b));
    }
}

bool ProgramBuilder::isSumWith(NodeId id, const std::vector<NodeId>& parts, int depth) const {
    const NodeId bare = withoutRefinement(id);
    if (std::find(parts.begin(), parts.end(), bare) != parts.end()) {
        return true;
    }
    const Node& at = node(bare);
    return depth > 0 && (at.op == Op::Add || at.op == Op::Multiply) &&
           (isSumWith(at.a, parts, depth - 1) || isSumWith(at.b, parts, depth - 1));
}

// The sum's terms, each a sorted list of factors. A factor that contains none of the parts stays whole.
bool ProgramBuilder::termsOf(NodeId id, const std::vector<NodeId>& parts, std::vector<Factors>& terms,
                             int depth) const {
    const NodeId bare = withoutRefinement(id);
    const Node& at = node(bare);
    const bool isPart = std::find(parts.begin(), parts.end(), bare) != parts.end();
    if (isPart || !isSumWith(bare, parts, depth)) {
        terms.push_back({bare});
        return true;
    }
    std::vector<Factors> left;
    std::vector<Factors> right;
    if (depth == 0 || !termsOf(at.a, parts, left, depth - 1) || !termsOf(at.b, parts, right, depth - 1)) {
        return false;
    }
    if (at.op == Op::Add) {
        terms = std::move(left);
        terms.insert(terms.end(), right.begin(), right.end());
        return terms.size() <= kMostTermsOfShares;
    }
    for (const Factors& first : left) {
        for (const Factors& second : right) {
            Factors both = first;
            both.insert(both.end(), second.begin(), second.end());
            std::sort(both.begin(), both.end());
            terms.push_back(std::move(both));
        }
    }
    return terms.size() <= kMostTermsOfShares;
}

NodeId ProgramBuilder::sumOfTerms(const std::vector<Factors>& terms, Format format) {
    const bool wasAuxiliary = std::exchange(makesAuxiliary_, true);
    NodeId sum = constant(0.0, format);
    for (const Factors& term : terms) {
        NodeId product = constant(1.0, format);
        for (const NodeId factor : term) {
            product = make(Op::Multiply, format, product, factor);
        }
        sum = make(Op::Add, format, sum, product);
    }
    makesAuxiliary_ = wasAuxiliary;
    return sum;
}

// The share of `own` terms in the divisor, which is `value`.
NodeId ProgramBuilder::shareOf(NodeId value, std::vector<Factors> own, NodeId divisor) {
    std::vector<NodeId> parts;
    for (const Factors& term : own) {
        parts.insert(parts.end(), term.begin(), term.end());
    }
    std::vector<Factors> rest;
    if (!termsOf(divisor, parts, rest, kMostDepth)) {
        return kNoNode;
    }
    for (const Factors& term : own) {
        const auto found = std::find(rest.begin(), rest.end(), term);
        if (found == rest.end()) {
            return kNoNode;
        }
        rest.erase(found);
    }
    const Format format = node(value).format;
    Node share;
    share.op = Op::Share;
    share.format = format;
    share.a = value;
    share.b = sumOfTerms(own, format);
    share.c = sumOfTerms(rest, format);
    const NodeId made = make(share);
    shares_[made] = {std::move(own), divisor};
    return made;
}

NodeId ProgramBuilder::share(const Node& given) {
    if (given.format != Format::Single) {
        return kNoNode;
    }
    std::vector<NodeId> divisors;
    if (given.op == Op::Multiply) {
        divisorsOf(given.a, divisors);
        divisorsOf(given.b, divisors);
    } else if (node(withoutRefinement(given.b)).op == Op::Add) {
        divisors.push_back(withoutRefinement(given.b));
    }
    for (const NodeId divisor : divisors) {
        Factors factors;
        factorsOf(given.a, divisor, factors);
        if (given.op == Op::Multiply) {
            factorsOf(given.b, divisor, factors);
        }
        std::sort(factors.begin(), factors.end());
        if (factors.empty() || factors.size() > kMostFactorsOfShares ||
            !isSumWith(divisor, factors, kMostDepth)) {
            continue;
        }
        if (const NodeId made = shareOf(appendOnce(given), {factors}, divisor); made != kNoNode) {
            return made;
        }
    }
    return kNoNode;
}

// A sum of shares of the same sum.
NodeId ProgramBuilder::sumOfShares(const Node& given) {
    const auto first = shares_.find(given.a);
    const auto second = shares_.find(given.b);
    if (first == shares_.end() || second == shares_.end() ||
        first->second.divisor != second->second.divisor) {
        return kNoNode;
    }
    std::vector<Factors> own = first->second.terms;
    own.insert(own.end(), second->second.terms.begin(), second->second.terms.end());
    return shareOf(appendOnce(given), std::move(own), first->second.divisor);
}

// Moves an operation into the two sides of a choice with a constant side: c ? 0 : x, times y; or the sum of
// two choices by the same condition.
NodeId ProgramBuilder::intoChoice(const Node& given) {
    for (const auto& [choice, other] : {std::pair(given.a, given.b), std::pair(given.b, given.a)}) {
        const Node chosen = node(choice);
        const Node with = node(other);
        if (chosen.op == Op::Select && with.op == Op::Select && with.a == chosen.a && given.op == Op::Add) {
            // Conditions are known where both sides are.
            const NodeId outside = guard_;
            const NodeId ifYes = both(outside, chosen.a);
            const NodeId ifNo = both(outside, opposite(chosen.a));
            guard_ = ifYes;
            const NodeId yes = make(Op::Add, given.format, chosen.b, with.b);
            guard_ = ifNo;
            const NodeId no = make(Op::Add, given.format, chosen.c, with.c);
            guard_ = outside;
            return make(Op::Select, given.format, chosen.a, yes, no);
        }
        if (chosen.op != Op::Select || !isConstant(chosen.b)) {
            continue;
        }
        const bool isSame = with.op == Op::Select && with.a == chosen.a && isConstant(with.b);
        const bool isZero = given.op == Op::Multiply && isConstant(chosen.b, 0.0);
        if (!isSame && !isConstant(other) && !isZero) {
            continue;
        }
        const NodeId yes = isSame || isConstant(other)
                               ? make(given.op, given.format, chosen.b, isSame ? with.b : other)
                               : chosen.b;
        if (!isConstant(yes)) {
            continue;
        }
        const NodeId outside = guard_;
        guard_ = both(guard_, opposite(chosen.a));
        const NodeId no = make(given.op, given.format, chosen.c, isSame ? with.c : other);
        guard_ = outside;
        return make(Op::Select, given.format, chosen.a, yes, no);
    }
    return kNoNode;
}

}  // namespace glint::verify
