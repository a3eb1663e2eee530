#include "verify/symbolic_operations.h"

#include <fmt/format.h>
#include <glslang/SPIRV/spirv.hpp>

#include <bit>

namespace glint::verify {
namespace {

using Kind = SpirvType::Kind;

double halfValue(std::uint32_t bits) {
    const std::uint32_t exponent = bits >> 10U & 31U;
    const double mantissa = static_cast<double>(bits & 1023U);
    const double size = exponent == 0    ? std::ldexp(mantissa, -24)
                        : exponent == 31 ? kInfinity
                                         : std::ldexp(1024.0 + mantissa, static_cast<int>(exponent) - 25);
    return (bits & 0x8000U) != 0 ? -size : size;
}

}  // namespace

Diagnostic unsupportedInstruction(std::uint32_t opcode, const char* kind) {
    return makeError("prove-unsupported", "", fmt::format("{} {} is not known", kind, opcode),
                     "prove the functions that it calls, without this");
}

SymbolicOperations::SymbolicOperations(const SpirvModule& module, ProgramBuilder& builder)
    : module_(module), builder_(builder) {
    for (const SpirvOperation& constant : module.constants) {
        typeOfValue_[constant.result] = constant.type;
    }
    for (const SpirvFunctionBody& function : module.functions) {
        for (const SpirvOperation& parameter : function.parameters) {
            typeOfValue_[parameter.result] = parameter.type;
        }
        for (const SpirvBlock& block : function.blocks) {
            for (const SpirvOperation& operation : block.operations) {
                typeOfValue_[operation.result] = operation.type;
            }
        }
    }
}

SymbolicOperations::Scalar SymbolicOperations::scalarOf(SpirvId id) const {
    const SpirvType* type = &module_.types.at(id);
    while (type->kind == Kind::Vector || type->kind == Kind::Matrix || type->kind == Kind::Array) {
        type = &module_.types.at(type->element);
    }
    if (type->kind == Kind::Float) {
        return {type->width == 16 ? Format::Half : Format::Single, false};
    }
    return {Format::Integer, type->isSigned};
}

std::vector<NodeId> SymbolicOperations::zeroOf(SpirvId id) {
    const SpirvType& type = module_.types.at(id);
    std::vector<NodeId> zeros;
    if (type.kind == Kind::Struct) {
        for (const SpirvId member : type.members) {
            const std::vector<NodeId> more = zeroOf(member);
            zeros.insert(zeros.end(), more.begin(), more.end());
        }
        return zeros;
    }
    if (type.kind == Kind::Array || type.kind == Kind::Matrix) {
        for (std::uint32_t k = 0; k < type.count; ++k) {
            const std::vector<NodeId> more = zeroOf(type.element);
            zeros.insert(zeros.end(), more.begin(), more.end());
        }
        return zeros;
    }
    const Scalar scalar = scalarOf(id);
    zeros.assign(type.scalars, builder_.constant(0.0, scalar.format, scalar.isSigned));
    return zeros;
}

Status SymbolicOperations::readConstants() {
    for (const SpirvOperation& constant : module_.constants) {
        SymbolicValue& value = constants_[constant.result];
        const Scalar scalar = scalarOf(constant.type);
        switch (constant.opcode) {
            case spv::OpConstantTrue:
            case spv::OpConstantFalse:
            case spv::OpSpecConstantTrue:
            case spv::OpSpecConstantFalse:
                value.nodes = {builder_.truth(constant.opcode == spv::OpConstantTrue ||
                                              constant.opcode == spv::OpSpecConstantTrue)};
                break;
            case spv::OpConstant:
            case spv::OpSpecConstant: {
                const std::uint32_t bits = constant.operands[0];
                double number = scalar.isSigned ? static_cast<double>(static_cast<std::int32_t>(bits)) : bits;
                if (scalar.format != Format::Integer) {
                    number = scalar.format == Format::Half ? halfValue(bits) : std::bit_cast<float>(bits);
                }
                value.nodes = {builder_.constant(number, scalar.format, scalar.isSigned)};
                break;
            }
            case spv::OpConstantComposite:
            case spv::OpSpecConstantComposite:
                for (const SpirvId part : constant.operands) {
                    const std::vector<NodeId>& nodes = constants_.at(part).nodes;
                    value.nodes.insert(value.nodes.end(), nodes.begin(), nodes.end());
                }
                break;
            case spv::OpConstantNull:
            case spv::OpUndef:
                value.nodes = zeroOf(constant.type);
                break;
            default:
                return unsupportedInstruction(constant.opcode);
        }
    }
    return okStatus();
}

SymbolicValue SymbolicOperations::constantOf(SpirvId id) const {
    const auto found = constants_.find(id);
    return found == constants_.end() ? SymbolicValue{} : found->second;
}

std::uint32_t SymbolicOperations::offsetOf(const SpirvType& type, std::size_t member) const {
    if (type.kind != Kind::Struct) {
        return static_cast<std::uint32_t>(member) * module_.types.at(type.element).scalars;
    }
    std::uint32_t offset = 0;
    for (std::size_t k = 0; k < member; ++k) {
        offset += module_.types.at(type.members[k]).scalars;
    }
    return offset;
}

NodeId SymbolicOperations::make(Op op, const Scalar& scalar, NodeId a, NodeId b, NodeId c) {
    Node node;
    node.op = op;
    node.format = scalar.format;
    node.isSigned = scalar.isSigned;
    node.a = a;
    node.b = b;
    node.c = c;
    return builder_.make(node);
}

NodeId SymbolicOperations::equals(NodeId index, std::uint32_t value) {
    return builder_.make(Op::Equal, Format::Integer, index,
                         builder_.constant(value, Format::Integer, builder_.node(index).isSigned));
}

NodeId SymbolicOperations::choose(NodeId condition, NodeId yes, NodeId no) {
    const Node& node = builder_.node(yes);
    return make(Op::Select, {node.format, node.isSigned}, condition, yes, no);
}

NodeId SymbolicOperations::elementOf(const std::vector<NodeId>& memory, std::uint32_t offset,
                                     const std::vector<DynamicIndex>& dynamic) {
    if (dynamic.empty()) {
        return offset < memory.size() ? memory[offset] : kNoNode;
    }
    const std::vector<DynamicIndex> rest(dynamic.begin() + 1, dynamic.end());
    const DynamicIndex& index = dynamic.front();
    NodeId result = kNoNode;
    for (std::uint32_t k = index.count; k-- > 0;) {
        const NodeId element = elementOf(memory, offset + k * index.stride, rest);
        if (element == kNoNode) {
            return kNoNode;
        }
        result = result == kNoNode ? element : choose(equals(index.index, k), element, result);
    }
    return result;
}

NodeId SymbolicOperations::dot(const Scalar& scalar, const std::vector<NodeId>& a,
                               const std::vector<NodeId>& b) {
    NodeId sum = kNoNode;
    for (std::size_t k = 0; k < a.size(); ++k) {
        const NodeId product = make(Op::Multiply, scalar, a[k], b[k]);
        sum = sum == kNoNode ? product : make(Op::Add, scalar, sum, product);
    }
    return sum;
}

std::size_t SymbolicOperations::idOperands(const SpirvOperation& operation) const {
    switch (operation.opcode) {
        case spv::OpCompositeExtract:
            return 1;
        case spv::OpCompositeInsert:
        case spv::OpVectorShuffle:
            return 2;
        default:
            return operation.operands.size();
    }
}

std::optional<SymbolicValue> SymbolicOperations::composite(const SpirvOperation& operation,
                                                           const std::vector<SymbolicValue>& operands) {
    SymbolicValue value;
    switch (operation.opcode) {
        case spv::OpCompositeConstruct:
            for (const SymbolicValue& part : operands) {
                value.nodes.insert(value.nodes.end(), part.nodes.begin(), part.nodes.end());
            }
            return value;
        case spv::OpCompositeExtract:
        case spv::OpCompositeInsert: {
            const bool inserts = operation.opcode == spv::OpCompositeInsert;
            SpirvId type = inserts ? operation.type : typeOf(operation.operands[0]);
            std::uint32_t offset = 0;
            for (const std::uint32_t index : operation.operands.subspan(inserts ? 2 : 1)) {
                const SpirvType& at = module_.types.at(type);
                offset += offsetOf(at, index);
                type = at.kind == Kind::Struct ? at.members[index] : at.element;
            }
            if (inserts) {
                value = operands[1];
                std::copy(operands[0].nodes.begin(), operands[0].nodes.end(), value.nodes.begin() + offset);
                return value;
            }
            const auto first = operands[0].nodes.begin() + offset;
            value.nodes.assign(first, first + module_.types.at(operation.type).scalars);
            return value;
        }
        case spv::OpVectorShuffle: {
            std::vector<NodeId> all = operands[0].nodes;
            all.insert(all.end(), operands[1].nodes.begin(), operands[1].nodes.end());
            for (const std::uint32_t index : operation.operands.subspan(2)) {
                value.nodes.push_back(index < all.size() ? all[index] : all[0]);
            }
            return value;
        }
        case spv::OpVectorExtractDynamic: {
            const auto count = static_cast<std::uint32_t>(operands[0].nodes.size());
            value.nodes = {elementOf(operands[0].nodes, 0, {{operands[1].nodes[0], 1, count}})};
            return value;
        }
        case spv::OpCopyObject:
        case spv::OpCopyLogical:
            return operands[0];
        case spv::OpUndef:
            value.nodes = zeroOf(operation.type);
            return value;
        default:
            return std::nullopt;
    }
}

std::optional<SymbolicValue> SymbolicOperations::linear(const SpirvOperation& operation,
                                                        const std::vector<SymbolicValue>& operands) {
    const Scalar scalar = scalarOf(operation.type);
    SymbolicValue value;
    switch (operation.opcode) {
        case spv::OpDot:
            value.nodes = {dot(scalar, operands[0].nodes, operands[1].nodes)};
            return value;
        case spv::OpVectorTimesScalar:
        case spv::OpMatrixTimesScalar:
            for (const NodeId node : operands[0].nodes) {
                value.nodes.push_back(make(Op::Multiply, scalar, node, operands[1].nodes[0]));
            }
            return value;
        case spv::OpMatrixTimesVector: {
            const std::vector<NodeId>& matrix = operands[0].nodes;
            const std::vector<NodeId>& v = operands[1].nodes;
            const std::size_t rows = matrix.size() / v.size();
            for (std::size_t row = 0; row < rows; ++row) {
                std::vector<NodeId> elements;
                for (std::size_t column = 0; column < v.size(); ++column) {
                    elements.push_back(matrix[column * rows + row]);
                }
                value.nodes.push_back(dot(scalar, elements, v));
            }
            return value;
        }
        case spv::OpVectorTimesMatrix: {
            const std::vector<NodeId>& v = operands[0].nodes;
            for (std::size_t column = 0; column * v.size() < operands[1].nodes.size(); ++column) {
                const auto first = operands[1].nodes.begin() + static_cast<std::ptrdiff_t>(column * v.size());
                value.nodes.push_back(dot(scalar, v, {first, first + static_cast<std::ptrdiff_t>(v.size())}));
            }
            return value;
        }
        case spv::OpTranspose: {
            const SpirvType& type = module_.types.at(operation.type);
            const std::uint32_t rows = module_.types.at(type.element).count;
            for (std::uint32_t column = 0; column < type.count; ++column) {
                for (std::uint32_t row = 0; row < rows; ++row) {
                    value.nodes.push_back(operands[0].nodes[row * type.count + column]);
                }
            }
            return value;
        }
        case spv::OpAny:
        case spv::OpAll: {
            NodeId all = operands[0].nodes[0];
            for (const NodeId node : operands[0].nodes) {
                all = builder_.make(operation.opcode == spv::OpAny ? Op::Or : Op::And, Format::Integer, all,
                                    node);
            }
            value.nodes = {all};
            return value;
        }
        default:
            return std::nullopt;
    }
}

NodeId SymbolicOperations::comparison(std::uint32_t opcode, NodeId a, NodeId b) {
    const auto compare = [&](Op op, NodeId x, NodeId y) { return builder_.make(op, Format::Integer, x, y); };
    switch (opcode) {
        case spv::OpFOrdLessThan:
        case spv::OpFUnordLessThan:
        case spv::OpULessThan:
        case spv::OpSLessThan:
            return compare(Op::Less, a, b);
        case spv::OpFOrdGreaterThan:
        case spv::OpFUnordGreaterThan:
        case spv::OpUGreaterThan:
        case spv::OpSGreaterThan:
            return compare(Op::Less, b, a);
        case spv::OpFOrdLessThanEqual:
        case spv::OpFUnordLessThanEqual:
        case spv::OpULessThanEqual:
        case spv::OpSLessThanEqual:
            return compare(Op::LessEqual, a, b);
        case spv::OpFOrdGreaterThanEqual:
        case spv::OpFUnordGreaterThanEqual:
        case spv::OpUGreaterThanEqual:
        case spv::OpSGreaterThanEqual:
            return compare(Op::LessEqual, b, a);
        case spv::OpFOrdEqual:
        case spv::OpFUnordEqual:
        case spv::OpIEqual:
        case spv::OpLogicalEqual:
            return compare(Op::Equal, a, b);
        case spv::OpFOrdNotEqual:
        case spv::OpFUnordNotEqual:
        case spv::OpINotEqual:
        case spv::OpLogicalNotEqual:
            return builder_.opposite(compare(Op::Equal, a, b));
        default:
            return kNoNode;
    }
}

NodeId SymbolicOperations::bitcast(const Scalar& to, NodeId a) {
    const Node from = builder_.node(a);
    if (to.format == Format::Integer) {
        if (from.format == Format::Integer) {
            return from.isSigned == to.isSigned ? a : make(Op::ChangeSign, to, a);
        }
        return from.format == Format::Single ? make(Op::BitsOf, to, a) : kNoNode;
    }
    if (from.format == Format::Integer) {
        return to.format == Format::Single ? make(Op::OfBits, to, a) : kNoNode;
    }
    return a;
}

// Returns kNoNode for an unknown operation.
NodeId SymbolicOperations::elementwise(const SpirvOperation& operation, const Scalar& result,
                                       const std::vector<NodeId>& x) {
    const auto simple = [&](Op op) { return make(op, result, x[0], x.size() > 1 ? x[1] : kNoNode); };
    switch (operation.opcode) {
        case spv::OpFAdd:
            return simple(Op::Add);
        case spv::OpFSub:
            return simple(Op::Subtract);
        case spv::OpFMul:
            return simple(Op::Multiply);
        case spv::OpFDiv:
            return simple(Op::Divide);
        case spv::OpFNegate:
            return simple(Op::Negate);
        case spv::OpFMod: {
            const NodeId turns = make(Op::Floor, result, make(Op::Divide, result, x[0], x[1]));
            return make(Op::Subtract, result, x[0], make(Op::Multiply, result, x[1], turns));
        }
        case spv::OpFConvert:
        case spv::OpQuantizeToF16:
            return simple(Op::Convert);
        case spv::OpIAdd:
            return simple(Op::IntegerAdd);
        case spv::OpISub:
            return simple(Op::IntegerSubtract);
        case spv::OpIMul:
            return simple(Op::IntegerMultiply);
        case spv::OpUDiv:
        case spv::OpSDiv:
            return simple(Op::IntegerDivide);
        case spv::OpUMod:
        case spv::OpSRem:
            return simple(Op::IntegerRemainder);
        case spv::OpSNegate:
            return make(Op::IntegerSubtract, result, builder_.constant(0.0, Format::Integer, result.isSigned),
                        x[0]);
        case spv::OpBitwiseAnd:
            return simple(Op::BitAnd);
        case spv::OpBitwiseOr:
            return simple(Op::BitOr);
        case spv::OpBitwiseXor:
            return simple(Op::BitXor);
        case spv::OpNot:
            return simple(Op::BitNot);
        case spv::OpShiftLeftLogical:
            return simple(Op::ShiftLeft);
        case spv::OpShiftRightLogical:
        case spv::OpShiftRightArithmetic:
            return simple(Op::ShiftRight);
        case spv::OpBitReverse:
            return simple(Op::BitReverse);
        case spv::OpConvertFToU:
        case spv::OpConvertFToS:
            return simple(Op::ToInteger);
        case spv::OpConvertUToF:
        case spv::OpConvertSToF:
            return simple(Op::FromInteger);
        case spv::OpUConvert:
        case spv::OpSConvert:
            return simple(Op::ChangeSign);
        case spv::OpBitcast:
            return bitcast(result, x[0]);
        case spv::OpLogicalAnd:
            return simple(Op::And);
        case spv::OpLogicalOr:
            return simple(Op::Or);
        case spv::OpLogicalNot:
            return simple(Op::Not);
        case spv::OpSelect:
            return make(Op::Select, result, x[0], x[1], x[2]);
        case spv::OpIsNan:
            // The operation that makes a NaN has already been reported.
            return builder_.truth(false);
        case spv::OpIsInf:
            return builder_.make(Op::Less, Format::Integer, builder_.constant(kLargestSingle, Format::Single),
                                 builder_.make(Op::Absolute, Format::Single, x[0]));
        default:
            return comparison(operation.opcode, x[0], x.size() > 1 ? x[1] : kNoNode);
    }
}

SpirvId SymbolicOperations::typeOf(SpirvId id) const {
    const auto found = typeOfValue_.find(id);
    return found == typeOfValue_.end() ? 0 : found->second;
}

Result<SymbolicValue> SymbolicOperations::apply(const SpirvOperation& operation,
                                                const std::vector<SymbolicValue>& operands) {
    if (operation.opcode == spv::OpExtInst) {
        return extended(operation, operands);
    }
    if (std::optional<SymbolicValue> value = composite(operation, operands)) {
        return *value;
    }
    if (std::optional<SymbolicValue> value = linear(operation, operands)) {
        return *value;
    }
    const Scalar result = scalarOf(operation.type);
    SymbolicValue value;
    const std::uint32_t count = module_.types.at(operation.type).scalars;
    for (std::uint32_t k = 0; k < count; ++k) {
        std::vector<NodeId> x;
        for (const SymbolicValue& operand : operands) {
            if (operand.nodes.empty()) {
                return unsupportedInstruction(operation.opcode);
            }
            // The condition of OpSelect may be one for all.
            x.push_back(operand.nodes.size() == 1 ? operand.nodes[0] : operand.nodes[k]);
        }
        const NodeId node = elementwise(operation, result, x);
        if (node == kNoNode) {
            return unsupportedInstruction(operation.opcode);
        }
        value.nodes.push_back(node);
    }
    return value;
}

}  // namespace glint::verify
