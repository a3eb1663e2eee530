// A SPIR-V module as symbolic execution reads it: types, constants and functions of blocks.
#pragma once

#include <glint/result.h>

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

namespace glint::verify {

using SpirvId = std::uint32_t;

struct SpirvType {
    enum class Kind : std::uint8_t {
        Void,
        Bool,
        Integer,
        Float,
        Vector,
        Matrix,
        Array,
        RuntimeArray,
        Struct,
        Pointer,
        Other
    };
    Kind kind = Kind::Other;
    std::uint32_t width = 0;  // bits of a scalar
    bool isSigned = false;
    SpirvId element = 0;      // of vectors, matrices, arrays; the target of a pointer
    std::uint32_t count = 0;  // of elements
    std::vector<SpirvId> members;
    std::uint32_t scalars = 0;  // in the whole type; a pointer counts as one
    std::uint32_t storage = 0;  // of a pointer
};

struct SpirvOperation {
    std::uint32_t opcode = 0;
    SpirvId type = 0;                         // 0 if it has no result
    SpirvId result = 0;                       // 0 if it has none
    std::span<const std::uint32_t> operands;  // after type and result
};

struct SpirvBlock {
    SpirvId label = 0;
    std::vector<SpirvOperation> operations;  // the last one ends the block
    bool isLoop = false;                     // a loop begins here
    SpirvId merge = 0;                       // where the construct that begins here ends; 0 if none begins
    std::uint32_t order = 0;                 // in reverse postorder, with the merge block after its construct
};

struct SpirvFunctionBody {
    SpirvId id = 0;
    std::string name;
    SpirvId returnType = 0;
    std::vector<SpirvOperation> parameters;
    std::vector<SpirvBlock> blocks;
    std::unordered_map<SpirvId, std::size_t> blockOf;
};

struct SpirvModule {
    std::unordered_map<SpirvId, SpirvType> types;
    std::vector<SpirvOperation> constants;  // in order
    std::vector<SpirvOperation> variables;  // global
    std::vector<SpirvFunctionBody> functions;
    std::unordered_map<SpirvId, std::string> names;
    std::map<std::pair<SpirvId, std::uint32_t>, std::string> memberNames;
    SpirvId extended = 0;  // the import of GLSL.std.450

    const SpirvFunctionBody* find(const std::string& name) const;
};

// The module refers to `words`, which must be valid SPIR-V and live as long. Error "spirv-format".
Result<SpirvModule> readModule(std::span<const std::uint32_t> words);

}  // namespace glint::verify
