#include "verify/program_builder.h"

#include "verify/concrete.h"

#include <algorithm>
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
    const NodeId known = node.op == Op::CircleSum                                  ? node.c
                         : node.op == Op::SquareOfRoot || node.op == Op::SphereSum ? node.b
                         : node.op == Op::Bounded || node.op == Op::UnitSum || node.op == Op::PartOfUnit ||
                                 node.op == Op::WeightedUnit || node.op == Op::UnitQuotient ||
                                 node.op == Op::Share || node.op == Op::TriangleSum
                             ? node.a
                             : kNoNode;
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

NodeId ProgramBuilder::simplified(const Node& node) {
    if (const NodeId value = folded(node); value != kNoNode) {
        return value;
    }
    switch (node.op) {
        case Op::Multiply:
            if (node.a == node.b) {
                return make(Op::Square, node.format, node.a);
            }
            if (isConstant(node.a, 1.0)) {
                return node.b;
            }
            if (isConstant(node.b, 1.0)) {
                return node.a;
            }
            // Factors are finite, or the operation that made them fails.
            if (isConstant(node.a, 0.0) || isConstant(node.b, 0.0)) {
                return constant(0.0, node.format);
            }
            if (const NodeId choice = intoChoice(node); choice != kNoNode) {
                return choice;
            }
            if (const NodeId part = unitQuotient(node); part != kNoNode) {
                return part;
            }
            return share(node);
        case Op::Add:
            if (isConstant(node.a, 0.0)) {
                return node.b;
            }
            if (isConstant(node.b, 0.0)) {
                return node.a;
            }
            if (const NodeId choice = intoChoice(node); choice != kNoNode) {
                return choice;
            }
            if (const NodeId sum = sumOfShares(node); sum != kNoNode) {
                return sum;
            }
            if (const NodeId between = interpolation(node); between != kNoNode) {
                return between;
            }
            if (const NodeId exact = errorFree(node); exact != kNoNode) {
                return exact;
            }
            if (const NodeId sum = sumOfSquares(node); sum != kNoNode) {
                return sum;
            }
            if (const NodeId sum = sumOfNormalized(node); sum != kNoNode) {
                return sum;
            }
            for (const auto pattern : {&ProgramBuilder::squaredRadius, &ProgramBuilder::sumOfScaled,
                                       &ProgramBuilder::mirroredSum, &ProgramBuilder::triangleSum}) {
                if (const NodeId sum = (this->*pattern)(node); sum != kNoNode) {
                    return sum;
                }
            }
            return dotProduct(node);
        case Op::Square:
            if (const Node choice = this->node(node.a); choice.op == Op::Select) {
                const NodeId yes = make(Op::Square, node.format, choice.b);
                return make(Op::Select, node.format, choice.a, yes, make(Op::Square, node.format, choice.c));
            }
            if (this->node(node.a).op == Op::Negate) {
                return make(Op::Square, node.format, this->node(node.a).a);
            }
            if (this->node(node.a).op == Op::Apply && this->node(node.a).function == Function::Sqrt) {
                const NodeId root = node.a;
                return make(Op::SquareOfRoot, node.format, this->node(root).a, appendOnce(node));
            }
            return kNoNode;
        case Op::Subtract:
            if (this->node(node.b).op == Op::Floor && this->node(node.b).a == node.a) {
                const NodeId rest = appendOnce(node);
                return refine(refine(rest, Relation::GreaterEqual, constant(0.0, node.format)),
                              Relation::LessEqual, constant(1.0, node.format));
            }
            return isConstant(node.b, 0.0) ? node.a : errorFree(node);
        case Op::Divide:
            if (isConstant(node.b, 1.0)) {
                return node.a;
            }
            if (const NodeId part = unitQuotient(node); part != kNoNode) {
                return part;
            }
            if (const NodeId less = quotientOfLess(node); less != kNoNode) {
                return less;
            }
            return share(node);
        case Op::Minimum:
        case Op::Maximum:
            return node.a == node.b ? node.a : limited(node);
        case Op::And:
            if (isConstant(node.a)) {
                return isConstant(node.a, 0.0) ? node.a : node.b;
            }
            if (isConstant(node.b)) {
                return isConstant(node.b, 0.0) ? node.b : node.a;
            }
            return node.a == node.b ? node.a : kNoNode;
        case Op::Or:
            if (isConstant(node.a)) {
                return isConstant(node.a, 0.0) ? node.b : node.a;
            }
            if (isConstant(node.b)) {
                return isConstant(node.b, 0.0) ? node.a : node.b;
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
