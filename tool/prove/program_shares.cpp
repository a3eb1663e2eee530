// Shares of a sum, x / (x + y): at most 1 where no part is negative, however far the bounds of the parts are
// apart.
#include "prove/program.h"

#include <algorithm>
#include <utility>

namespace glint::prove {
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

}  // namespace glint::prove
