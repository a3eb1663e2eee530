// The instructions of GLSL.std.450 on symbolic values.
#include "verify/symbolic_operations.h"

#include <fmt/format.h>
#include <spirv/unified1/GLSL.std.450.h>

namespace glint::verify {

std::vector<NodeId> SymbolicOperations::normalized(const Scalar& scalar, const std::vector<NodeId>& v) {
    const NodeId squared = dot(scalar, v, v);
    std::vector<NodeId> result;
    for (std::size_t k = 0; k < v.size(); ++k) {
        // The squares of the others, for the bound of x / √(x² + rest).
        NodeId rest = builder_.constant(0.0, scalar.format);
        for (std::size_t other = 0; other < v.size(); ++other) {
            if (other != k) {
                rest = make(Op::Add, scalar, rest, make(Op::Square, scalar, v[other]));
            }
        }
        result.push_back(make(Op::Normalized, scalar, v[k], rest, squared));
    }
    return result;
}

Result<SymbolicValue> SymbolicOperations::extended(const SpirvOperation& operation,
                                                   const std::vector<SymbolicValue>& operands) {
    const std::uint32_t instruction = operation.operands[1];
    const Scalar scalar = scalarOf(operation.type);
    const std::vector<NodeId>& a = operands[2].nodes;
    const std::vector<NodeId> b = operands.size() > 3 ? operands[3].nodes : std::vector<NodeId>{};
    SymbolicValue value;
    switch (instruction) {
        case GLSLstd450Length:
            value.nodes = {builder_.apply(Function::Sqrt, scalar.format, dot(scalar, a, a))};
            return value;
        case GLSLstd450Distance: {
            std::vector<NodeId> difference;
            for (std::size_t k = 0; k < a.size(); ++k) {
                difference.push_back(make(Op::Subtract, scalar, a[k], b[k]));
            }
            value.nodes = {
                builder_.apply(Function::Sqrt, scalar.format, dot(scalar, difference, difference))};
            return value;
        }
        case GLSLstd450Cross:
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t i = (k + 1) % 3;
                const std::size_t j = (k + 2) % 3;
                value.nodes.push_back(make(Op::Subtract, scalar, make(Op::Multiply, scalar, a[i], b[j]),
                                           make(Op::Multiply, scalar, b[i], a[j])));
            }
            return value;
        case GLSLstd450Normalize:
            value.nodes = normalized(scalar, a);
            return value;
        case GLSLstd450Reflect: {
            const NodeId twice =
                make(Op::Multiply, scalar, builder_.constant(2.0, scalar.format), dot(scalar, b, a));
            for (std::size_t k = 0; k < a.size(); ++k) {
                value.nodes.push_back(
                    make(Op::Subtract, scalar, a[k], make(Op::Multiply, scalar, b[k], twice)));
            }
            return value;
        }
        default:
            break;
    }
    for (std::size_t k = 0; k < module_.types.at(operation.type).scalars; ++k) {
        std::vector<NodeId> x;
        for (std::size_t operand = 2; operand < operands.size(); ++operand) {
            const std::vector<NodeId>& nodes = operands[operand].nodes;
            x.push_back(nodes.size() == 1 ? nodes[0] : nodes[k]);
        }
        const NodeId node = extendedScalar(instruction, scalar, x);
        if (node == kNoNode) {
            return unsupportedInstruction(instruction, "instruction of GLSL.std.450");
        }
        value.nodes.push_back(node);
    }
    return value;
}

NodeId SymbolicOperations::extendedScalar(std::uint32_t instruction, const Scalar& scalar,
                                          const std::vector<NodeId>& x) {
    const auto function = [&](Function which) { return builder_.apply(which, scalar.format, x[0]); };
    const auto number = [&](double value) {
        return builder_.constant(value, scalar.format, scalar.isSigned);
    };
    switch (instruction) {
        case GLSLstd450Round:
        case GLSLstd450RoundEven:
            return make(Op::RoundEven, scalar, x[0]);
        case GLSLstd450Trunc:
            return make(Op::Trunc, scalar, x[0]);
        case GLSLstd450FAbs:
        case GLSLstd450SAbs:
            return make(Op::Absolute, scalar, x[0]);
        case GLSLstd450FSign:
        case GLSLstd450SSign:
            return make(Op::Sign, scalar, x[0]);
        case GLSLstd450Floor:
            return make(Op::Floor, scalar, x[0]);
        case GLSLstd450Ceil:
            return make(Op::Ceil, scalar, x[0]);
        case GLSLstd450Fract:
            return make(Op::Subtract, scalar, x[0], make(Op::Floor, scalar, x[0]));
        case GLSLstd450Sqrt:
            return function(Function::Sqrt);
        case GLSLstd450InverseSqrt:
            return function(Function::InverseSqrt);
        case GLSLstd450Exp:
            return function(Function::Exp);
        case GLSLstd450Exp2:
            return function(Function::Exp2);
        case GLSLstd450Log:
            return function(Function::Log);
        case GLSLstd450Log2:
            return function(Function::Log2);
        case GLSLstd450Sin:
            return function(Function::Sin);
        case GLSLstd450Cos:
            return function(Function::Cos);
        case GLSLstd450Tan:
            return function(Function::Tan);
        case GLSLstd450Asin:
            return function(Function::Asin);
        case GLSLstd450Acos:
            return function(Function::Acos);
        case GLSLstd450Atan:
            return function(Function::Atan);
        case GLSLstd450Atan2:
            return make(Op::ArcTangent, scalar, x[0], x[1]);
        case GLSLstd450Pow:
            return make(Op::Power, scalar, x[0], x[1]);
        case GLSLstd450FMin:
        case GLSLstd450NMin:
        case GLSLstd450UMin:
        case GLSLstd450SMin:
            return make(Op::Minimum, scalar, x[0], x[1]);
        case GLSLstd450FMax:
        case GLSLstd450NMax:
        case GLSLstd450UMax:
        case GLSLstd450SMax:
            return make(Op::Maximum, scalar, x[0], x[1]);
        case GLSLstd450FClamp:
        case GLSLstd450NClamp:
        case GLSLstd450UClamp:
        case GLSLstd450SClamp:
            return make(Op::Minimum, scalar, make(Op::Maximum, scalar, x[0], x[1]), x[2]);
        case GLSLstd450FMix:
            return make(Op::Mix, scalar, x[0], x[1], x[2]);
        case GLSLstd450Step: {
            const NodeId below = builder_.make(Op::Less, Format::Integer, x[1], x[0]);
            return make(Op::Select, scalar, below, number(0.0), number(1.0));
        }
        case GLSLstd450SmoothStep: {
            const NodeId share = make(Op::Divide, scalar, make(Op::Subtract, scalar, x[2], x[0]),
                                      make(Op::Subtract, scalar, x[1], x[0]));
            const NodeId t =
                make(Op::Minimum, scalar, make(Op::Maximum, scalar, share, number(0.0)), number(1.0));
            const NodeId rest =
                make(Op::Subtract, scalar, number(3.0), make(Op::Multiply, scalar, number(2.0), t));
            return make(Op::Multiply, scalar, make(Op::Square, scalar, t), rest);
        }
        case GLSLstd450Fma:
            return make(Op::Add, scalar, make(Op::Multiply, scalar, x[0], x[1]), x[2]);
        default:
            return kNoNode;
    }
}

}  // namespace glint::verify
