#include "verify/program_builder.h"

#include "verify/concrete.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace glint::verify {
namespace {

bool isCommutative(Op op) {
    switch (op) {
        case Op::Add:
        case Op::Multiply:
        case Op::And:
        case Op::Or:
        case Op::Equal:
        case Op::IntegerAdd:
        case Op::IntegerMultiply:
        case Op::BitAnd:
        case Op::BitOr:
        case Op::BitXor:
            return true;
        default:
            return false;
    }
}

}  // namespace

NodeId ProgramBuilder::append(const Node& node) {
    program_.nodes.push_back(node);
    return static_cast<NodeId>(program_.nodes.size() - 1);
}

bool ProgramBuilder::covers(NodeId outer) const {
    if (outer == kNoNode) {
        return true;
    }
    // A guard is the one around it and a condition.
    std::vector<NodeId> pending{guard_};
    while (!pending.empty()) {
        const NodeId at = pending.back();
        pending.pop_back();
        if (at == outer) {
            return true;
        }
        if (at != kNoNode && node(at).op == Op::And) {
            pending.push_back(node(at).a);
            pending.push_back(node(at).b);
        }
    }
    return false;
}

NodeId ProgramBuilder::constant(double value, Format format, bool isSigned) {
    Node node;
    node.format = format;
    node.isSigned = isSigned;
    node.value = value == 0.0 ? 0.0 : value;  // one zero
    const Key key{node.op, format,  node.function, node.relation, isSigned,
                  kNoNode, kNoNode, kNoNode,       node.value};
    std::vector<NodeId>& found = known_[key];
    if (found.empty()) {
        found.push_back(append(node));
    }
    return found.front();
}

NodeId ProgramBuilder::input(std::uint32_t number, Format format) {
    Node node;
    node.op = Op::Input;
    node.format = format;
    node.value = number;
    const Key key{node.op, format,  node.function, node.relation, false,
                  kNoNode, kNoNode, kNoNode,       node.value};
    std::vector<NodeId>& found = known_[key];
    if (found.empty()) {
        program_.inputCount = std::max(program_.inputCount, number + 1);
        found.push_back(append(node));
    }
    return found.front();
}

NodeId ProgramBuilder::make(Op op, Format format, NodeId a, NodeId b, NodeId c) {
    Node node;
    node.op = op;
    node.format = format;
    node.a = a;
    node.b = b;
    node.c = c;
    return make(node);
}

NodeId ProgramBuilder::apply(Function function, Format format, NodeId a) {
    Node node;
    node.op = Op::Apply;
    node.function = function;
    node.format = format;
    node.a = a;
    return make(node);
}

NodeId ProgramBuilder::refine(NodeId a, Relation relation, NodeId b) {
    if (isConstant(a)) {
        return a;
    }
    Node node;
    node.op = Op::Refine;
    node.format = this->node(a).format;
    node.isSigned = this->node(a).isSigned;
    node.relation = relation;
    node.a = a;
    node.b = b;
    return make(node);
}

NodeId ProgramBuilder::make(Node node) {
    node.guard = guard_;
    node.isAuxiliary = makesAuxiliary_;
    if (isCommutative(node.op) && node.b < node.a) {
        std::swap(node.a, node.b);
    }
    if (const NodeId simple = simplified(node); simple != kNoNode) {
        return simple;
    }
    return appendOnce(node);
}

NodeId ProgramBuilder::remake(const Node& node) {
    // The builder knows as much of the operation as the other one did, or more.
    const NodeId known =
        isBound(node.op) ? std::array{node.a, node.b, node.c}[boundedOperand(node.op)] : kNoNode;
    if (known != kNoNode && (isConstant(known) || this->node(known).op == node.op)) {
        return known;
    }
    const bool wasAuxiliary = std::exchange(makesAuxiliary_, node.isAuxiliary);
    const NodeId made = make(node);
    makesAuxiliary_ = wasAuxiliary;
    return made;
}

NodeId ProgramBuilder::folded(const Node& node) {
    if (node.op == Op::Refine || node.op == Op::Input || node.op == Op::Merge) {
        return kNoNode;
    }
    double values[3] = {};
    int index = 0;
    for (const NodeId operand : {node.a, node.b, node.c}) {
        if (operand != kNoNode) {
            if (!isConstant(operand)) {
                return kNoNode;
            }
            values[index] = this->node(operand).value;
        }
        ++index;
    }
    const double value = evaluateNode(node, values[0], values[1], values[2]);
    // An operation that fails stays, so that the failure is found where it happens.
    return std::isfinite(value) ? constant(value, node.format, node.isSigned) : kNoNode;
}

NodeId ProgramBuilder::firstOf(const Node& node, std::initializer_list<Pattern> patterns) {
    for (const Pattern pattern : patterns) {
        if (const NodeId found = (this->*pattern)(node); found != kNoNode) {
            return found;
        }
    }
    return kNoNode;
}

NodeId ProgramBuilder::product(const Node& node) {
    if (node.a == node.b) {
        return make(Op::Square, node.format, node.a);
    }
    if (isConstant(node.a, 1.0) || isConstant(node.b, 1.0)) {
        return isConstant(node.a, 1.0) ? node.b : node.a;
    }
    // Factors are finite, or the operation that made them fails.
    if (isConstant(node.a, 0.0) || isConstant(node.b, 0.0)) {
        return constant(0.0, node.format);
    }
    return firstOf(node,
                   {&ProgramBuilder::intoChoice, &ProgramBuilder::unitQuotient, &ProgramBuilder::share});
}

NodeId ProgramBuilder::sum(const Node& node) {
    if (isConstant(node.a, 0.0) || isConstant(node.b, 0.0)) {
        return isConstant(node.a, 0.0) ? node.b : node.a;
    }
    return firstOf(
        node, {&ProgramBuilder::intoChoice, &ProgramBuilder::sumOfShares, &ProgramBuilder::interpolation,
               &ProgramBuilder::errorFree, &ProgramBuilder::sumOfSquares, &ProgramBuilder::sumOfNormalized,
               &ProgramBuilder::squaredRadius, &ProgramBuilder::sumOfScaled, &ProgramBuilder::mirroredSum,
               &ProgramBuilder::triangleSum, &ProgramBuilder::dotProduct});
}

NodeId ProgramBuilder::square(const Node& node) {
    const Node of = this->node(node.a);
    if (of.op == Op::Select) {
        const NodeId yes = make(Op::Square, node.format, of.b);
        return make(Op::Select, node.format, of.a, yes, make(Op::Square, node.format, of.c));
    }
    if (of.op == Op::Negate) {
        return make(Op::Square, node.format, of.a);
    }
    return of.op == Op::Apply && of.function == Function::Sqrt
               ? make(Op::SquareOfRoot, node.format, of.a, appendOnce(node))
               : kNoNode;
}

NodeId ProgramBuilder::simplified(const Node& node) {
    if (const NodeId value = folded(node); value != kNoNode) {
        return value;
    }
    switch (node.op) {
        case Op::Multiply:
            return product(node);
        case Op::Add:
            return sum(node);
        case Op::Square:
            return square(node);
        case Op::Subtract:
            if (this->node(node.b).op == Op::Floor && this->node(node.b).a == node.a) {
                const NodeId rest = appendOnce(node);
                return refine(refine(rest, Relation::GreaterEqual, constant(0.0, node.format)),
                              Relation::LessEqual, constant(1.0, node.format));
            }
            return isConstant(node.b, 0.0) ? node.a : errorFree(node);
        case Op::Divide:
            return isConstant(node.b, 1.0)
                       ? node.a
                       : firstOf(node, {&ProgramBuilder::unitQuotient, &ProgramBuilder::quotientOfLess,
                                        &ProgramBuilder::share});
        case Op::Minimum:
        case Op::Maximum:
            return node.a == node.b ? node.a : limited(node);
        case Op::And:
        case Op::Or:
            for (const auto& [one, other] : {std::pair(node.a, node.b), std::pair(node.b, node.a)}) {
                if (isConstant(one)) {
                    return isConstant(one, 0.0) == (node.op == Op::And) ? one : other;
                }
            }
            return node.a == node.b ? node.a : kNoNode;
        case Op::Not:
            return this->node(node.a).op == Op::Not ? this->node(node.a).a : kNoNode;
        case Op::Select:
            if (isConstant(node.a)) {
                return isConstant(node.a, 0.0) ? node.c : node.b;
            }
            if (node.b == node.c) {
                return node.b;
            }
            // A choice within a choice by the same condition.
            if (const Node& no = this->node(node.c); no.op == Op::Select && no.a == node.a) {
                return make(Op::Select, node.format, node.a, node.b, no.c);
            }
            if (const Node& yes = this->node(node.b); yes.op == Op::Select && yes.a == node.a) {
                return make(Op::Select, node.format, node.a, yes.b, node.c);
            }
            return kNoNode;
        case Op::Convert:
            return this->node(node.a).format == node.format ? node.a : kNoNode;
        case Op::ShiftRight:
            return shifted(node);
        case Op::BitAnd:
            return isConstant(node.a, 0.0) ? node.a : isConstant(node.b, 0.0) ? node.b : kNoNode;
        default:
            return kNoNode;
    }
}

// Appends a node that simplified() has been asked about, unless it is there already.
NodeId ProgramBuilder::appendOnce(const Node& node) {
    const Key key{node.op, node.format, node.function, node.relation, node.isSigned,
                  node.a,  node.b,      node.c,        node.value};
    std::vector<NodeId>& found = known_[key];
    for (const NodeId id : found) {
        if (covers(this->node(id).guard)) {
            program_.nodes[id].isAuxiliary = program_.nodes[id].isAuxiliary && node.isAuxiliary;
            return id;
        }
    }
    const NodeId id = append(node);
    known_[key].push_back(id);
    return id;
}

NodeId ProgramBuilder::opposite(NodeId a) {
    if (a == kNoNode) {
        return truth(false);
    }
    return make(Op::Not, Format::Integer, a);
}

NodeId ProgramBuilder::both(NodeId a, NodeId b) {
    if (a == kNoNode) {
        return b;
    }
    if (b == kNoNode) {
        return a;
    }
    return make(Op::And, Format::Integer, a, b);
}

NodeId ProgramBuilder::either(NodeId a, NodeId b) {
    if (a == kNoNode || b == kNoNode || a == opposite(b)) {
        return kNoNode;
    }
    if (a == b) {
        return a;
    }
    // (g and c) or (g and not c) is g; (g and c) or (g and not c and d) keeps its form.
    const Node& x = node(a);
    const Node& y = node(b);
    if (x.op == Op::And && y.op == Op::And) {
        for (const auto& [g, c] : {std::pair(x.a, x.b), std::pair(x.b, x.a)}) {
            for (const auto& [h, d] : {std::pair(y.a, y.b), std::pair(y.b, y.a)}) {
                if (g == h &&
                    (node(d).op == Op::Not ? node(d).a == c : node(c).op == Op::Not && node(c).a == d)) {
                    return g;
                }
            }
        }
    }
    return make(Op::Or, Format::Integer, a, b);
}

NodeId ProgramBuilder::merge(const std::vector<Edge>& edges) {
    const bool same = std::all_of(edges.begin(), edges.end(),
                                  [&](const Edge& edge) { return edge.value == edges.front().value; });
    if (same) {
        return edges.front().value;
    }
    Node merged;
    merged.op = Op::Merge;
    merged.format = node(edges.front().value).format;
    merged.isSigned = node(edges.front().value).isSigned;
    merged.guard = guard_;
    merged.first = static_cast<std::uint32_t>(program_.edges.size());
    merged.count = static_cast<std::uint32_t>(edges.size());
    program_.edges.insert(program_.edges.end(), edges.begin(), edges.end());
    return append(merged);
}

}  // namespace glint::verify
