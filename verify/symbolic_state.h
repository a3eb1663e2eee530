// The state of symbolic execution at a point of a function.
#pragma once

#include "verify/program_builder.h"
#include "verify/spirv_module.h"

#include <map>
#include <memory>
#include <optional>
#include <vector>

namespace glint::verify {

// An index that is not known: `index` × `stride` scalars, below `count`.
struct DynamicIndex {
    NodeId index = kNoNode;
    std::uint32_t stride = 0;
    std::uint32_t count = 0;
};

// A place in one of the memories.
struct SymbolicPointer {
    std::uint32_t memory = 0;
    std::uint32_t offset = 0;
    std::vector<DynamicIndex> dynamic;
    SpirvId pointee = 0;
};

// The scalars of a value in order, or a pointer.
struct SymbolicValue {
    std::vector<NodeId> nodes;
    std::optional<SymbolicPointer> pointer;
};

using Memory = std::shared_ptr<const std::vector<NodeId>>;

struct SymbolicState {
    NodeId guard = kNoNode;
    std::map<std::uint32_t, Memory> memories;
    std::map<NodeId, NodeId> refined;  // values with tighter bounds from a branch

    NodeId resolve(NodeId node) const {
        for (auto found = refined.find(node); found != refined.end(); found = refined.find(node)) {
            node = found->second;
        }
        return node;
    }
};

// Adds to the state that a condition holds or does not.
void learn(ProgramBuilder& builder, SymbolicState& state, NodeId condition, bool holds);

// Joins states; their guards exclude each other.
SymbolicState join(ProgramBuilder& builder, const std::vector<SymbolicState>& states);
// The value that is values[k] under states[k].
NodeId joinValues(ProgramBuilder& builder, const std::vector<SymbolicState>& states,
                  const std::vector<NodeId>& values);

}  // namespace glint::verify
