#include "spirv/call_graph.h"

#include "spirv/reader.h"

#include <glslang/SPIRV/spirv.hpp>

#include <map>
#include <utility>

namespace glint::compiler {

namespace {

// glslang names functions like this: "shade(struct-Hit…;vf3;".
std::string withoutParameters(const std::string& name) {
    return name.substr(0, name.find('('));
}

}  // namespace

std::vector<SpirvFunction> findFunctions(std::span<const std::uint32_t> words) {
    std::vector<SpirvFunction> functions;
    std::map<std::uint32_t, std::string> names;
    for (std::size_t at = kSpirvHeaderWords; at < words.size() && words[at] >> spv::WordCountShift != 0;
         at += words[at] >> spv::WordCountShift) {
        switch (words[at] & spv::OpCodeMask) {
            case spv::OpName:
                names[words[at + 1]] =
                    spirvString(words.subspan(at + 2, (words[at] >> spv::WordCountShift) - 2));
                break;
            case spv::OpFunction: {
                SpirvFunction function;
                function.id = words[at + 2];
                function.name = withoutParameters(names[function.id]);
                function.controlWord = at + 3;
                functions.push_back(std::move(function));
                break;
            }
            case spv::OpFunctionCall:
                functions.back().calls.push_back(words[at + 3]);
                break;
            default:
                break;
        }
    }
    return functions;
}

void keepApart(std::vector<std::uint32_t>& words, const std::vector<SpirvFunction>& functions,
               const std::set<std::uint32_t>& apart) {
    for (const SpirvFunction& function : functions) {
        words[function.controlWord] =
            apart.contains(function.id) ? spv::FunctionControlDontInlineMask : spv::FunctionControlMaskNone;
    }
}

}  // namespace glint::compiler
