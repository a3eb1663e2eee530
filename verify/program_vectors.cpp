// Bounds for components of vectors: normalised, mirrored, on a circle or a sphere; and for their products and
// sums.
#include "base/lists.h"
#include "verify/program_builder.h"

#include <algorithm>
#include <utility>

namespace glint::verify {

NodeId ProgramBuilder::boundedDot(NodeId sum, const std::vector<NodeId>& a, const std::vector<NodeId>& b) {
    if (a == b || isConstant(sum)) {
        return sum;
    }
    const bool wasAuxiliary = std::exchange(makesAuxiliary_, true);
    NodeId squares[2] = {kNoNode, kNoNode};
    for (const bool second : {false, true}) {
        NodeId& total = squares[second ? 1 : 0];
        for (const NodeId part : second ? b : a) {
            const NodeId square = make(Op::Square, node(sum).format, part);
            total = total == kNoNode ? square : make(Op::Add, node(sum).format, total, square);
        }
    }
    const NodeId both = make(Op::Multiply, node(sum).format, squares[0], squares[1]);
    makesAuxiliary_ = wasAuxiliary;
    return make(Op::Bounded, node(sum).format, sum, both);
}

// Finds the sum of three products, (a.x b.x + a.y b.y) + a.z b.z. Any pairing of factors gives a true bound.
NodeId ProgramBuilder::dotProduct(const Node& node) {
    for (const auto& [pair, last] : {std::pair(node.a, node.b), std::pair(node.b, node.a)}) {
        const Node two = this->node(pair);
        const Node third = this->node(last);
        if (two.op != Op::Add || third.op != Op::Multiply) {
            continue;
        }
        const Node first = this->node(two.a);
        const Node second = this->node(two.b);
        if (first.op != Op::Multiply || second.op != Op::Multiply || isConstant(first.a) ||
            isConstant(second.a) || isConstant(third.a) || isConstant(first.b) || isConstant(second.b) ||
            isConstant(third.b)) {
            continue;
        }
        return boundedDot(appendOnce(node), {first.a, second.a, third.a}, {first.b, second.b, third.b});
    }
    return kNoNode;
}

// The squared numbers of a sum of squares, whatever else is known of the sum. Returns whether it is one.
bool ProgramBuilder::squaresIn(NodeId sum, std::vector<NodeId>& squares) const {
    const Node& at = node(plainOf(bareOf(sum)));
    if (at.op == Op::Add) {
        return squaresIn(at.a, squares) && squaresIn(at.b, squares);
    }
    squares.push_back(at.a);
    return at.op == Op::Square;
}

// x / √(x² + …), x / max(√(x² + …), constant), or x times the inverse square root; and x / max(|x|, …).
NodeId ProgramBuilder::unitQuotient(const Node& given) {
    if (given.format != Format::Single) {
        return kNoNode;
    }
    if (given.op == Op::Multiply) {
        for (const auto& [part, inverse] : {std::pair(given.a, given.b), std::pair(given.b, given.a)}) {
            const Node root = node(inverse);
            if (root.op == Op::Apply && root.function == Function::InverseSqrt) {
                return unitPart(given, part, root.a, 0.0);
            }
        }
        return kNoNode;
    }
    const NodeId divisor = bareOf(given.b);
    Node root = node(divisor);
    double leastLength = 0.0;
    if (root.op == Op::Maximum) {
        std::vector<NodeId> largest;
        operandsOf(Op::Maximum, divisor, largest);
        const bool isScaled = std::any_of(largest.begin(), largest.end(), [&](NodeId id) {
            return node(id).op == Op::Absolute && node(id).a == given.a;
        });
        if (isScaled) {
            return refine(refine(appendOnce(given), Relation::LessEqual, constant(1.0, given.format)),
                          Relation::GreaterEqual, constant(-1.0, given.format));
        }
        if (!isConstant(root.a) && !isConstant(root.b)) {
            return kNoNode;
        }
        const NodeId least = isConstant(root.a) ? root.a : root.b;
        leastLength = node(least).value;
        root = node(least == root.a ? root.b : root.a);
    }
    if (root.op != Op::Apply || root.function != Function::Sqrt) {
        return kNoNode;
    }
    return unitPart(given, given.a, root.a, leastLength);
}

NodeId ProgramBuilder::bareOf(NodeId id) const {
    while (node(id).op == Op::Refine) {
        id = node(id).a;
    }
    return id;
}

void ProgramBuilder::operandsOf(Op op, NodeId id, std::vector<NodeId>& operands) const {
    const Node& at = node(id);
    if (at.op == op) {
        operandsOf(op, at.a, operands);
        operandsOf(op, at.b, operands);
    } else {
        operands.push_back(id);
    }
}

// `given` divides `part` by the root of `length2`, if that has its square.
NodeId ProgramBuilder::unitPart(const Node& given, NodeId part, NodeId length2, double leastLength) {
    std::vector<NodeId> squares;
    if (!squaresIn(length2, squares) || squares.size() < 2) {
        return kNoNode;
    }
    const auto own = std::find(squares.begin(), squares.end(), part);
    if (own == squares.end()) {
        return kNoNode;
    }
    squares.erase(own);
    Node known;
    known.op = Op::UnitQuotient;
    known.format = given.format;
    known.a = appendOnce(given);
    known.c = length2;
    known.value = leastLength;
    const bool wasAuxiliary = std::exchange(makesAuxiliary_, true);
    for (const NodeId other : squares) {
        const NodeId square = make(Op::Square, given.format, other);
        known.b = known.b == kNoNode ? square : make(Op::Add, given.format, known.b, square);
    }
    makesAuxiliary_ = wasAuxiliary;
    return make(known);
}

// The sum of the squares of x / max(|x|, |y|, …), …: one of them is 1.
NodeId ProgramBuilder::sumOfScaled(const Node& given) {
    std::vector<NodeId> parts;
    if (!squaresIn(given.a, parts) || !squaresIn(given.b, parts)) {
        return kNoNode;
    }
    std::vector<NodeId> scaled;
    NodeId divisor = kNoNode;
    for (NodeId part : parts) {
        while (node(part).op == Op::Refine) {
            part = node(part).a;
        }
        const Node& quotient = node(part);
        if (quotient.op != Op::Divide || (divisor != kNoNode && quotient.b != divisor)) {
            return kNoNode;
        }
        divisor = quotient.b;
        scaled.push_back(quotient.a);
    }
    std::vector<NodeId> largest;
    operandsOf(Op::Maximum, divisor, largest);
    const bool isWhole = std::all_of(largest.begin(), largest.end(), [&](NodeId id) {
        return node(id).op == Op::Absolute &&
               std::find(scaled.begin(), scaled.end(), node(id).a) != scaled.end();
    });
    // Squares are not negative, so that rounded sums with the 1 are no less.
    return isWhole ? refine(appendOnce(given), Relation::GreaterEqual, constant(1.0, given.format)) : kNoNode;
}

// The squared length of a vector v that was mirrored about h.
NodeId ProgramBuilder::mirroredSum(const Node& given) {
    std::vector<NodeId> parts;
    if (given.format != Format::Single || !squaresIn(given.a, parts) || !squaresIn(given.b, parts) ||
        parts.size() != 3) {
        return kNoNode;
    }
    std::vector<NodeId> v;
    std::vector<std::pair<NodeId, NodeId>> products;
    for (const NodeId part : parts) {
        const Node& difference = node(part);
        if (difference.op != Op::Subtract || node(difference.a).op != Op::Multiply) {
            return kNoNode;
        }
        products.emplace_back(node(difference.a).a, node(difference.a).b);
        v.push_back(difference.b);
    }
    // The factor that all three have is 2 (v·h).
    for (const NodeId twice : {products[0].first, products[0].second}) {
        std::vector<NodeId> h;
        for (const auto& [first, second] : products) {
            if (first == twice || second == twice) {
                h.push_back(first == twice ? second : first);
            }
        }
        const Node& doubled = node(twice);
        if (h.size() != 3 || doubled.op != Op::Multiply ||
            (!isConstant(doubled.a, 2.0) && !isConstant(doubled.b, 2.0))) {
            continue;
        }
        std::vector<std::pair<NodeId, NodeId>> wanted;
        for (std::size_t k = 0; k < 3; ++k) {
            wanted.emplace_back(std::minmax(h[k], v[k]));
        }
        std::vector<std::pair<NodeId, NodeId>> found;
        std::vector<NodeId> terms;
        operandsOf(Op::Add, plainOf(isConstant(doubled.a, 2.0) ? doubled.b : doubled.a), terms);
        for (const NodeId term : terms) {
            if (node(term).op == Op::Multiply) {
                found.emplace_back(std::minmax(node(term).a, node(term).b));
            }
        }
        std::sort(wanted.begin(), wanted.end());
        std::sort(found.begin(), found.end());
        if (found != wanted) {
            continue;
        }
        const bool wasAuxiliary = std::exchange(makesAuxiliary_, true);
        const auto length2 = [&](const std::vector<NodeId>& of) {
            NodeId sum = kNoNode;
            for (const NodeId component : of) {
                const NodeId square = make(Op::Square, given.format, component);
                sum = sum == kNoNode ? square : make(Op::Add, given.format, sum, square);
            }
            return sum;
        };
        const NodeId ofV = length2(v);
        const NodeId ofH = length2(h);
        makesAuxiliary_ = wasAuxiliary;
        return make(Op::MirroredSum, given.format, appendOnce(given), ofV, ofH);
    }
    return kNoNode;
}

// Minkowski's inequality. Any pairs of terms give a true bound.
NodeId ProgramBuilder::triangleSum(const Node& given) {
    std::vector<NodeId> parts;
    if (given.format != Format::Single || !squaresIn(given.a, parts) || !squaresIn(given.b, parts) ||
        parts.size() != 3) {
        return kNoNode;
    }
    const bool wasAuxiliary = std::exchange(makesAuxiliary_, true);
    NodeId length2[2] = {kNoNode, kNoNode};
    bool areSums = true;
    for (const NodeId part : parts) {
        const Node sum = node(plainOf(part));
        areSums = areSums && (sum.op == Op::Add || sum.op == Op::Subtract);
        for (const bool second : {false, true}) {
            if (areSums) {
                const NodeId square = make(Op::Square, given.format, second ? sum.b : sum.a);
                NodeId& total = length2[second ? 1 : 0];
                total = total == kNoNode ? square : make(Op::Add, given.format, total, square);
            }
        }
    }
    NodeId bound = kNoNode;
    if (areSums) {
        const NodeId both = make(Op::Add, given.format, apply(Function::Sqrt, given.format, length2[0]),
                                 apply(Function::Sqrt, given.format, length2[1]));
        bound = make(Op::Square, given.format, both);
    }
    makesAuxiliary_ = wasAuxiliary;
    return areSums ? make(Op::TriangleSum, given.format, appendOnce(given), bound) : kNoNode;
}

ProgramBuilder::UnitComponent ProgramBuilder::unitComponentOf(NodeId id) {
    const Node at = node(id);
    switch (at.op) {
        case Op::Normalized:
            return {at.a, at.c, kNoNode, 0.0};
        case Op::UnitQuotient: {
            const Node& quotient = node(at.a);
            const bool isFirst = quotient.op == Op::Divide || node(quotient.b).op == Op::Apply;
            return {isFirst ? quotient.a : quotient.b, at.c, kNoNode, at.value};
        }
        case Op::Negate:
        case Op::Refine:
            return unitComponentOf(at.a);
        case Op::Multiply:
            for (const auto& [part, factor] : {std::pair(at.a, at.b), std::pair(at.b, at.a)}) {
                UnitComponent found = unitComponentOf(part);
                if (found.of != kNoNode && found.weight == kNoNode) {
                    found.weight = factor;
                    return found;
                }
            }
            return {};
        case Op::Divide: {
            UnitComponent found = unitComponentOf(at.a);
            if (found.of != kNoNode && found.weight == kNoNode) {
                found.weight = make(Op::Divide, at.format, constant(1.0, at.format), at.b);
                return found;
            }
            return {};
        }
        default:
            return {};
    }
}

// A sum of squares with these weights before they are squared, whose sum without weights is `one`.
NodeId ProgramBuilder::weightedSum(const Node& sum, NodeId one, const std::vector<NodeId>& weights) {
    const NodeId whole = appendOnce(sum);
    const bool wasAuxiliary = std::exchange(makesAuxiliary_, true);
    NodeId least = kNoNode;
    NodeId greatest = kNoNode;
    for (const NodeId weight : weights) {
        const NodeId square = make(Op::Square, sum.format, weight);
        least = least == kNoNode ? square : make(Op::Minimum, sum.format, least, square);
        greatest = greatest == kNoNode ? square : make(Op::Maximum, sum.format, greatest, square);
    }
    least = make(Op::Multiply, sum.format, least, one);
    greatest = make(Op::Multiply, sum.format, greatest, one);
    makesAuxiliary_ = wasAuxiliary;
    return make(Op::WeightedUnit, sum.format, whole, least, greatest);
}

NodeId ProgramBuilder::sumOfNormalized(const Node& given) {
    std::vector<NodeId> parts;
    if (!squaresIn(given.a, parts) || !squaresIn(given.b, parts)) {
        return kNoNode;
    }
    const bool wasAuxiliary = std::exchange(makesAuxiliary_, true);
    const auto found = base::mapped<UnitComponent>(parts, [&](NodeId part) { return unitComponentOf(part); });
    const NodeId one = constant(1.0, given.format);
    makesAuxiliary_ = wasAuxiliary;
    std::vector<NodeId> components;
    std::vector<NodeId> weights;
    bool isWeighted = false;
    Node known;
    known.format = given.format;
    for (const UnitComponent& part : found) {
        if (part.of == kNoNode || part.length2 != found.front().length2) {
            return kNoNode;
        }
        components.push_back(part.of);
        isWeighted = isWeighted || part.weight != kNoNode;
        weights.push_back(part.weight == kNoNode ? one : part.weight);
        known.value = std::max(known.value, part.leastLength);
    }
    std::sort(components.begin(), components.end());
    if (std::adjacent_find(components.begin(), components.end()) != components.end()) {
        return kNoNode;
    }
    std::vector<NodeId> all;
    const bool isSum = squaresIn(found.front().length2, all);
    std::sort(all.begin(), all.end());
    const bool isWhole = isSum && all == components;
    known.op = isWhole ? Op::UnitSum : Op::PartOfUnit;
    known.b = found.front().length2;
    if (!isWeighted) {
        known.a = appendOnce(given);
        return make(known);
    }
    if (!isWhole) {
        return kNoNode;
    }
    // 1, where the vector is normalised.
    const bool outside = std::exchange(makesAuxiliary_, true);
    NodeId sum = kNoNode;
    for (const NodeId part : parts) {
        NodeId bare = part;
        while (node(bare).op != Op::Normalized && node(bare).op != Op::UnitQuotient) {
            const Node at = node(bare);
            bare = at.op == Op::Multiply && unitComponentOf(at.a).of == kNoNode ? at.b : at.a;
        }
        const NodeId square = make(Op::Square, given.format, bare);
        sum = sum == kNoNode ? square : make(Op::Add, given.format, sum, square);
    }
    makesAuxiliary_ = outside;
    return weightedSum(given, sum, weights);
}

bool ProgramBuilder::isSineOf(NodeId id, NodeId& cosine, NodeId& factor) {
    const Node at = node(id);
    if (at.op == Op::Multiply) {
        for (const auto& [sine, other] : {std::pair(at.a, at.b), std::pair(at.b, at.a)}) {
            if (isSineOf(sine, cosine, factor)) {
                factor = make(Op::Multiply, at.format, factor, other);
                return true;
            }
        }
        return false;
    }
    if (at.op == Op::Divide && isSineOf(at.a, cosine, factor)) {
        factor = make(Op::Divide, at.format, factor, at.b);
        return true;
    }
    if (at.op != Op::Apply || at.function != Function::Sqrt) {
        return false;
    }
    const Node limited = node(at.a);
    const bool isLimited = limited.op == Op::Maximum && isConstant(limited.b, 0.0);
    const Node product = isLimited ? node(limited.a) : limited;
    if (product.op != Op::Multiply) {
        return false;
    }
    for (const auto& [minus, plus] : {std::pair(product.a, product.b), std::pair(product.b, product.a)}) {
        const Node& m = node(minus);
        const Node& p = node(plus);
        if (m.op == Op::Subtract && isConstant(m.a, 1.0) && p.op == Op::Add &&
            ((p.a == m.b && isConstant(p.b, 1.0)) || (p.b == m.b && isConstant(p.a, 1.0)))) {
            cosine = m.b;
            factor = constant(1.0, at.format);
            return true;
        }
    }
    return false;
}

bool ProgramBuilder::factorOf(NodeId product, NodeId part, NodeId& factor) {
    if (product == part) {
        factor = constant(1.0, node(product).format);
        return true;
    }
    const Node at = node(product);
    if (at.op != Op::Multiply && at.op != Op::Divide) {
        return false;
    }
    if (factorOf(at.a, part, factor)) {
        factor = make(at.op, at.format, factor, at.b);
        return true;
    }
    if (at.op == Op::Multiply && factorOf(at.b, part, factor)) {
        factor = make(Op::Multiply, at.format, factor, at.a);
        return true;
    }
    return false;
}

// (a s cos t)² + (b s sin t)² + (c z)², where s is the sine that belongs to the cosine z.
NodeId ProgramBuilder::squaredRadius(const Node& given) {
    for (const auto& [circle, last] : {std::pair(given.a, given.b), std::pair(given.b, given.a)}) {
        const Node around = node(circle);
        const Node square = node(last);
        if (around.op != Op::CircleSum || square.op != Op::Square) {
            continue;
        }
        NodeId cosine = kNoNode;
        NodeId otherCosine = kNoNode;
        NodeId factor = kNoNode;
        NodeId otherFactor = kNoNode;
        NodeId factorOfCosine = kNoNode;
        const bool wasAuxiliary = std::exchange(makesAuxiliary_, true);
        const bool areSines = isSineOf(around.a, cosine, factor) &&
                              isSineOf(around.b, otherCosine, otherFactor) && cosine == otherCosine &&
                              factorOf(square.a, cosine, factorOfCosine);
        const NodeId one = constant(1.0, given.format);
        makesAuxiliary_ = wasAuxiliary;
        if (!areSines) {
            continue;
        }
        if (factor == otherFactor && factor == factorOfCosine) {
            return make(Op::SphereSum, given.format, factor, appendOnce(given));
        }
        return weightedSum(given, one, {factor, otherFactor, factorOfCosine});
    }
    return kNoNode;
}

}  // namespace glint::verify
