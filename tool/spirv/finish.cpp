#include "spirv/optimize.h"
#include "spirv/reader.h"

#include <glslang/SPIRV/spirv.hpp>

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <utility>

namespace glint::compiler {

namespace {

constexpr std::size_t kStructureOperand = 2;  // word of OpRayQueryInitializeKHR
constexpr std::size_t kStorageOperand = 2;    // word of OpTypePointer
constexpr std::size_t kPointeeOperand = 3;

// --- Loads of acceleration structures -------------------------------------------------------------

class FreshLoads {
public:
    explicit FreshLoads(const ParsedModule& module)
        : module_(module), uses_(module.bound()), bound_(module.bound()) {
        for (const SpirvInstruction& instruction : module.code) {
            // Also counts the result itself.
            module.forIds(instruction, [this](std::uint32_t id) { ++uses_[id]; });
            if (instruction.opcode == spv::OpRayQueryInitializeKHR) {
                queries_.push_back({instruction, {}});
            }
        }
    }

    SpirvWords make() {
        for (Query& query : queries_) {
            const std::uint32_t structure = query.instruction.words()[kStructureOperand];
            addPath(structure, query.path);
            dropUse(structure);
        }
        for (const Query& query : queries_) {
            edits_[query.instruction.at] = {repeated(query), true};
        }
        return edited(module_, edits_, {}, bound_);
    }

private:
    struct Query {
        SpirvInstruction instruction;
        std::vector<std::uint32_t> path;  // the instructions repeated before it, in that order
    };

    // Returns whether an instruction may be repeated at a later place with the same result.
    bool isRepeatable(std::uint32_t id) const {
        const SpirvInstruction* const definition = module_.definitions[id];
        if (definition == nullptr) {
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
                const std::uint32_t pointer = module_.typeOf(definition->operands[2]);
                const std::uint32_t storage = module_.definitions[pointer]->words()[kStorageOperand];
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
        constexpr std::size_t kAfterResult = 3;
        module_.forIds(*module_.definitions[id], visit, kAfterResult);
    }

    void dropUse(std::uint32_t id) {
        constexpr std::uint32_t kOfItself = 1;
        if (--uses_[id] == kOfItself && isRepeatable(id)) {
            unused_.insert(id);
            edits_[module_.definitions[id]->at].removes = true;
            forOperands(id, [&](std::uint32_t operand) { dropUse(operand); });
        }
    }

    // The first repetition of a removed instruction takes its ID, with its name and its decorations.
    std::uint32_t idFor(std::uint32_t id) {
        return unused_.contains(id) && taken_.insert(id).second ? id : bound_++;
    }

    SpirvWords repeated(const Query& query) {
        SpirvWords to;
        std::map<std::uint32_t, std::uint32_t> ids;
        const auto mapped = [&](std::uint32_t id) {
            const auto found = ids.find(id);
            return found == ids.end() ? id : found->second;
        };
        for (const std::uint32_t id : query.path) {
            ids[id] = idFor(id);
            module_.append(*module_.definitions[id], mapped, to);
        }
        module_.append(query.instruction, mapped, to);
        return to;
    }

    const ParsedModule& module_;
    std::vector<std::uint32_t> uses_;  // by ID; in functions
    std::vector<Query> queries_;
    std::set<std::uint32_t> unused_;  // definitions that queries alone needed
    std::set<std::uint32_t> taken_;
    SpirvEdits edits_;
    std::uint32_t bound_;
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
    std::set<std::uint32_t> arrays;  // variables
    for (const SpirvInstruction& global : module.globals) {
        contents.opcodes.insert(global.opcode);
        const std::span<const std::uint32_t> words = global.words();
        if (global.opcode == spv::OpTypeImage) {
            contents.imageFormats.insert(words[8]);
        } else if (global.opcode == spv::OpTypeInt) {
            contents.integerBits.insert(words[2]);
        } else if (global.opcode == spv::OpTypeFloat) {
            contents.floatBits.insert(words[2]);
        } else if (global.opcode == spv::OpVariable && words[3] == spv::StorageClassUniformConstant) {
            const std::uint32_t pointee = module.definitions[global.type]->words()[kPointeeOperand];
            const std::uint32_t type = module.definitions[pointee]->opcode;
            contents.descriptorArrays = contents.descriptorArrays || type == spv::OpTypeRuntimeArray;
            if (type == spv::OpTypeRuntimeArray || type == spv::OpTypeArray) {
                arrays.insert(global.result);
            }
        }
    }
    for (const auto& [target, decoration] : module.decorations.all()) {
        contents.nonUniform = contents.nonUniform || (decoration.opcode == spv::OpDecorate &&
                                                      decoration.words()[2] == spv::DecorationNonUniform);
    }
    for (const SpirvInstruction& it : module.code) {
        contents.opcodes.insert(it.opcode);
        contents.indexesDescriptors =
            contents.indexesDescriptors || (isAccessChain(it.opcode) && arrays.contains(it.operands[2]));
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

SpirvWords trim(const ParsedModule& module) {
    const Contents contents = readContents(module);
    std::set<std::uint32_t> kept;
    SpirvWords to(module.words.begin(), module.words.begin() + kSpirvHeaderWords);
    std::size_t at = kSpirvHeaderWords;
    for (const SpirvInstruction& global : module.globals) {
        const std::span<const std::uint32_t> words = global.words();
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
            appendWords(to, words);
        }
        at = global.at + words.size();
    }
    appendWords(to, module.words.subspan(at));
    return to;
}

// Says of loads of addresses that these are aligned to 8 bytes, as they are in every layout of Vulkan.
// glslang says the alignment of what the address points to, which
// VUID-StandaloneSpirv-PhysicalStorageBuffer64-06314 forbids.
void alignAddresses(SpirvWords& words) {
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
    if (std::ranges::find(module.code, std::uint32_t{spv::OpRayQueryInitializeKHR},
                          &SpirvInstruction::opcode) != module.code.end()) {
        SpirvWords fresh = FreshLoads(module).make();
        words = std::move(fresh);
        GLINT_TRY(module, parseModule(words, name));
    }
    words = trim(module);
    return okStatus();
}

}  // namespace glint::compiler
