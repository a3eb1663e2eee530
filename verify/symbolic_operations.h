// The operations of SPIR-V on symbolic values: those without control flow and memory.
#pragma once

#include "verify/symbolic_state.h"

#include <glint/result.h>

namespace glint::verify {

Diagnostic unsupportedInstruction(std::uint32_t opcode, const char* kind = "SPIR-V instruction");

class SymbolicOperations {
public:
    SymbolicOperations(const SpirvModule& module, ProgramBuilder& builder);

    // Must come first. Error "prove-unsupported".
    Status readConstants();
    SymbolicValue constantOf(SpirvId id) const;
    std::vector<NodeId> zeroOf(SpirvId type);

    // Returns how many of the operands are values; the others are literals.
    std::size_t idOperands(const SpirvOperation& operation) const;
    // Error "prove-unsupported".
    Result<SymbolicValue> apply(const SpirvOperation& operation, const std::vector<SymbolicValue>& operands);

    std::uint32_t offsetOf(const SpirvType& type, std::size_t member) const;
    NodeId elementOf(const std::vector<NodeId>& memory, std::uint32_t offset,
                     const std::vector<DynamicIndex>& dynamic);
    NodeId equals(NodeId index, std::uint32_t value);
    NodeId choose(NodeId condition, NodeId yes, NodeId no);

private:
    struct Scalar {
        Format format = Format::Single;
        bool isSigned = false;
    };

    Scalar scalarOf(SpirvId type) const;
    SpirvId typeOf(SpirvId value) const;
    NodeId make(Op op, const Scalar& scalar, NodeId a, NodeId b = kNoNode, NodeId c = kNoNode);
    NodeId dot(const Scalar& scalar, const std::vector<NodeId>& a, const std::vector<NodeId>& b);
    std::optional<SymbolicValue> composite(const SpirvOperation& operation,
                                           const std::vector<SymbolicValue>& operands);
    std::optional<SymbolicValue> linear(const SpirvOperation& operation,
                                        const std::vector<SymbolicValue>& operands);
    NodeId elementwise(const SpirvOperation& operation, const Scalar& result, const std::vector<NodeId>& x);
    NodeId comparison(std::uint32_t opcode, NodeId a, NodeId b);
    NodeId bitcast(const Scalar& to, NodeId a);
    Result<SymbolicValue> extended(const SpirvOperation& operation,
                                   const std::vector<SymbolicValue>& operands);
    NodeId extendedScalar(std::uint32_t instruction, const Scalar& scalar, const std::vector<NodeId>& x);
    std::vector<NodeId> normalized(const Scalar& scalar, const std::vector<NodeId>& v);

    const SpirvModule& module_;
    ProgramBuilder& builder_;
    std::map<SpirvId, SymbolicValue> constants_;
    std::unordered_map<SpirvId, SpirvId> typeOfValue_;
};

}  // namespace glint::verify
