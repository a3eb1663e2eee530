// Fuzzes a SPIR-V module, as `glint lint` and the statistics of `glint inspect` read it.
#include "fuzz/fuzz_target.h"
#include "spirv/lint.h"
#include "spirv/reader.h"

#include <cstring>
#include <vector>

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    constexpr std::size_t kHeaderWords = 5;
    std::vector<std::uint32_t> words(size / sizeof(std::uint32_t));
    if (!words.empty()) {
        std::memcpy(words.data(), data, words.size() * sizeof(std::uint32_t));
    }
    std::size_t visited = 0;
    const glint::Status read =
        glint::compiler::visitSpirv(words, [&](const glint::compiler::SpirvInstruction& instruction) {
            visited += instruction.operands.size() + 1;
            glint::compiler::spirvString(instruction.operands);
        });
    glint::fuzz::require(!read.ok() || visited + kHeaderWords == words.size(),
                         "every word belongs to an instruction");
    const glint::Result<glint::compiler::SpirvLint> lint = glint::compiler::lintSpirv(words);
    if (!lint) {
        glint::fuzz::require(!lint.error().id.empty(), "an error of the lint has an id");
        return 0;
    }
    for (const glint::compiler::LintFinding& finding : lint->findings) {
        glint::fuzz::require(finding.place.offset < words.size(), "a finding's place is in the module");
        glint::fuzz::require(!finding.rule.empty() && !finding.message.empty(),
                             "a finding has a rule and a message");
    }
    return 0;
}
