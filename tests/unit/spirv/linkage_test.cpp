#include "spirv/compiler.h"
#include "spirv/reader.h"
#include "support/must.h"

#include <glslang/SPIRV/spirv.hpp>
#include <gtest/gtest.h>

#include <map>
#include <string>

namespace glint {
namespace {

constexpr const char* kSource =
    "#version 460\n"
    "layout(local_size_x = 1) in;\n"
    "struct Point { vec3 place; uint number; };\n"
    "float hostValue(const uint number) { return 0.0; }\n"
    "float hostUnused(const uint number) { return 0.0; }\n"
    "float scaled(const Point point) { return hostValue(point.number) * point.place.x; }\n"
    "void main() { scaled(Point(vec3(1.0), 2u)); }\n";

// What the module exports and imports by name, and how many of its instructions have an opcode.
struct Contents {
    std::map<std::string, std::uint32_t> linkage;
    std::map<std::uint32_t, int> opcodes;
};

Contents contentsOf(const std::vector<std::uint32_t>& words) {
    Contents contents;
    const Status status = compiler::visitSpirv(words, [&](const compiler::SpirvInstruction& instruction) {
        ++contents.opcodes[instruction.opcode];
        if (instruction.opcode == spv::OpDecorate &&
            instruction.operands[1] == spv::DecorationLinkageAttributes) {
            contents.linkage[compiler::spirvString(instruction.operands.subspan(2))] =
                instruction.operands.back();
        }
    });
    EXPECT_TRUE(status);
    return contents;
}

TEST(Linkage, ALibraryHasExportsAndImportsAndNoEntryPoint) {
    const auto words =
        must(compiler::compileLinkable({"library", compiler::ShaderStage::Compute, kSource, {}},
                                       {{"scaled"}, {"hostValue", "hostUnused"}}, {}));
    Contents contents = contentsOf(words);
    EXPECT_EQ(contents.linkage, (std::map<std::string, std::uint32_t>{{"hostValue", spv::LinkageTypeImport},
                                                                      {"scaled", spv::LinkageTypeExport}}));
    EXPECT_EQ(contents.opcodes[spv::OpEntryPoint], 0);
    EXPECT_EQ(contents.opcodes[spv::OpExecutionMode], 0);
    EXPECT_EQ(contents.opcodes[spv::OpName], 0);
    EXPECT_EQ(contents.opcodes[spv::OpVariable], 0);
    EXPECT_EQ(contents.opcodes[spv::OpFunction], 2);
    EXPECT_EQ(contents.opcodes[spv::OpLabel], 1);
    const std::string text = must(compiler::disassemble(words));
    // Parameters are passed by value, so that another front end can write the same signature.
    EXPECT_EQ(text.find("OpTypePointer"), std::string::npos) << text;
}

TEST(Linkage, AProgramKeepsItsEntryPoint) {
    const auto words = compiler::compileLinkable({"program", compiler::ShaderStage::Compute, kSource, {}},
                                                 {{"hostValue"}, {"scaled"}, true}, {});
    // hostValue() is called by scaled() alone, whose body goes.
    ASSERT_TRUE(words) << toString(words.error());
    Contents contents = contentsOf(*words);
    EXPECT_EQ(contents.opcodes[spv::OpEntryPoint], 1);
    EXPECT_EQ(contents.opcodes[spv::OpExecutionMode], 1);
    EXPECT_EQ(contents.linkage.at("hostValue"), std::uint32_t{spv::LinkageTypeExport});
    EXPECT_EQ(contents.linkage.at("scaled"), std::uint32_t{spv::LinkageTypeImport});
}

TEST(Linkage, RefusesToExportWhatIsNotThere) {
    const Diagnostic words = mustFail(compiler::compileLinkable(
        {"library", compiler::ShaderStage::Compute, kSource, {}}, {{"hostUnused"}, {}}, {}));
    EXPECT_EQ(words.id, "spirv-linkage");
}

}  // namespace
}  // namespace glint
