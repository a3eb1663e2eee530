// Makes programs, and recognises what sequences of operations mean.
#pragma once

#include "verify/program.h"

#include <initializer_list>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

namespace glint::verify {

// Appends nodes to a program. Equal operations become one node, constants are folded, and sequences of
// operations with a known meaning become the operation that they are.
class ProgramBuilder {
public:
    NodeId constant(double value, Format format, bool isSigned = false);
    NodeId input(std::uint32_t number, Format format);
    NodeId truth(bool value) {
        return constant(value ? 1.0 : 0.0, Format::Integer);
    }
    // Makes an operation under the current guard. It uses the op, the format, the operands and the
    // operation's own members of `given`.
    NodeId make(Node given);
    NodeId make(Op op, Format format, NodeId a, NodeId b = kNoNode, NodeId c = kNoNode);
    // Makes a node of another program, whose operands are of this one. Keeps its known bounds.
    NodeId remake(const Node& node);
    NodeId apply(Function function, Format format, NodeId a);
    NodeId refine(NodeId a, Relation relation, NodeId b);
    // A dot product, which is no larger than the product of the lengths: `sum`, or an equal node that is
    // known.
    NodeId boundedDot(NodeId sum, const std::vector<NodeId>& a, const std::vector<NodeId>& b);
    NodeId merge(const std::vector<Edge>& edges);
    NodeId both(NodeId a, NodeId b);    // a and b; kNoNode is true
    NodeId either(NodeId a, NodeId b);  // a or b
    NodeId opposite(NodeId a);

    void setGuard(NodeId guard) {
        guard_ = guard;
    }
    NodeId guard() const {
        return guard_;
    }
    const Node& node(NodeId id) const {
        return program_.nodes[id];
    }
    bool isConstant(NodeId id) const {
        return program_.nodes[id].op == Op::Constant;
    }
    bool isConstant(NodeId id, double value) const {
        return isConstant(id) && program_.nodes[id].value == value;
    }
    Program take() {
        return std::move(program_);
    }
    Program& program() {
        return program_;
    }

private:
    using Key = std::tuple<Op, Format, Function, Relation, bool, NodeId, NodeId, NodeId, double>;

    NodeId append(const Node& node);
    NodeId appendOnce(const Node& node);
    NodeId simplified(const Node& node);
    NodeId product(const Node& node);
    NodeId sum(const Node& node);
    NodeId square(const Node& node);
    using Pattern = NodeId (ProgramBuilder::*)(const Node& node);
    NodeId firstOf(const Node& node, std::initializer_list<Pattern> patterns);
    NodeId errorFree(const Node& node);
    // A factor of a product that is the sine or the cosine of an angle, and the rest of the product.
    struct Angular {
        NodeId angle = kNoNode;
        bool isSine = false;
        NodeId rest = kNoNode;
    };
    Angular angularOf(NodeId id);
    NodeId sumOfSquares(const Node& node);
    NodeId interpolation(const Node& node);
    NodeId shifted(const Node& node);
    NodeId dotProduct(const Node& node);
    // A component of a normalised vector, times a weight.
    struct UnitComponent {
        NodeId of = kNoNode;  // the vector's component before
        NodeId length2 = kNoNode;
        NodeId weight = kNoNode;  // kNoNode: 1
        double leastLength = 0.0;
    };
    UnitComponent unitComponentOf(NodeId id);
    bool squaresIn(NodeId sum, std::vector<NodeId>& squares) const;
    NodeId sumOfNormalized(const Node& node);
    using Factors = std::vector<NodeId>;
    // Shares of a sum.
    NodeId withoutRefinement(NodeId id) const;
    void factorsOf(NodeId id, NodeId divisor, Factors& factors) const;
    void divisorsOf(NodeId id, std::vector<NodeId>& divisors) const;
    bool isSumWith(NodeId id, const std::vector<NodeId>& parts, int depth) const;
    bool termsOf(NodeId id, const std::vector<NodeId>& parts, std::vector<Factors>& terms, int depth) const;
    NodeId sumOfTerms(const std::vector<Factors>& terms, Format format);
    NodeId shareOf(NodeId value, std::vector<Factors> own, NodeId divisor);
    NodeId share(const Node& node);
    NodeId sumOfShares(const Node& node);
    NodeId limited(const Node& node);
    NodeId sumOfScaled(const Node& node);
    NodeId mirroredSum(const Node& node);
    NodeId quotientOfLess(const Node& node);
    NodeId triangleSum(const Node& node);
    NodeId intoChoice(const Node& node);
    NodeId weightedSum(const Node& sum, NodeId one, const std::vector<NodeId>& weights);
    NodeId bareOf(NodeId id) const;  // without refinements
    void operandsOf(Op op, NodeId id, std::vector<NodeId>& operands) const;
    NodeId unitPart(const Node& node, NodeId part, NodeId length2, double leastLength);
    NodeId unitQuotient(const Node& node);
    NodeId squaredRadius(const Node& node);
    // Returns whether `product` is `part` times a factor.
    bool factorOf(NodeId product, NodeId part, NodeId& factor);
    // Returns whether the node is √((1 - z)(1 + z)) times a factor.
    bool isSineOf(NodeId id, NodeId& cosine, NodeId& factor);
    NodeId folded(const Node& node);
    // Returns whether a value that is computed under `outer` is known under the current guard.
    bool covers(NodeId outer) const;
    // Returns the operation that the shader has.
    NodeId plainOf(NodeId id) const;
    bool isHighOf(NodeId high, NodeId of) const;
    bool isLowOf(NodeId low, NodeId of) const;
    bool isProductOf(NodeId product, NodeId a, NodeId b) const;
    bool isSumOf(NodeId sum, NodeId a, NodeId b) const;

    Program program_;
    std::map<Key, std::vector<NodeId>> known_;
    struct KnownShare {
        std::vector<Factors> terms;
        NodeId divisor = kNoNode;
    };
    std::map<NodeId, KnownShare> shares_;
    NodeId guard_ = kNoNode;
    bool makesAuxiliary_ = false;
};

}  // namespace glint::verify
