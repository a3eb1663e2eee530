#include "spirv/lint_flow.h"

#include "spirv/reader.h"

#include <glslang/SPIRV/spirv.hpp>

#include <algorithm>
#include <functional>
#include <map>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace glint::compiler {

namespace {

enum class Step { On, Stop };

// Visits all events of the object of `start` after it, along all paths that `visit` does not stop. If a loop
// leads back, the events behind `start` in its block are visited a second time. Returns whether a path
// reached the end of the function.
bool walk(const FlowFunction& function, EventPlace start, const std::function<Step(EventPlace)>& visit) {
    const std::size_t object = at(function, start).object;
    std::vector<bool> entered(function.blocks.size(), false);
    std::vector<EventPlace> pending{{start.block, start.event + 1}};
    bool reachedEnd = false;
    while (!pending.empty()) {
        EventPlace place = pending.back();
        pending.pop_back();
        const FlowBlock& block = function.blocks[place.block];
        bool stopped = false;
        for (; place.event < block.events.size() && !stopped; ++place.event) {
            stopped = block.events[place.event].object == object && visit(place) == Step::Stop;
        }
        if (stopped) {
            continue;
        }
        reachedEnd = reachedEnd || block.exits;
        for (const std::size_t successor : block.successors) {
            if (!entered[successor]) {
                entered[successor] = true;
                pending.push_back({successor, 0});
            }
        }
    }
    return reachedEnd;
}

}  // namespace

std::vector<EventPlace> eventsAfter(const FlowFunction& function, EventPlace start) {
    std::vector<EventPlace> events;
    walk(function, start, [&](EventPlace place) {
        if (at(function, place).act == QueryAct::Initialize) {
            return Step::Stop;
        }
        events.push_back(place);
        return Step::On;
    });
    std::sort(events.begin(), events.end());
    // walk() may visit an event twice.
    events.erase(std::unique(events.begin(), events.end()), events.end());
    return events;
}

bool canAvoid(const FlowFunction& function, EventPlace start, EventPlace via) {
    bool again = false;
    const bool reachedEnd = walk(function, start, [&](EventPlace place) {
        again = again || (place != via && at(function, place).act == QueryAct::Initialize);
        return place == via || at(function, place).act == QueryAct::Initialize ? Step::Stop : Step::On;
    });
    return again || reachedEnd;
}

bool repeats(const FlowFunction& function, EventPlace event) {
    bool repeated = false;
    walk(function, event, [&](EventPlace place) {
        repeated = repeated || place == event;
        return repeated || at(function, place).act == QueryAct::Initialize ? Step::Stop : Step::On;
    });
    return repeated;
}

namespace {

using Operands = std::span<const std::uint32_t>;

bool exitsFunction(std::uint32_t opcode) {
    switch (opcode) {
        case spv::OpReturn:
        case spv::OpReturnValue:
        case spv::OpKill:
        case spv::OpTerminateInvocation:
        case spv::OpIgnoreIntersectionKHR:
        case spv::OpTerminateRayKHR:
            return true;
        default:
            return false;  // includes OpUnreachable, which no path reaches
    }
}

// The labels of a switch stand behind literals of one word, or of two words if the selector has 64 bits. The
// second literal tells which: if it is read with the wrong stride, the upper half of a literal stands where a
// label should be.
std::vector<std::uint32_t> switchTargets(Operands operands,
                                         const std::map<std::uint32_t, std::size_t>& labels) {
    for (const std::size_t stride : {2U, 3U}) {
        std::vector<std::uint32_t> targets{operands[1]};
        for (std::size_t i = 1 + stride; i < operands.size(); i += stride) {
            targets.push_back(operands[i]);
        }
        const bool whole = (operands.size() - 2) % stride == 0;
        if (whole &&
            std::ranges::all_of(targets, [&](std::uint32_t label) { return labels.contains(label); })) {
            return targets;
        }
    }
    return {operands[1]};
}

std::vector<std::uint32_t> branchTargets(const SpirvInstruction& instruction,
                                         const std::map<std::uint32_t, std::size_t>& labels) {
    switch (instruction.opcode) {
        case spv::OpBranch:
            return {instruction.operands[0]};
        case spv::OpBranchConditional:
            return {instruction.operands[1], instruction.operands[2]};
        case spv::OpSwitch:
            return switchTargets(instruction.operands, labels);
        default:
            return {};
    }
}

class FlowReader {
public:
    explicit FlowReader(std::span<const std::uint32_t> words) {
        for (const SpirvInstruction& instruction : SpirvInstructions(words)) {
            visit(instruction);
        }
    }
    FlowModule take() {
        return std::move(module_);
    }

private:
    void visit(const SpirvInstruction& it) {
        switch (it.opcode) {
            case spv::OpConstant:
            case spv::OpSpecConstant:
                module_.constants[it.operands[1]] = it.operands[2];
                break;
            case spv::OpConstantNull:
                module_.constants[it.operands[1]] = 0;
                break;
            case spv::OpSpecConstantOp:
                fixed_.insert(it.operands[1]);
                break;
            case spv::OpTypeRayQueryKHR:
                queryTypes_.insert(it.operands[0]);
                break;
            case spv::OpTypeAccelerationStructureKHR:
                structureType_ = it.operands[0];
                break;
            case spv::OpLoad:
            case spv::OpConvertUToAccelerationStructureKHR:
                if (it.operands[0] == structureType_) {
                    structures_[it.operands[1]] = {it.operands[2], function_.blocks.size()};
                }
                break;
            case spv::OpTypeArray:
            case spv::OpTypePointer:
                if (queryTypes_.contains(it.operands[it.opcode == spv::OpTypeArray ? 1 : 2])) {
                    queryTypes_.insert(it.operands[0]);
                }
                break;
            case spv::OpAccessChain:
            case spv::OpInBoundsAccessChain:
            case spv::OpCopyObject:
                if (queryTypes_.contains(it.operands[0])) {
                    chains_[it.operands[1]] = it.operands;
                } else if (it.opcode != spv::OpCopyObject && isIndexed(it.operands)) {
                    indexed_.insert(it.operands[1]);
                }
                break;
            case spv::OpVariable:
            case spv::OpFunctionParameter:
                if (queryTypes_.contains(it.operands[0])) {
                    chains_[it.operands[1]] = {};
                }
                break;
            case spv::OpLine:
                line_ = it.operands[1];
                break;
            default:
                visitFlow(it);
        }
    }

    // Returns whether an access chain has an index that is no constant.
    bool isIndexed(Operands chain) const {
        return std::ranges::any_of(chain.subspan(3), [this](std::uint32_t index) {
            return !module_.constants.contains(index) && !fixed_.contains(index);
        });
    }

    void visitFlow(const SpirvInstruction& it) {
        switch (it.opcode) {
            case spv::OpFunction:
                function_ = {};
                labels_.clear();
                terminators_.clear();
                break;
            case spv::OpLabel:
                labels_[it.operands[0]] = function_.blocks.size();
                function_.blocks.emplace_back();
                break;
            case spv::OpBranch:
            case spv::OpBranchConditional:
            case spv::OpSwitch:
                terminators_.emplace_back(function_.blocks.size() - 1, it);
                break;
            case spv::OpFunctionCall:
                for (const std::uint32_t argument : it.operands.subspan(3)) {
                    if (chains_.contains(argument)) {
                        add({QueryAct::PassedOn, objectOf(argument), 0, 0});
                    }
                }
                break;
            case spv::OpFunctionEnd:
                finishFunction();
                break;
            default:
                if (isRayQueryInstruction(it.opcode)) {
                    addQuery(it);
                } else if (exitsFunction(it.opcode)) {
                    function_.blocks.back().exits = true;
                }
        }
    }

    void add(const QueryEvent& event) {
        function_.blocks.back().events.push_back(event);
    }

    void addQuery(const SpirvInstruction& it) {
        QueryEvent event;
        event.origin = line_;
        switch (it.opcode) {
            case spv::OpRayQueryInitializeKHR:
                event.act = QueryAct::Initialize;
                event.flags = it.operands[2];
                event.structure = it.operands[1];
                if (const auto load = structures_.find(event.structure); load != structures_.end()) {
                    event.structureIndexed = indexed_.contains(load->second.first);
                    event.structureElsewhere = load->second.second != function_.blocks.size();
                }
                [[fallthrough]];
            case spv::OpRayQueryTerminateKHR:
            case spv::OpRayQueryConfirmIntersectionKHR:
            case spv::OpRayQueryGenerateIntersectionKHR:
                event.object = objectOf(it.operands[0]);
                break;
            case spv::OpRayQueryProceedKHR:
                event.act = QueryAct::Proceed;
                event.object = objectOf(it.operands[2]);
                break;
            default:
                event.act = actOfRead(it);
                event.object = objectOf(it.operands[2]);
        }
        add(event);
    }

    QueryAct actOfRead(const SpirvInstruction& it) const {
        if (it.operands.size() < 4) {
            return QueryAct::Other;  // It asks about the ray, not about a hit.
        }
        const auto which = module_.constants.find(it.operands[3]);
        const bool candidate = which != module_.constants.end() &&
                               which->second == spv::RayQueryIntersectionRayQueryCandidateIntersectionKHR;
        if (candidate) {
            return QueryAct::Other;
        }
        return it.opcode == spv::OpRayQueryGetIntersectionTypeKHR ? QueryAct::ReadType : QueryAct::ReadHit;
    }

    // Follows access chains to the variable.
    std::size_t objectOf(std::uint32_t pointer) {
        QueryObject object;
        for (auto chain = chains_.find(pointer); chain != chains_.end() && !chain->second.empty();
             chain = chains_.find(pointer)) {
            pointer = chain->second[2];
            for (const std::uint32_t index : chain->second.subspan(3)) {
                const auto constant = module_.constants.find(index);
                object.dynamic = object.dynamic || constant == module_.constants.end();
                object.indices.push_back(constant == module_.constants.end() ? 0 : constant->second);
            }
        }
        object.variable = pointer;
        if (object.dynamic) {
            object.indices.clear();
        }
        const auto found = std::ranges::find(function_.objects, object);
        if (found == function_.objects.end()) {
            function_.objects.push_back(std::move(object));
            return function_.objects.size() - 1;
        }
        return static_cast<std::size_t>(found - function_.objects.begin());
    }

    void finishFunction() {
        for (const auto& [block, terminator] : terminators_) {
            for (const std::uint32_t label : branchTargets(terminator, labels_)) {
                if (const auto target = labels_.find(label); target != labels_.end()) {
                    function_.blocks[block].successors.push_back(target->second);
                }
            }
        }
        if (!function_.objects.empty()) {
            module_.functions.push_back(std::move(function_));
        }
        function_ = {};
    }

    FlowModule module_;
    FlowFunction function_;
    std::unordered_set<std::uint32_t> queryTypes_;        // ray queries, arrays of ray queries, and pointers
                                                          // to either
    std::unordered_map<std::uint32_t, Operands> chains_;  // pointers to ray queries; a variable has no
                                                          // operands here
    std::unordered_set<std::uint32_t> fixed_;             // results of operations on specialisation constants
    std::unordered_set<std::uint32_t> indexed_;           // pointers with an index that is no constant
    std::uint32_t structureType_ = 0;
    // The pointer that each loaded acceleration structure comes from, by its ID, and the number of blocks
    // until then.
    std::unordered_map<std::uint32_t, std::pair<std::uint32_t, std::size_t>> structures_;
    std::map<std::uint32_t, std::size_t> labels_;
    std::vector<std::pair<std::size_t, SpirvInstruction>> terminators_;
    std::size_t line_ = 0;
};

}  // namespace

const std::uint32_t* FlowModule::findConstant(std::uint32_t id) const {
    const auto found = constants.find(id);
    return found == constants.end() ? nullptr : &found->second;
}

FlowModule readFlow(std::span<const std::uint32_t> words) {
    return FlowReader(words).take();
}

}  // namespace glint::compiler
