// Sums whose terms cancel: x + (1 - x). A program's values are expanded as polynomials of those values that
// are no sums or products; where terms cancel, the polynomial bounds the value better than its operands do.
// The polynomials are about real numbers. Those of few variables are bounded by their Bernstein coefficients
// (Cargo and Shisha 1966, "The Bernstein form of a polynomial"). The rounding errors are bounded operation by
// operation for each box.
#pragma once

#include "verify/interval.h"
#include "verify/program.h"

#include <map>
#include <optional>
#include <span>
#include <vector>

namespace glint::verify {

class Identities {
public:
    explicit Identities(const Program& program);

    // Must be called before the first bound() for another box.
    void forgetBox();
    // Encloses the value of a node, given the values of those before it. The interval is everything where
    // nothing cancels.
    Interval bound(NodeId id, std::span<const Interval> values);

private:
    // A sorted list of nodes; with kReciprocal, 1 / node.
    using Monomial = std::vector<NodeId>;
    struct Coefficient {
        double value = 0.0;
        double weight = 0.0;  // of the terms that were added up: bounds the rounding error of the doubles
    };
    using Polynomial = std::map<Monomial, Coefficient>;
    // A multiple of a divisor that was cancelled: monomial × divisor / divisor.
    struct Cancelled {
        Monomial monomial;
        double factor = 0.0;
        NodeId divisor = kNoNode;
    };
    struct Variable {
        NodeId node = kNoNode;
        std::size_t degree = 0;
    };
    struct Expansion {
        Polynomial terms;
        std::vector<Variable> variables;  // if Bernstein's form bounds it
        std::vector<Cancelled> cancelled;
        bool isIdentity = false;
    };

    void expand(NodeId id);
    std::optional<Polynomial> expansionOf(const Node& node) const;
    bool reduce(Expansion& expansion) const;
    const Polynomial* termsOf(NodeId id) const;
    NodeId bareOf(NodeId id) const;
    static void addTo(Polynomial& sum, const Polynomial& terms, double factor);
    std::optional<Polynomial> product(const Polynomial& a, const Polynomial& b) const;
    static std::vector<Variable> variablesOf(const Polynomial& terms);
    Interval bernstein(const Expansion& expansion, NodeId before, std::span<const Interval> values) const;
    static bool cancels(const Polynomial& sum, const Polynomial& a, const Polynomial& b);

    double errorOf(NodeId id, std::span<const Interval> values);
    // `before` is the node that is being bounded; later ones have no value yet.
    Interval valueOf(const Monomial& monomial, NodeId before, std::span<const Interval> values) const;

    const Program& program_;
    std::vector<std::optional<Expansion>> expansions_;  // no value for a node that stays one factor
    // The last node that has a node's value and knows more of it.
    std::map<NodeId, NodeId> refined_;
    std::vector<double> errors_;  // of the box; negative: not computed yet
    std::vector<NodeId> computed_;
};

}  // namespace glint::verify
