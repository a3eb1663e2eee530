#include "verify/specialise.h"

#include "verify/evaluate.h"
#include "verify/program_builder.h"

#include <utility>

namespace glint::verify {
namespace {

class Specialiser {
public:
    Specialiser(const Program& program, std::span<const Interval> domain)
        : program_(program), values_(program), made_(program.nodes.size(), kNoNode) {
        values_.run(domain, false);
    }

    Program run() {
        for (NodeId id = 0; id < program_.nodes.size(); ++id) {
            made_[id] = remade(id);
        }
        Program result = builder_.take();
        for (const NodeId output : program_.outputs) {
            result.outputs.push_back(made_[output]);
        }
        result.inputCount = program_.inputCount;
        return result;
    }

private:
    NodeId madeOf(NodeId id) const {
        return id == kNoNode ? kNoNode : made_[id];
    }
    // Returns whether the node is never computed.
    bool isDead(NodeId id) const {
        return values_.value(id).isEmpty();
    }
    bool isTaken(NodeId guard) const {
        return guard == kNoNode || !(isDead(guard) || values_.value(guard).isFalse());
    }

    NodeId remade(NodeId id) {
        const Node& node = program_.nodes[id];
        if (node.op == Op::Constant) {
            return builder_.constant(node.value, node.format, node.isSigned);
        }
        if (node.op == Op::Input) {
            return builder_.input(static_cast<std::uint32_t>(node.value), node.format);
        }
        const Interval& value = values_.value(id);
        // Truth values that are the same over the domain. Nothing needs the value of a node that is never
        // computed.
        const bool isTruth = node.op == Op::Less || node.op == Op::LessEqual || node.op == Op::Equal ||
                             node.op == Op::And || node.op == Op::Or || node.op == Op::Not;
        if (isDead(id) || (isTruth && value.isPoint())) {
            return builder_.constant(isDead(id) ? 0.0 : value.low, node.format, node.isSigned);
        }
        const NodeId guard = madeOf(node.guard);
        builder_.setGuard(guard == kNoNode || builder_.isConstant(guard) ? kNoNode : guard);
        if (const NodeId chosen = onlyChoice(node); chosen != kNoNode) {
            return made_[chosen];
        }
        if (node.op == Op::Merge) {
            return remadeMerge(node);
        }
        Node made = node;
        made.a = madeOf(node.a);
        made.b = madeOf(node.b);
        made.c = madeOf(node.c);
        return builder_.remake(made);
    }

    // The one operand that a choice always takes; kNoNode if there are more.
    NodeId onlyChoice(const Node& node) const {
        switch (node.op) {
            case Op::Select:
                return values_.value(node.a).isTrue()    ? node.b
                       : values_.value(node.a).isFalse() ? node.c
                                                         : kNoNode;
            case Op::Minimum:
            case Op::Maximum: {
                const Interval& a = values_.value(node.a);
                const Interval& b = values_.value(node.b);
                const bool isA = node.op == Op::Maximum ? a.low >= b.high : a.high <= b.low;
                const bool isB = node.op == Op::Maximum ? b.low >= a.high : b.high <= a.low;
                return isA ? node.a : isB ? node.b : kNoNode;
            }
            default:
                return kNoNode;
        }
    }

    NodeId remadeMerge(const Node& node) {
        std::vector<Edge> edges;
        for (std::uint32_t k = 0; k < node.count; ++k) {
            const Edge& edge = program_.edges[node.first + k];
            if (isTaken(edge.guard)) {
                edges.push_back({madeOf(edge.guard), made_[edge.value]});
            }
        }
        return builder_.merge(edges);
    }

    const Program& program_;
    BoxEvaluator values_;
    ProgramBuilder builder_;
    std::vector<NodeId> made_;
};

}  // namespace

Program specialise(const Program& program, std::span<const Interval> domain) {
    return Specialiser(program, domain).run();
}

}  // namespace glint::verify
