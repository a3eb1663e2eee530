#include "spirv/finish.h"

#include "spirv/join/parsed_module.h"
#include "spirv/reader.h"

#include <glslang/SPIRV/spirv.hpp>

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <utility>

namespace glint::compiler {

namespace {

using Words = std::vector<std::uint32_t>;

constexpr std::size_t kStructureOperand = 2;  // word of OpRayQueryInitializeKHR
constexpr std::size_t kStorageOperand = 2;    // word of OpTypePointer
constexpr std::size_t kPointeeOperand = 3;

// --- Loads of acceleration structures -------------------------------------------------------------

class FreshLoads {
public:
    explicit FreshLoads(const ParsedModule& module)
        : module_(module),
          definitions_(module.bound()),
          storage_(module.bound(), kNoPointer),
          types_(module.bound()),
          uses_(module.bound()) {
        for (const ParsedInstruction& global : module.globals) {
            if (global.opcode == spv::OpTypePointer) {
                storage_[global.result] = module.words[global.at + kStorageOperand];
            }
            types_[global.result] = global.type;
        }
        for (const ParsedFunction& function : module.functions) {
            for (const ParsedInstruction& instruction : function.body) {
                read(instruction);
            }
        }
    }

    Words make() {
        for (Query& query : queries_) {
            const std::uint32_t structure = module_.words[query.instruction.at + kStructureOperand];
            addPath(structure, query.path);
            dropUse(structure);
        }
        return write();
    }

private:
    static constexpr std::uint32_t kNoPointer = 0xFFFFFFFF;

    struct Query {
        ParsedInstruction instruction;
        std::vector<std::uint32_t> path;  // the instructions repeated before it, in that order
    };

    void read(const ParsedInstruction& instruction) {
        definitions_[instruction.result] = &instruction;
        types_[instruction.result] = instruction.type;
        for (std::size_t at = instruction.at + 1; at < instruction.at + instruction.length; ++at) {
            if (module_.isId[at]) {
                ++uses_[module_.words[at]];  // also of the result itself
            }
        }
        if (instruction.opcode == spv::OpRayQueryInitializeKHR) {
            queries_.push_back({instruction, {}});
        }
    }

    // Returns whether an instruction may be repeated at a later place with the same result.
    bool isRepeatable(std::uint32_t id) const {
        const ParsedInstruction* const definition = definitions_[id];
        if (id == 0 || definition == nullptr) {
            return false;
        }
        switch (definition->opcode) {
            case spv::OpAccessChain:
            case spv::OpInBoundsAccessChain:
            case spv::OpBitcast:
            case spv::OpConvertUToAccelerationStructureKHR:
                return true;
            case spv::OpLoad: {
                // Other memory is the shader's own, and it may have written to it since.
                const std::uint32_t storage = storage_[types_[module_.words[definition->at + 3]]];
                return storage == spv::StorageClassUniformConstant ||
                       storage == spv::StorageClassPushConstant ||
                       storage == spv::StorageClassPhysicalStorageBuffer;
            }
            default:
                return false;
        }
    }

    // Appends the instructions that make `id`, its operands first.
    void addPath(std::uint32_t id, std::vector<std::uint32_t>& path) const {
        if (!isRepeatable(id) || std::ranges::find(path, id) != path.end()) {
            return;
        }
        forOperands(id, [&](std::uint32_t operand) { addPath(operand, path); });
        path.push_back(id);
    }

    template <typename Visit>
    void forOperands(std::uint32_t id, const Visit& visit) const {
        const ParsedInstruction& definition = *definitions_[id];
        // The type and the result come first.
        for (std::size_t at = definition.at + 3; at < definition.at + definition.length; ++at) {
            if (module_.isId[at]) {
                visit(module_.words[at]);
            }
        }
    }

    void dropUse(std::uint32_t id) {
        constexpr std::uint32_t kOfItself = 1;
        if (--uses_[id] == kOfItself && isRepeatable(id)) {
            unused_.insert(id);
            forOperands(id, [&](std::uint32_t operand) { dropUse(operand); });
        }
    }

    // The first repetition of a removed instruction takes its ID, with its name and its decorations.
    std::uint32_t idFor(std::uint32_t id) {
        return unused_.contains(id) && taken_.insert(id).second ? id : bound_++;
    }

    void repeat(const Query& query, Words& to) {
        std::map<std::uint32_t, std::uint32_t> ids;
        const auto copy = [&](std::size_t at) {
            const auto found = module_.isId[at] ? ids.find(module_.words[at]) : ids.end();
            to.push_back(found == ids.end() ? module_.words[at] : found->second);
        };
        for (const std::uint32_t id : query.path) {
            ids[id] = idFor(id);
            const ParsedInstruction& definition = *definitions_[id];
            for (std::size_t at = definition.at; at < definition.at + definition.length; ++at) {
                copy(at);
            }
        }
        for (std::size_t at = query.instruction.at; at < query.instruction.at + query.instruction.length;
             ++at) {
            copy(at);
        }
    }

    Words write() {
        bound_ = module_.bound();
        Words to;
        to.reserve(module_.words.size());
        std::size_t from = 0;
        const auto keepUntil = [&](std::size_t end) {
            to.insert(to.end(), module_.words.begin() + static_cast<std::ptrdiff_t>(from),
                      module_.words.begin() + static_cast<std::ptrdiff_t>(end));
            from = end;
        };
        auto query = queries_.begin();
        for (const ParsedFunction& function : module_.functions) {
            for (const ParsedInstruction& instruction : function.body) {
                const bool starts = query != queries_.end() && query->instruction.at == instruction.at;
                if (starts || unused_.contains(instruction.result)) {
                    keepUntil(instruction.at);
                    from += instruction.length;
                }
                if (starts) {
                    repeat(*query++, to);
                }
            }
        }
        keepUntil(module_.words.size());
        to[kSpirvBoundWord] = bound_;
        return to;
    }

    const ParsedModule& module_;
    std::vector<const ParsedInstruction*> definitions_;  // by ID; of functions
    std::vector<std::uint32_t> storage_;                 // by ID; kNoPointer unless it is a pointer type
    std::vector<std::uint32_t> types_;                   // by ID
    std::vector<std::uint32_t> uses_;                    // by ID; in functions
    std::vector<Query> queries_;
    std::set<std::uint32_t> unused_;  // definitions that queries alone needed
    std::set<std::uint32_t> taken_;
    std::uint32_t bound_ = 0;
};

// --- Capabilities ---------------------------------------------------------------------------------

// Capabilities depend on these contents of a module.
struct Contents {
    std::set<std::uint32_t> opcodes;
    std::set<std::uint32_t> imageFormats;
    std::set<std::uint32_t> integerBits;
    std::set<std::uint32_t> floatBits;
    bool nonUniform = false;        // something is decorated so
    bool descriptorArrays = false;  // of any length: arrays without one
    bool indexesDescriptors = false;
};

Contents readContents(const ParsedModule& module) {
    Contents contents;
    std::map<std::uint32_t, const ParsedInstruction*> globals;
    std::set<std::uint32_t> arrays;  // variables
    const auto pointee = [&](const ParsedInstruction& variable) {
        return globals.at(module.words[globals.at(variable.type)->at + kPointeeOperand]);
    };
    for (const ParsedInstruction& global : module.globals) {
        globals[global.result] = &global;
        contents.opcodes.insert(global.opcode);
        const std::span<const std::uint32_t> words = module.wordsOf(global);
        if (global.opcode == spv::OpTypeImage) {
            contents.imageFormats.insert(words[8]);
        } else if (global.opcode == spv::OpTypeInt) {
            contents.integerBits.insert(words[2]);
        } else if (global.opcode == spv::OpTypeFloat) {
            contents.floatBits.insert(words[2]);
        } else if (global.opcode == spv::OpVariable && words[3] == spv::StorageClassUniformConstant) {
            const std::uint32_t type = pointee(global)->opcode;
            contents.descriptorArrays = contents.descriptorArrays || type == spv::OpTypeRuntimeArray;
            if (type == spv::OpTypeRuntimeArray || type == spv::OpTypeArray) {
                arrays.insert(global.result);
            }
        }
    }
    for (const auto& [target, decoration] : module.decorations.all()) {
        contents.nonUniform =
            contents.nonUniform || (decoration.opcode == spv::OpDecorate &&
                                    module.words[decoration.at + 2] == spv::DecorationNonUniform);
    }
    for (const ParsedFunction& function : module.functions) {
        for (const ParsedInstruction& it : function.body) {
            contents.opcodes.insert(it.opcode);
            contents.indexesDescriptors =
                contents.indexesDescriptors ||
                ((it.opcode == spv::OpAccessChain || it.opcode == spv::OpInBoundsAccessChain) &&
                 arrays.contains(module.words[it.at + 3]));
        }
    }
    return contents;
}

// The formats of storage images that every device has (Vulkan specification, "Required Format Support").
bool isBasicFormat(std::uint32_t format) {
    switch (format) {
        case spv::ImageFormatUnknown:
        case spv::ImageFormatRgba32f:
        case spv::ImageFormatRgba16f:
        case spv::ImageFormatR32f:
        case spv::ImageFormatRgba8:
        case spv::ImageFormatRgba8Snorm:
        case spv::ImageFormatRgba32i:
        case spv::ImageFormatRgba16i:
        case spv::ImageFormatRgba8i:
        case spv::ImageFormatR32i:
        case spv::ImageFormatRgba32ui:
        case spv::ImageFormatRgba16ui:
        case spv::ImageFormatRgba8ui:
        case spv::ImageFormatR32ui:
            return true;
        default:
            return false;
    }
}

bool hasOpcodes(const Contents& contents, std::uint32_t first, std::uint32_t last) {
    const auto found = contents.opcodes.lower_bound(first);
    return found != contents.opcodes.end() && *found <= last;
}

// Capabilities that are not named here are kept.
bool isNeeded(std::uint32_t capability, const Contents& contents) {
    switch (capability) {
        case spv::CapabilityStorageImageExtendedFormats:
            return !std::ranges::all_of(contents.imageFormats, isBasicFormat);
        case spv::CapabilityRuntimeDescriptorArray:
            return contents.descriptorArrays;
        case spv::CapabilitySampledImageArrayDynamicIndexing:
            return contents.indexesDescriptors;
        case spv::CapabilityShaderNonUniform:
        case spv::CapabilitySampledImageArrayNonUniformIndexing:
            return contents.nonUniform;
        case spv::CapabilityImageQuery:
            return hasOpcodes(contents, spv::OpImageQuerySizeLod, spv::OpImageQuerySamples);
        case spv::CapabilityGroupNonUniformVote:
            return hasOpcodes(contents, spv::OpGroupNonUniformAll, spv::OpGroupNonUniformAllEqual);
        case spv::CapabilityGroupNonUniformBallot:
            return hasOpcodes(contents, spv::OpGroupNonUniformBroadcast, spv::OpGroupNonUniformBallotFindMSB);
        case spv::CapabilityGroupNonUniformShuffle:
            return hasOpcodes(contents, spv::OpGroupNonUniformShuffle, spv::OpGroupNonUniformShuffleXor);
        case spv::CapabilityGroupNonUniformShuffleRelative:
            return hasOpcodes(contents, spv::OpGroupNonUniformShuffleUp, spv::OpGroupNonUniformShuffleDown);
        case spv::CapabilityGroupNonUniformArithmetic:
            return hasOpcodes(contents, spv::OpGroupNonUniformIAdd, spv::OpGroupNonUniformLogicalXor);
        case spv::CapabilityRayQueryKHR:
            return contents.opcodes.contains(spv::OpTypeRayQueryKHR);
        case spv::CapabilityRayTraversalPrimitiveCullingKHR:
            return contents.opcodes.contains(spv::OpRayQueryInitializeKHR) ||
                   contents.opcodes.contains(spv::OpTraceRayKHR);
        case spv::CapabilityFloat16:
            return contents.floatBits.contains(16);
        case spv::CapabilityInt64:
            return contents.integerBits.contains(64);
        case spv::CapabilityInt16:
            return contents.integerBits.contains(16);
        case spv::CapabilityInt8:
            return contents.integerBits.contains(8);
        case spv::CapabilityStorageBuffer16BitAccess:
            return contents.floatBits.contains(16) || contents.integerBits.contains(16);
        case spv::CapabilityStorageBuffer8BitAccess:
            return contents.integerBits.contains(8);
        default:
            return true;
    }
}

// Extensions that a capability needs and nothing else in Glint's modules.
bool isNeeded(const std::string& extension, const std::set<std::uint32_t>& capabilities) {
    if (extension == "SPV_KHR_ray_query") {
        return capabilities.contains(spv::CapabilityRayQueryKHR);
    }
    if (extension == "SPV_KHR_16bit_storage") {
        return capabilities.contains(spv::CapabilityStorageBuffer16BitAccess);
    }
    if (extension == "SPV_KHR_8bit_storage") {
        return capabilities.contains(spv::CapabilityStorageBuffer8BitAccess);
    }
    return true;
}

Words trim(const ParsedModule& module) {
    const Contents contents = readContents(module);
    std::set<std::uint32_t> kept;
    Words to(module.words.begin(), module.words.begin() + kSpirvHeaderWords);
    std::size_t at = kSpirvHeaderWords;
    for (const ParsedInstruction& global : module.globals) {
        const std::span<const std::uint32_t> words = module.wordsOf(global);
        bool needed = false;
        if (global.opcode == spv::OpCapability) {
            needed = isNeeded(words[1], contents);
            if (needed) {
                kept.insert(words[1]);
            }
        } else if (global.opcode == spv::OpExtension) {
            needed = isNeeded(spirvString(words.subspan(1)), kept);
        } else {
            break;
        }
        if (needed) {
            to.insert(to.end(), words.begin(), words.end());
        }
        at = global.at + global.length;
    }
    to.insert(to.end(), module.words.begin() + static_cast<std::ptrdiff_t>(at), module.words.end());
    return to;
}

// Says of loads of addresses that these are aligned to 8 bytes, as they are in every layout of Vulkan.
// glslang says the alignment of what the address points to, which
// VUID-StandaloneSpirv-PhysicalStorageBuffer64-06314 forbids.
void alignAddresses(Words& words) {
    constexpr std::uint32_t kAddressBytes = 8;
    constexpr std::size_t kAlignment = 5;  // word of OpLoad
    std::set<std::uint32_t> addresses;     // types
    for (const SpirvInstruction& it : SpirvInstructions(words)) {
        if (it.opcode == spv::OpTypePointer && it.operands[1] == spv::StorageClassPhysicalStorageBuffer) {
            addresses.insert(it.operands[0]);
        }
        if (it.opcode == spv::OpLoad && it.operands.size() >= kAlignment &&
            (it.operands[kAlignment - 2] & spv::MemoryAccessAlignedMask) != 0 &&
            addresses.contains(it.operands[0])) {
            words[it.at + kAlignment] = std::max(words[it.at + kAlignment], kAddressBytes);
        }
    }
}

}  // namespace

Status finishSpirv(std::vector<std::uint32_t>& words, const std::string& name) {
    GLINT_TRY_DO(widenLoads(words, name));
    alignAddresses(words);
    GLINT_TRY(ParsedModule module, parseModule(words, name));
    if (std::ranges::any_of(module.functions, [](const ParsedFunction& function) {
            return std::ranges::any_of(function.body, [](const ParsedInstruction& it) {
                return it.opcode == spv::OpRayQueryInitializeKHR;
            });
        })) {
        Words fresh = FreshLoads(module).make();
        words = std::move(fresh);
        GLINT_TRY(module, parseModule(words, name));
    }
    words = trim(module);
    return okStatus();
}

}  // namespace glint::compiler
