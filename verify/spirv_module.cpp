#include "verify/spirv_module.h"

#include "spirv/reader.h"

#include <glslang/SPIRV/spirv.hpp>

#include <algorithm>
#include <set>

namespace glint::verify {
namespace {

using compiler::SpirvInstruction;
using Kind = SpirvType::Kind;

class ModuleReader {
public:
    explicit ModuleReader(SpirvModule& module) : module_(module) {}
    void read(const SpirvInstruction& instruction);

private:
    bool readType(const SpirvInstruction& instruction);
    void readInFunction(const SpirvOperation& operation);
    void add(SpirvId id, SpirvType type);
    std::uint32_t constantOf(SpirvId id) const;

    SpirvModule& module_;
    bool inFunction_ = false;
};

std::uint32_t ModuleReader::constantOf(SpirvId id) const {
    for (const SpirvOperation& constant : module_.constants) {
        if (constant.result == id && !constant.operands.empty()) {
            return constant.operands[0];
        }
    }
    return 0;
}

void ModuleReader::add(SpirvId id, SpirvType type) {
    const auto scalarsOf = [this](SpirvId of) {
        const auto found = module_.types.find(of);
        return found == module_.types.end() ? 1U : found->second.scalars;
    };
    switch (type.kind) {
        case Kind::Vector:
        case Kind::Matrix:
        case Kind::Array:
            type.scalars = type.count * scalarsOf(type.element);
            break;
        case Kind::Struct:
            for (const SpirvId member : type.members) {
                type.scalars += scalarsOf(member);
            }
            break;
        case Kind::Void:
        case Kind::RuntimeArray:
            break;
        default:
            type.scalars = 1;
            break;
    }
    module_.types[id] = std::move(type);
}

bool ModuleReader::readType(const SpirvInstruction& instruction) {
    const auto word = [&](std::size_t k) {
        return k < instruction.operands.size() ? instruction.operands[k] : 0;
    };
    SpirvType type;
    switch (instruction.opcode) {
        case spv::OpTypeVoid:
            type.kind = Kind::Void;
            break;
        case spv::OpTypeBool:
            type.kind = Kind::Bool;
            break;
        case spv::OpTypeInt:
            type.kind = Kind::Integer;
            type.width = word(1);
            type.isSigned = word(2) != 0;
            break;
        case spv::OpTypeFloat:
            type.kind = Kind::Float;
            type.width = word(1);
            break;
        case spv::OpTypeVector:
        case spv::OpTypeMatrix:
            type.kind = instruction.opcode == spv::OpTypeVector ? Kind::Vector : Kind::Matrix;
            type.element = word(1);
            type.count = word(2);
            break;
        case spv::OpTypeArray:
            type.kind = Kind::Array;
            type.element = word(1);
            type.count = constantOf(word(2));
            break;
        case spv::OpTypeRuntimeArray:
            type.kind = Kind::RuntimeArray;
            type.element = word(1);
            break;
        case spv::OpTypeStruct:
            type.kind = Kind::Struct;
            type.members.assign(instruction.operands.begin() + 1, instruction.operands.end());
            break;
        case spv::OpTypePointer:
            type.kind = Kind::Pointer;
            type.storage = word(1);
            type.element = word(2);
            break;
        case spv::OpTypeForwardPointer:
        case spv::OpTypeFunction:
        case spv::OpTypeImage:
        case spv::OpTypeSampler:
        case spv::OpTypeSampledImage:
        case spv::OpTypeAccelerationStructureKHR:
        case spv::OpTypeRayQueryKHR:
            break;
        default:
            return false;
    }
    add(word(0), std::move(type));
    return true;
}

// Finds whether an instruction has a type and a result, for the instructions that the module may hold.
void shapeOf(std::uint32_t opcode, bool& hasType, bool& hasResult) {
    hasType = true;
    hasResult = true;
    switch (opcode) {
        case spv::OpStore:
        case spv::OpCopyMemory:
        case spv::OpSelectionMerge:
        case spv::OpLoopMerge:
        case spv::OpBranch:
        case spv::OpBranchConditional:
        case spv::OpSwitch:
        case spv::OpReturn:
        case spv::OpReturnValue:
        case spv::OpKill:
        case spv::OpUnreachable:
        case spv::OpFunctionEnd:
        case spv::OpNop:
        case spv::OpNoLine:
        case spv::OpLine:
        case spv::OpImageWrite:
        case spv::OpControlBarrier:
        case spv::OpMemoryBarrier:
            hasType = false;
            hasResult = false;
            break;
        case spv::OpLabel:
            hasType = false;
            break;
        default:
            break;
    }
}

bool isConstantOpcode(std::uint32_t opcode) {
    return (opcode >= spv::OpConstantTrue && opcode <= spv::OpSpecConstantOp) || opcode == spv::OpUndef;
}

void ModuleReader::readInFunction(const SpirvOperation& operation) {
    SpirvFunctionBody& function = module_.functions.back();
    switch (operation.opcode) {
        case spv::OpFunctionParameter:
            function.parameters.push_back(operation);
            return;
        case spv::OpLabel:
            function.blockOf[operation.result] = function.blocks.size();
            function.blocks.emplace_back().label = operation.result;
            return;
        case spv::OpSelectionMerge:
        case spv::OpLoopMerge:
            function.blocks.back().merge = operation.operands[0];
            function.blocks.back().isLoop = operation.opcode == spv::OpLoopMerge;
            return;
        case spv::OpLine:
        case spv::OpNoLine:
        case spv::OpNop:
            return;
        default:
            function.blocks.back().operations.push_back(operation);
            return;
    }
}

void ModuleReader::read(const SpirvInstruction& instruction) {
    const auto& words = instruction.operands;
    if (instruction.opcode == spv::OpName) {
        module_.names[words[0]] = compiler::spirvString(words.subspan(1));
        return;
    }
    if (instruction.opcode == spv::OpMemberName) {
        module_.memberNames[{words[0], words[1]}] = compiler::spirvString(words.subspan(2));
        return;
    }
    if (instruction.opcode == spv::OpExtInstImport) {
        if (compiler::spirvString(words.subspan(1)) == "GLSL.std.450") {
            module_.extended = words[0];
        }
        return;
    }
    if (!inFunction_ && readType(instruction)) {
        return;
    }
    bool hasType = true;
    bool hasResult = true;
    shapeOf(instruction.opcode, hasType, hasResult);
    SpirvOperation operation;
    operation.opcode = instruction.opcode;
    std::size_t used = 0;
    if (hasType && words.size() > used) {
        operation.type = words[used++];
    }
    if (hasResult && words.size() > used) {
        operation.result = words[used++];
    }
    operation.operands = words.subspan(used);
    if (instruction.opcode == spv::OpFunction) {
        inFunction_ = true;
        SpirvFunctionBody function;
        function.id = operation.result;
        function.returnType = operation.type;
        const auto name = module_.names.find(function.id);
        if (name != module_.names.end()) {
            function.name = name->second.substr(0, name->second.find('('));
        }
        module_.functions.push_back(std::move(function));
        return;
    }
    if (instruction.opcode == spv::OpFunctionEnd) {
        inFunction_ = false;
        return;
    }
    if (inFunction_) {
        readInFunction(operation);
    } else if (isConstantOpcode(instruction.opcode)) {
        module_.constants.push_back(operation);
    } else if (instruction.opcode == spv::OpVariable) {
        module_.variables.push_back(operation);
    }
}

std::vector<SpirvId> successorsOf(const SpirvBlock& block) {
    const SpirvOperation& last = block.operations.back();
    switch (last.opcode) {
        case spv::OpBranch:
            return {last.operands[0]};
        case spv::OpBranchConditional:
            return {last.operands[1], last.operands[2]};
        case spv::OpSwitch: {
            std::vector<SpirvId> targets{last.operands[1]};
            for (std::size_t k = 3; k < last.operands.size(); k += 2) {
                targets.push_back(last.operands[k]);
            }
            return targets;
        }
        default:
            return {};
    }
}

// Numbers the blocks in reverse postorder. The merge block of a construct is visited first, so that it comes
// last.
void orderBlocks(SpirvFunctionBody& function) {
    std::set<SpirvId> seen;
    std::vector<std::size_t> postorder;
    const auto visit = [&](const auto& self, SpirvId label) -> void {
        if (!seen.insert(label).second) {
            return;
        }
        const std::size_t index = function.blockOf.at(label);
        const SpirvBlock& block = function.blocks[index];
        if (block.merge != 0) {
            self(self, block.merge);
        }
        const std::vector<SpirvId> successors = successorsOf(block);
        for (auto next = successors.rbegin(); next != successors.rend(); ++next) {
            self(self, *next);
        }
        postorder.push_back(index);
    };
    if (!function.blocks.empty()) {
        visit(visit, function.blocks.front().label);
    }
    for (std::size_t k = 0; k < postorder.size(); ++k) {
        function.blocks[postorder[k]].order = static_cast<std::uint32_t>(postorder.size() - 1 - k);
    }
}

}  // namespace

const SpirvFunctionBody* SpirvModule::find(const std::string& name) const {
    const auto found = std::find_if(functions.begin(), functions.end(),
                                    [&](const auto& function) { return function.name == name; });
    return found == functions.end() ? nullptr : &*found;
}

Result<SpirvModule> readModule(std::span<const std::uint32_t> words) {
    SpirvModule module;
    ModuleReader reader(module);
    const Status status =
        compiler::visitSpirv(words, [&](const SpirvInstruction& instruction) { reader.read(instruction); });
    if (!status) {
        return status.error();
    }
    for (SpirvFunctionBody& function : module.functions) {
        orderBlocks(function);
    }
    return module;
}

}  // namespace glint::verify
