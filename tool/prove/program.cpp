#include "prove/program.h"

#include "prove/concrete.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

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
                                             "lerp",
                                             "normalize",
                                             "float16",
                                             "splitHigh",
                                             "splitLow",
                                             "productError",
                                             "sumError",
                                             "circleSum",
                                             "squareOfRoot",
                                             "dot",
                                             "unitSum",
                                             "partOfUnit",
                                             "sphereSum",
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
    node.isAuxiliary = makesAuxiliary_;
    if (isCommutative(node.op) && node.b < node.a) {
        std::swap(node.a, node.b);
    }
    if (const NodeId simple = simplified(node); simple != kNoNode) {
        return simple;
    }
    return appendOnce(node);
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
            if (const NodeId sum = squaredRadius(node); sum != kNoNode) {
                return sum;
            }
            return dotProduct(node);
        case Op::Square:
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
        case Op::ShiftRight:
            return shifted(node);
        case Op::BitAnd:
            return isConstant(node.a, 0.0) ? node.a : isConstant(node.b, 0.0) ? node.b : kNoNode;
        default:
            return kNoNode;
    }
}

NodeId ProgramBuilder::plainOf(NodeId id) const {
    for (;;) {
        const Node& known = node(id);
        if (known.op == Op::SphereSum) {
            id = known.b;
        } else if (known.op == Op::Bounded || known.op == Op::UnitSum || known.op == Op::PartOfUnit) {
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

// Appends a node that simplified() has been asked about, unless it is there already.
NodeId ProgramBuilder::appendOnce(const Node& node) {
    const Key key{node.op, node.format, node.function, node.relation, node.isSigned, node.a, node.b,
                  node.c,  0.0};
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

NodeId ProgramBuilder::sumOfNormalized(const Node& given) {
    // The squares in a sum, whatever else is known of the sum.
    const auto squaresOf = [this](const auto& self, NodeId id, std::vector<NodeId>& squares) -> bool {
        const Node& at = node(plainOf(id));
        if (at.op == Op::Add) {
            return self(self, at.a, squares) && self(self, at.b, squares);
        }
        squares.push_back(at.op == Op::Square ? at.a : kNoNode);
        return at.op == Op::Square;
    };
    std::vector<NodeId> parts;
    if (!squaresOf(squaresOf, given.a, parts) || !squaresOf(squaresOf, given.b, parts)) {
        return kNoNode;
    }
    std::vector<NodeId> components;
    for (const NodeId part : parts) {
        if (node(part).op != Op::Normalized || node(part).c != node(parts.front()).c) {
            return kNoNode;
        }
        components.push_back(node(part).a);
    }
    std::sort(components.begin(), components.end());
    if (std::adjacent_find(components.begin(), components.end()) != components.end()) {
        return kNoNode;
    }
    const NodeId length2 = node(parts.front()).c;
    std::vector<NodeId> all;
    const bool isSum = squaresOf(squaresOf, length2, all);
    std::sort(all.begin(), all.end());
    return make(isSum && all == components ? Op::UnitSum : Op::PartOfUnit, given.format, appendOnce(given),
                length2);
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
    if (at.op != Op::Apply || at.function != Function::Sqrt) {
        return false;
    }
    const Node limited = node(at.a);
    if (limited.op != Op::Maximum || !isConstant(limited.b, 0.0) || node(limited.a).op != Op::Multiply) {
        return false;
    }
    const Node product = node(limited.a);
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

NodeId ProgramBuilder::squaredRadius(const Node& given) {
    for (const auto& [circle, last] : {std::pair(given.a, given.b), std::pair(given.b, given.a)}) {
        const Node around = node(circle);
        const Node square = node(last);
        if (around.op != Op::CircleSum || around.a != around.b || square.op != Op::Square) {
            continue;
        }
        NodeId cosine = kNoNode;
        NodeId factor = kNoNode;
        const bool wasAuxiliary = std::exchange(makesAuxiliary_, true);
        const bool isSine = isSineOf(around.a, cosine, factor);
        const NodeId expected = isSine ? make(Op::Multiply, given.format, cosine, factor) : kNoNode;
        makesAuxiliary_ = wasAuxiliary;
        if (isSine && expected == square.a) {
            return make(Op::SphereSum, given.format, factor, appendOnce(given));
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
