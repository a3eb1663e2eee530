// Sequences of operations with a known meaning, which have tighter bounds than their single operations.
#include "prove/concrete.h"
#include "prove/program.h"

#include <algorithm>
#include <utility>

namespace glint::prove {
namespace {

constexpr double kSplitFactor = 4097.0;  // Veltkamp's, in shaders/bsdf/exact.glsl

}  // namespace

NodeId ProgramBuilder::plainOf(NodeId id) const {
    for (;;) {
        const Node& known = node(id);
        if (known.op == Op::SphereSum) {
            id = known.b;
        } else if (known.op == Op::Bounded || known.op == Op::UnitSum || known.op == Op::PartOfUnit ||
                   known.op == Op::WeightedUnit || known.op == Op::UnitQuotient || known.op == Op::Share ||
                   known.op == Op::TriangleSum || known.op == Op::MirroredSum) {
            id = known.a;
        } else if (known.op == Op::CircleSum) {
            id = known.c;
        } else if (known.op == Op::SquareOfRoot) {
            id = known.b;
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

}  // namespace glint::prove
