#include "verify/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace glint::verify {
namespace {

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
                                             "weightedUnit",
                                             "share",
                                             "mirroredSum",
                                             "triangleSum",
                                             "unitQuotient",
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

}  // namespace glint::verify
