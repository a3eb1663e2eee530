#include "spirv/statistics.h"

#include "spirv/reader.h"
#include "support/must.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <vector>

namespace glint {
namespace {

constexpr std::uint32_t kMagic = 0x07230203;

std::uint32_t first(std::uint32_t opcode, std::uint32_t words) {
    return words << 16U | opcode;
}

std::vector<std::uint32_t> header() {
    return {kMagic, 0x00010500, 0, 100, 0};
}

TEST(SpirvStatistics, CountsWithinFunctionsAlone) {
    std::vector<std::uint32_t> words = header();
    const std::vector<std::uint32_t> body = {
        first(19, 2),   1,                          // OpTypeVoid: outside
        first(54, 5),   1, 2,  0, 3,                // OpFunction
        first(248, 2),  4,                          // OpLabel: not counted
        first(8, 4),    5, 6,  7,                   // OpLine: not counted
        first(88, 7),   1, 8,  9, 10, 2, 11,        // OpImageSampleExplicitLod
        first(95, 5),   1, 12, 9, 10,               // OpImageFetch
        first(4473, 9), 1, 2,  3, 4,  5, 6,  7, 8,  // OpRayQueryInitializeKHR
        first(250, 4),  1, 2,  3,                   // OpBranchConditional
        first(251, 3),  1, 2,                       // OpSwitch
        first(56, 1),                               // OpFunctionEnd
    };
    words.insert(words.end(), body.begin(), body.end());
    const compiler::SpirvStatistics statistics = must(compiler::measureSpirv(words));
    EXPECT_EQ(statistics.bytes, words.size() * 4);
    EXPECT_EQ(statistics.instructions, 7U);
    EXPECT_EQ(statistics.textureFetches, 2U);
    EXPECT_EQ(statistics.rayQueries, 1U);
    EXPECT_EQ(statistics.branches, 2U);
}

TEST(SpirvStatistics, ReportsWhatIsNoModule) {
    std::vector<std::uint32_t> wrongMagic = header();
    wrongMagic[0] = 0x03022307;
    std::vector<std::uint32_t> zeroLength = header();
    zeroLength.push_back(0);
    std::vector<std::uint32_t> tooLong = header();
    tooLong.push_back(first(19, 3));
    tooLong.push_back(1);
    for (const auto& words : {std::vector<std::uint32_t>{}, {kMagic}, wrongMagic, zeroLength, tooLong}) {
        const Diagnostic statistics = mustFail(compiler::measureSpirv(words));
        EXPECT_EQ(statistics.id, "spirv-format");
        EXPECT_FALSE(statistics.message.empty());
    }
}

// Whatever follows a good header, the reader ends, and stays within the given words.
TEST(SpirvStatistics, SurvivesGarbage) {
    std::mt19937 engine(7);
    const auto random = [&] { return static_cast<std::uint32_t>(engine()); };
    for (int round = 0; round < 2000; ++round) {
        std::vector<std::uint32_t> words = header();
        const std::size_t count = random() % 64;
        for (std::size_t i = 0; i < count; ++i) {
            // Half of the lengths are short, so that walks get far.
            words.push_back(random() % 2 == 0 ? random() : first(random() % 300, random() % 4));
        }
        std::size_t visited = 5;
        const Status status = compiler::visitSpirv(words, [&](const compiler::SpirvInstruction& instruction) {
            visited += 1 + instruction.operands.size();
        });
        EXPECT_LE(visited, words.size());
        EXPECT_EQ(status.ok(), visited == words.size());
        EXPECT_EQ(compiler::measureSpirv(words).ok(), status.ok());
    }
}

TEST(SpirvReader, ReadsStringsThatLackTheirEnd) {
    const std::uint32_t abcd = 0x64636261;
    EXPECT_EQ(compiler::spirvString(std::vector<std::uint32_t>{abcd, 0x00000065}), "abcde");
    EXPECT_EQ(compiler::spirvString(std::vector<std::uint32_t>{abcd}), "abcd");
    EXPECT_EQ(compiler::spirvString({}), "");
}

}  // namespace
}  // namespace glint
