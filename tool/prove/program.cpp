#include "prove/program.h"

#include "prove/concrete.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace glint::prove {
namespace {

constexpr double kSplitFactor = 4097.0;  // Veltkamp's, in shaders/bsdf/exact.glsl

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

const char* nameOfFunction(Function function) {
    static constexpr const char* kNames[] = {"sqrt", "inversesqrt", "exp", "exp2", "log",  "log2",
                                             "sin",  "cos",         "tan", "asin", "acos", "atan"};
    return kNames[static_cast<std::size_t>(function)];
}

const char* signOfOp(Op op) {
    switch (op) {
        case Op::Add:
        case Op::IntegerAdd:
            return " + ";
        case Op::Subtract:
        case Op::IntegerSubtract:
            return " - ";
        case Op::Multiply:
        case Op::IntegerMultiply:
            return " * ";
        case Op::Divide:
        case Op::IntegerDivide:
            return " / ";
        case Op::Less:
            return " < ";
        case Op::LessEqual:
            return " <= ";
        case Op::Equal:
            return " == ";
        case Op::And:
            return " && ";
        case Op::Or:
            return " || ";
        default:
            return nullptr;
    }
}

}  // namespace

const char* nameOf(Op op) {
    static constexpr const char* kNames[] = {"constant",
                                             "input",
                                             "sum",
                                             "difference",
                                             "product",
                                             "square",
                                             "quotient",
                                             "-",
                                             "abs",
                                             "sign",
                                             "floor",
                                             "ceil",
                                             "trunc",
                                             "round",
                                             "function",
                                             "pow",
                                             "atan",
                                             "min",
                                             "max",
                                             "mix",
                                             "normalize",
                                             "float16",
                                             "splitHigh",
                                             "splitLow",
                                             "productError",
                                             "sumError",
                                             "<",
                                             "<=",
                                             "==",
                                             "&&",
                                             "||",
                                             "!",
                                             "select",
                                             "merge",
                                             "refine",
                                             "int +",
                                             "int -",
                                             "int *",
                                             "int /",
                                             "int %",
                                             "&",
                                             "|",
                                             "^",
                                             "~",
                                             "<<",
                                             ">>",
                                             "bitfieldReverse",
                                             "toInteger",
                                             "toFloat",
                                             "floatBitsToInt",
                                             "intBitsToFloat",
                                             "changeSign"};
    return kNames[static_cast<std::size_t>(op)];
}

std::string describe(const Program& program, NodeId id, int depth) {
    const Node& node = program.nodes[id];
    if (node.op == Op::Constant) {
        return fmt::format("{:g}", node.value);
    }
    if (node.op == Op::Input) {
        return fmt::format("i[{}]", static_cast<int>(node.value));
    }
    if (node.op == Op::Refine) {
        return describe(program, node.a, depth);
    }
    if (depth == 0) {
        return "…";
    }
    if (const char* const sign = signOfOp(node.op)) {
        return fmt::format("({}{}{})", describe(program, node.a, depth - 1), sign,
                           describe(program, node.b, depth - 1));
    }
    std::string text = node.op == Op::Apply ? nameOfFunction(node.function) : nameOf(node.op);
    text += "(";
    for (const NodeId operand : {node.a, node.b, node.c}) {
        if (operand != kNoNode) {
            text += (text.back() == '(' ? "" : ", ") + describe(program, operand, depth - 1);
        }
    }
    return text + ")";
}

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
    if (isCommutative(node.op) && node.b < node.a) {
        std::swap(node.a, node.b);
    }
    if (const NodeId simple = simplified(node); simple != kNoNode) {
        return simple;
    }
    const Key key{node.op, node.format, node.function, node.relation, node.isSigned, node.a, node.b,
                  node.c,  0.0};
    std::vector<NodeId>& found = known_[key];
    for (const NodeId id : found) {
        if (covers(this->node(id).guard)) {
            return id;
        }
    }
    const NodeId id = append(node);
    found.push_back(id);
    return id;
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
            return isConstant(node.b, 1.0) ? node.a : kNoNode;
        case Op::Add:
            if (isConstant(node.a, 0.0)) {
                return node.b;
            }
            if (isConstant(node.b, 0.0)) {
                return node.a;
            }
            return errorFree(node);
        case Op::Subtract:
            return isConstant(node.b, 0.0) ? node.a : errorFree(node);
        case Op::Divide:
            return isConstant(node.b, 1.0) ? node.a : kNoNode;
        case Op::Minimum:
        case Op::Maximum:
            return node.a == node.b ? node.a : kNoNode;
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
            return node.b == node.c ? node.b : kNoNode;
        case Op::Convert:
            return this->node(node.a).format == node.format ? node.a : kNoNode;
        case Op::BitAnd:
            return isConstant(node.a, 0.0) ? node.a : isConstant(node.b, 0.0) ? node.b : kNoNode;
        default:
            return kNoNode;
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
    const Node& found = node(product);
    if (a == b) {
        return found.op == Op::Square && found.a == a;
    }
    return found.op == Op::Multiply && ((found.a == a && found.b == b) || (found.a == b && found.b == a));
}

bool ProgramBuilder::isSumOf(NodeId sum, NodeId a, NodeId b) const {
    const Node& found = node(sum);
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

}  // namespace glint::prove
