#include "verify/symbolic.h"

#include "base/lists.h"
#include "verify/symbolic_operations.h"
#include "verify/symbolic_state.h"

#include <fmt/format.h>
#include <glslang/SPIRV/spirv.hpp>

#include <algorithm>
#include <utility>

namespace glint::verify {
namespace {

using Kind = SpirvType::Kind;

// A function that is larger would take minutes a box.
constexpr std::size_t kMostNodes = 400'000;
constexpr std::size_t kMostBlocks = 100'000;
// Turns of a loop whose end depends on the inputs: each is one condition more around those that follow.
constexpr std::size_t kMostTurns = 64;

struct IncomingEdge {
    SpirvId from = 0;
    SymbolicState state;
    std::map<SpirvId, SymbolicValue> phis;  // the values that this edge gives the block's OpPhi
    std::map<SpirvId, SymbolicValue> kept;  // values of the loop that this edge leaves
};

struct Returned {
    SymbolicState state;
    SymbolicValue value;
};

class Executor {
public:
    explicit Executor(const SpirvModule& module) : module_(module), operations_(module, builder_) {}

    Result<Program> run(const SpirvFunctionBody& function);

private:
    struct Frame {
        const SpirvFunctionBody& function;
        std::map<SpirvId, SymbolicValue> values;
        std::map<std::uint32_t, std::vector<IncomingEdge>> pending;  // by the order of the block
        std::vector<Returned> returns;
        std::map<SpirvId, std::size_t> turns;  // of blocks that may not be reached, by their label
    };

    Result<Returned> call(const SpirvFunctionBody& function, std::vector<SymbolicValue> arguments,
                          SymbolicState state);
    Status runBlock(Frame& frame, const SpirvBlock& block, std::vector<IncomingEdge> edges);
    Status runOperation(Frame& frame, SymbolicState& state, const SpirvOperation& operation);
    Status branch(Frame& frame, const SpirvBlock& block, SymbolicState& state);
    Status leave(Frame& frame, const SpirvBlock& block, SpirvId target, SymbolicState state, NodeId condition,
                 bool holds);
    void keepLoopValues(const Frame& frame, const SpirvBlock& next, IncomingEdge& edge);
    void joinLoopValues(Frame& frame, const std::vector<IncomingEdge>& edges,
                        const std::vector<SymbolicState>& states);
    Status chooseBySwitch(Frame& frame, const SpirvBlock& block, const SymbolicState& state);
    Status callFunction(Frame& frame, SymbolicState& state, const SpirvOperation& operation);
    Status access(Frame& frame, const SymbolicState& state, const SpirvOperation& operation);
    Status load(Frame& frame, const SymbolicState& state, const SpirvOperation& operation);
    Status store(Frame& frame, SymbolicState& state, const SpirvOperation& operation);

    // Joins the values of ways that come together, scalar by scalar. `valueOf` returns a way's value.
    template <typename Ways, typename ValueOf>
    SymbolicValue joined(const std::vector<SymbolicState>& states, const Ways& ways, const ValueOf& valueOf) {
        SymbolicValue all;
        for (std::size_t k = 0; k < valueOf(ways.front())->nodes.size(); ++k) {
            const auto values =
                base::mapped<NodeId>(ways, [&](const auto& way) { return valueOf(way)->nodes[k]; });
            all.nodes.push_back(joinValues(builder_, states, values));
        }
        return all;
    }
    SymbolicValue valueOf(const Frame& frame, const SymbolicState& state, SpirvId id);
    std::uint32_t newMemory(SymbolicState& state, std::vector<NodeId> scalars);

    const SpirvModule& module_;
    ProgramBuilder builder_;
    SymbolicOperations operations_;
    std::map<SpirvId, SymbolicValue> globals_;
    std::uint32_t memories_ = 0;
    std::size_t blocksRun_ = 0;
};

Diagnostic unsupported(const std::string& what) {
    return makeError("prove-unsupported", "", what, "prove the functions that it calls, without this");
}

std::uint32_t Executor::newMemory(SymbolicState& state, std::vector<NodeId> scalars) {
    state.memories[memories_] = std::make_shared<const std::vector<NodeId>>(std::move(scalars));
    return memories_++;
}

SymbolicValue Executor::valueOf(const Frame& frame, const SymbolicState& state, SpirvId id) {
    const auto found = frame.values.find(id);
    if (found == frame.values.end()) {
        const auto global = globals_.find(id);
        if (global != globals_.end()) {
            return global->second;
        }
    }
    SymbolicValue value = found != frame.values.end() ? found->second : operations_.constantOf(id);
    for (NodeId& node : value.nodes) {
        node = state.resolve(node);
    }
    return value;
}

Result<Program> Executor::run(const SpirvFunctionBody& function) {
    GLINT_TRY_DO(operations_.readConstants());
    SymbolicState state;
    std::vector<SymbolicValue> arguments;
    for (const SpirvOperation& parameter : function.parameters) {
        const SpirvType& pointer = module_.types.at(parameter.type);
        if (pointer.kind != Kind::Pointer || module_.types.at(pointer.element).kind != Kind::Array) {
            return unsupported("a parameter of " + function.name + " is no array");
        }
        std::vector<NodeId> scalars;
        for (std::uint32_t k = 0; k < module_.types.at(pointer.element).scalars; ++k) {
            scalars.push_back(arguments.empty() ? builder_.input(k, Format::Single)
                                                : builder_.constant(0.0, Format::Single));
        }
        SymbolicValue argument;
        argument.pointer = SymbolicPointer{newMemory(state, std::move(scalars)), 0, {}, pointer.element};
        arguments.push_back(std::move(argument));
    }
    // Global variables of the shader's own are memories too; resources are not.
    for (const SpirvOperation& variable : module_.variables) {
        if (variable.operands[0] == spv::StorageClassPrivate) {
            const SpirvId pointee = module_.types.at(variable.type).element;
            globals_[variable.result].pointer =
                SymbolicPointer{newMemory(state, operations_.zeroOf(pointee)), 0, {}, pointee};
        }
    }
    const std::uint32_t outputs = arguments.empty() ? 0 : arguments.back().pointer->memory;
    GLINT_TRY(auto returned, call(function, std::move(arguments), state));
    Program program = builder_.take();
    program.outputs = *returned.state.memories.at(outputs);
    return program;
}

Result<Returned> Executor::call(const SpirvFunctionBody& function, std::vector<SymbolicValue> arguments,
                                SymbolicState state) {
    Frame frame{function, {}, {}, {}, {}};
    for (std::size_t k = 0; k < arguments.size(); ++k) {
        frame.values[function.parameters[k].result] = std::move(arguments[k]);
    }
    const NodeId guard = state.guard;
    frame.pending[function.blocks.front().order].push_back({0, std::move(state), {}, {}});
    std::map<std::uint32_t, const SpirvBlock*> blocks;
    for (const SpirvBlock& block : function.blocks) {
        blocks[block.order] = &block;
    }
    while (!frame.pending.empty()) {
        const auto next = frame.pending.begin();
        std::vector<IncomingEdge> edges = std::move(next->second);
        const SpirvBlock& block = *blocks.at(next->first);
        frame.pending.erase(next);
        if (++blocksRun_ > kMostBlocks || builder_.program().nodes.size() > kMostNodes) {
            return unsupported(fmt::format(
                "{} has more operations than can be followed, or a loop without a known end", function.name));
        }
        GLINT_TRY_DO(runBlock(frame, block, std::move(edges)));
    }
    if (frame.returns.empty()) {
        return unsupported(function.name + " does not return");
    }
    std::vector<SymbolicState> states;
    for (const Returned& returned : frame.returns) {
        states.push_back(returned.state);
    }
    Returned result;
    result.state = join(builder_, states);
    // All ways through a function end in a return.
    result.state.guard = guard;
    builder_.setGuard(guard);
    result.value = joined(states, frame.returns, [](const Returned& one) { return &one.value; });
    return result;
}

Status Executor::runBlock(Frame& frame, const SpirvBlock& block, std::vector<IncomingEdge> edges) {
    std::vector<SymbolicState> states;
    states.reserve(edges.size());
    for (IncomingEdge& edge : edges) {
        states.push_back(std::move(edge.state));
    }
    SymbolicState state = join(builder_, states);
    builder_.setGuard(state.guard);
    if (state.guard != kNoNode && ++frame.turns[block.label] > kMostTurns) {
        return unsupported("a loop without a known end");
    }
    for (const auto& [id, first] : edges.front().phis) {
        if (first.pointer) {
            return unsupported("a pointer that depends on a branch");
        }
        frame.values[id] =
            joined(states, edges, [key = id](const IncomingEdge& edge) { return &edge.phis.at(key); });
    }
    if (edges.size() > 1) {
        joinLoopValues(frame, edges, states);
    }
    for (const SpirvOperation& operation : block.operations) {
        if (operation.opcode == spv::OpPhi) {
            continue;
        }
        if (&operation == &block.operations.back()) {
            return branch(frame, block, state);
        }
        GLINT_TRY_DO(runOperation(frame, state, operation));
    }
    return okStatus();
}

Status Executor::leave(Frame& frame, const SpirvBlock& block, SpirvId target, SymbolicState state,
                       NodeId condition, bool holds) {
    if (condition != kNoNode) {
        if (builder_.isConstant(condition)) {
            if (builder_.isConstant(condition, holds ? 0.0 : 1.0)) {
                return okStatus();
            }
        } else {
            builder_.setGuard(state.guard);
            state.guard = builder_.both(state.guard, holds ? condition : builder_.opposite(condition));
            builder_.setGuard(state.guard);
            learn(builder_, state, condition, holds);
        }
    }
    const SpirvBlock& next = frame.function.blocks[frame.function.blockOf.at(target)];
    IncomingEdge edge{block.label, std::move(state), {}, {}};
    for (const SpirvOperation& operation : next.operations) {
        if (operation.opcode != spv::OpPhi) {
            break;
        }
        for (std::size_t k = 0; k + 1 < operation.operands.size(); k += 2) {
            if (operation.operands[k + 1] == block.label) {
                edge.phis[operation.result] = valueOf(frame, edge.state, operation.operands[k]);
            }
        }
    }
    keepLoopValues(frame, next, edge);
    frame.pending[next.order].push_back(std::move(edge));
    return okStatus();
}

// Code after a loop may use the loop's values, and each exit of the loop has its own.
void Executor::keepLoopValues(const Frame& frame, const SpirvBlock& next, IncomingEdge& edge) {
    for (const SpirvBlock& header : frame.function.blocks) {
        if (!header.isLoop || header.merge != next.label) {
            continue;
        }
        for (const SpirvBlock& block : frame.function.blocks) {
            if (block.order < header.order || block.order >= next.order) {
                continue;
            }
            for (const SpirvOperation& operation : block.operations) {
                if (operation.result != 0 && frame.values.contains(operation.result)) {
                    const SymbolicValue value = valueOf(frame, edge.state, operation.result);
                    if (!value.pointer && !value.nodes.empty()) {
                        edge.kept[operation.result] = value;
                    }
                }
            }
        }
    }
}

// Joins them where the loop ends.
void Executor::joinLoopValues(Frame& frame, const std::vector<IncomingEdge>& edges,
                              const std::vector<SymbolicState>& states) {
    for (const auto& [id, first] : edges.front().kept) {
        const bool inAll = std::all_of(edges.begin(), edges.end(), [key = id](const IncomingEdge& edge) {
            return edge.kept.contains(key);
        });
        if (inAll) {
            frame.values[id] =
                joined(states, edges, [key = id](const IncomingEdge& edge) { return &edge.kept.at(key); });
        }
    }
}

Status Executor::chooseBySwitch(Frame& frame, const SpirvBlock& block, const SymbolicState& state) {
    const SpirvOperation& last = block.operations.back();
    const NodeId selector = valueOf(frame, state, last.operands[0]).nodes[0];
    NodeId none = builder_.truth(true);
    for (std::size_t k = 2; k + 1 < last.operands.size(); k += 2) {
        builder_.setGuard(state.guard);
        const NodeId literal =
            builder_.constant(last.operands[k], Format::Integer, builder_.node(selector).isSigned);
        const NodeId chosen = builder_.make(Op::Equal, Format::Integer, selector, literal);
        GLINT_TRY_DO(leave(frame, block, last.operands[k + 1], state, chosen, true));
        builder_.setGuard(state.guard);
        none = builder_.make(Op::And, Format::Integer, none, builder_.opposite(chosen));
    }
    return leave(frame, block, last.operands[1], state, none, true);
}

Status Executor::branch(Frame& frame, const SpirvBlock& block, SymbolicState& state) {
    const SpirvOperation& last = block.operations.back();
    switch (last.opcode) {
        case spv::OpBranch:
            return leave(frame, block, last.operands[0], state, kNoNode, true);
        case spv::OpBranchConditional: {
            const NodeId condition = valueOf(frame, state, last.operands[0]).nodes[0];
            if (last.operands[1] == last.operands[2]) {
                return leave(frame, block, last.operands[1], state, kNoNode, true);
            }
            GLINT_TRY_DO(leave(frame, block, last.operands[1], state, condition, true));
            return leave(frame, block, last.operands[2], state, condition, false);
        }
        case spv::OpSwitch:
            return chooseBySwitch(frame, block, state);
        case spv::OpReturn:
            frame.returns.push_back({state, {}});
            return okStatus();
        case spv::OpReturnValue:
            frame.returns.push_back({state, valueOf(frame, state, last.operands[0])});
            return okStatus();
        case spv::OpKill:
        case spv::OpUnreachable:
            return okStatus();
        default:
            return unsupported(fmt::format("instruction {} at the end of a block", last.opcode));
    }
}

Status Executor::callFunction(Frame& frame, SymbolicState& state, const SpirvOperation& operation) {
    const auto callee =
        std::find_if(module_.functions.begin(), module_.functions.end(),
                     [&](const auto& function) { return function.id == operation.operands[0]; });
    std::vector<SymbolicValue> arguments;
    for (const SpirvId argument : operation.operands.subspan(1)) {
        arguments.push_back(valueOf(frame, state, argument));
    }
    GLINT_TRY(auto returned, call(*callee, std::move(arguments), state));
    state = std::move(returned.state);
    frame.values[operation.result] = std::move(returned.value);
    return okStatus();
}

Status Executor::access(Frame& frame, const SymbolicState& state, const SpirvOperation& operation) {
    const SymbolicValue base = valueOf(frame, state, operation.operands[0]);
    if (!base.pointer) {
        return unsupported("a pointer into a resource");
    }
    SymbolicPointer pointer = *base.pointer;
    for (const SpirvId index : operation.operands.subspan(1)) {
        const SpirvType& type = module_.types.at(pointer.pointee);
        const NodeId node = valueOf(frame, state, index).nodes[0];
        if (type.kind == Kind::Struct) {
            const auto member = static_cast<std::size_t>(builder_.node(node).value);
            pointer.offset += operations_.offsetOf(type, member);
            pointer.pointee = type.members[member];
            continue;
        }
        const std::uint32_t stride = module_.types.at(type.element).scalars;
        if (builder_.isConstant(node)) {
            pointer.offset += stride * static_cast<std::uint32_t>(builder_.node(node).value);
        } else {
            pointer.dynamic.push_back({node, stride, type.count});
        }
        pointer.pointee = type.element;
    }
    frame.values[operation.result].pointer = std::move(pointer);
    return okStatus();
}

Status Executor::load(Frame& frame, const SymbolicState& state, const SpirvOperation& operation) {
    const SymbolicValue from = valueOf(frame, state, operation.operands[0]);
    if (!from.pointer) {
        return unsupported("a load from a resource");
    }
    const std::vector<NodeId>& memory = *state.memories.at(from.pointer->memory);
    const std::uint32_t count = module_.types.at(operation.type).scalars;
    SymbolicValue value;
    for (std::uint32_t k = 0; k < count; ++k) {
        const NodeId node = operations_.elementOf(memory, from.pointer->offset + k, from.pointer->dynamic);
        if (node == kNoNode) {
            return unsupported("an index beyond its array");
        }
        value.nodes.push_back(state.resolve(node));
    }
    frame.values[operation.result] = std::move(value);
    return okStatus();
}

Status Executor::store(Frame& frame, SymbolicState& state, const SpirvOperation& operation) {
    const SymbolicValue to = valueOf(frame, state, operation.operands[0]);
    const SymbolicValue value = valueOf(frame, state, operation.operands[1]);
    if (!to.pointer || value.pointer) {
        return unsupported("a store to a resource");
    }
    if (to.pointer->dynamic.size() > 1) {
        return unsupported("a store with two indices that depend on the inputs");
    }
    Memory& memory = state.memories.at(to.pointer->memory);
    auto changed = std::make_shared<std::vector<NodeId>>(*memory);
    for (std::size_t k = 0; k < value.nodes.size(); ++k) {
        if (to.pointer->dynamic.empty()) {
            (*changed)[to.pointer->offset + k] = value.nodes[k];
            continue;
        }
        const DynamicIndex& index = to.pointer->dynamic.front();
        for (std::uint32_t element = 0; element < index.count; ++element) {
            NodeId& place = (*changed)[to.pointer->offset + element * index.stride + k];
            place = operations_.choose(operations_.equals(index.index, element), value.nodes[k], place);
        }
    }
    memory = std::move(changed);
    return okStatus();
}

Status Executor::runOperation(Frame& frame, SymbolicState& state, const SpirvOperation& operation) {
    switch (operation.opcode) {
        case spv::OpVariable: {
            const SpirvType& pointer = module_.types.at(operation.type);
            std::vector<NodeId> scalars = operation.operands.size() > 1
                                              ? valueOf(frame, state, operation.operands[1]).nodes
                                              : operations_.zeroOf(pointer.element);
            frame.values[operation.result].pointer =
                SymbolicPointer{newMemory(state, std::move(scalars)), 0, {}, pointer.element};
            return okStatus();
        }
        case spv::OpAccessChain:
        case spv::OpInBoundsAccessChain:
            return access(frame, state, operation);
        case spv::OpLoad:
            return load(frame, state, operation);
        case spv::OpStore:
            return store(frame, state, operation);
        case spv::OpFunctionCall:
            return callFunction(frame, state, operation);
        default:
            break;
    }
    std::vector<SymbolicValue> operands;
    const std::size_t idCount = operations_.idOperands(operation);
    for (std::size_t k = 0; k < idCount; ++k) {
        // The first operand of an extended instruction is its set.
        operands.push_back(operation.opcode == spv::OpExtInst && k < 2
                               ? SymbolicValue{}
                               : valueOf(frame, state, operation.operands[k]));
    }
    GLINT_TRY(frame.values[operation.result], operations_.apply(operation, operands));
    return okStatus();
}

}  // namespace

Result<Program> executeSymbolically(std::span<const std::uint32_t> words, const std::string& name) {
    GLINT_TRY(const auto module, readModule(words));
    const SpirvFunctionBody* const function = module.find(name);
    if (function == nullptr) {
        return unsupported("the module has no function " + name);
    }
    return Executor(module).run(*function);
}

}  // namespace glint::verify
