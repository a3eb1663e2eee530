// Every structure that host and device share must have the same layout in SPIR-V as in C++.

#include "emit/context.h"
#include "emit/material_layout.h"
#include "emit/package/header.h"
#include "spirv/reader.h"
#include "support/must.h"
#include "unit/emit/sample_scene.h"

#include <glslang/SPIRV/spirv.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <interop/frame.h>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace glint {
namespace {

using namespace glint::testing;

struct ReflectedStruct {
    std::string name;
    std::map<std::uint32_t, std::string> memberNames;
    std::map<std::uint32_t, std::uint32_t> offsets;
    std::uint32_t memberCount = 0;
    std::set<std::uint32_t> strides;  // of arrays of it
};

// Returns the structures by type ID: names, offsets, and the strides of arrays of them.
std::map<std::uint32_t, ReflectedStruct> reflect(std::span<const std::uint32_t> words) {
    std::map<std::uint32_t, ReflectedStruct> structs;
    std::map<std::uint32_t, std::uint32_t> strideOf;
    std::map<std::uint32_t, std::uint32_t> elementOf;
    const Status status = compiler::visitSpirv(words, [&](const compiler::SpirvInstruction& instruction) {
        const auto& operands = instruction.operands;
        switch (instruction.opcode) {
            case spv::OpName:
                structs[operands[0]].name = compiler::spirvString(operands.subspan(1));
                break;
            case spv::OpMemberName:
                structs[operands[0]].memberNames[operands[1]] = compiler::spirvString(operands.subspan(2));
                break;
            case spv::OpMemberDecorate:
                if (operands[2] == spv::DecorationOffset) {
                    structs[operands[0]].offsets[operands[1]] = operands[3];
                }
                break;
            case spv::OpDecorate:
                if (operands[1] == spv::DecorationArrayStride) {
                    strideOf[operands[0]] = operands[2];
                }
                break;
            case spv::OpTypeStruct:
                structs[operands[0]].memberCount = static_cast<std::uint32_t>(operands.size() - 1);
                break;
            case spv::OpTypeArray:
            case spv::OpTypeRuntimeArray:
                elementOf[operands[0]] = operands[1];
                break;
            default:
                break;
        }
    });
    EXPECT_TRUE(status);
    for (const auto& [array, stride] : strideOf) {
        structs[elementOf[array]].strides.insert(stride);
    }
    return structs;
}

void expectEqual(const compiler::StructLayout& layout, const ReflectedStruct& reflected,
                 const std::string& module) {
    SCOPED_TRACE(module + ", " + layout.name);
    ASSERT_EQ(reflected.memberCount, layout.members.size());
    for (std::uint32_t i = 0; i < reflected.memberCount; ++i) {
        ASSERT_TRUE(reflected.memberNames.contains(i));
        ASSERT_TRUE(reflected.offsets.contains(i));
        EXPECT_EQ(reflected.memberNames.at(i), layout.members[i].name);
        EXPECT_EQ(reflected.offsets.at(i), layout.members[i].offset) << layout.members[i].name;
    }
    for (const std::uint32_t stride : reflected.strides) {
        EXPECT_EQ(stride, layout.bytes);
    }
}

enum class Of { Frame, Deform, Steps };

// Returns the layouts of interop/deform.h, of what only packages with steps have, or all others.
std::vector<compiler::StructLayout> layoutsOf(Of of) {
    const Result<std::string> declarations = compiler::interopDeclarations();
    EXPECT_TRUE(declarations);
    Result<std::vector<compiler::StructLayout>> layouts = compiler::interopLayouts(*declarations);
    EXPECT_TRUE(layouts);
    std::erase_if(*layouts, [&](const compiler::StructLayout& layout) {
        constexpr std::string_view kOfSteps[] = {"SurfaceRecord", "VisibilityRay", "PrimitiveMaterials"};
        const bool ofSteps = std::ranges::find(kOfSteps, layout.name) != std::end(kOfSteps);
        const Of its = layout.name.starts_with("Deform") ? Of::Deform : ofSteps ? Of::Steps : Of::Frame;
        return its != of;
    });
    return *layouts;
}

// Compares the layouts in every module that has them; each must occur in at least one.
void expectInModules(const compiler::CompiledPackage& package,
                     std::span<const compiler::StructLayout> layouts) {
    std::set<std::string> seen;
    for (const compiler::CompiledModule& module : package.modules) {
        const auto structs = reflect(module.spirv);
        for (const compiler::StructLayout& layout : layouts) {
            for (const auto& [id, reflected] : structs) {
                // The same structure in registers has no offsets.
                if (reflected.name == layout.name && !reflected.offsets.empty()) {
                    seen.insert(layout.name);
                    expectEqual(layout, reflected, module.name);
                }
            }
        }
    }
    for (const compiler::StructLayout& layout : layouts) {
        EXPECT_TRUE(seen.contains(layout.name)) << layout.name << " is in no module";
    }
}

TEST(InteropLayout, IsThatOfCpp) {
    const std::vector<compiler::StructLayout> layouts = layoutsOf(Of::Frame);
    const auto find = [&](const char* name) {
        return *std::ranges::find(layouts, name, &compiler::StructLayout::name);
    };
    EXPECT_EQ(layouts.size(), 21U);
    const compiler::StructLayout frame = find("FrameConstants");
    EXPECT_EQ(frame.bytes, sizeof(gpu::FrameConstants));
    EXPECT_EQ(frame.members.front().name, "worldToClip");
    EXPECT_EQ(frame.members.back().name, "walkedLight");
    EXPECT_EQ(frame.members.back().offset, offsetof(gpu::FrameConstants, walkedLight));
    EXPECT_EQ(find("InstanceRecord").members.back().offset, offsetof(gpu::InstanceRecord, flags));
    EXPECT_EQ(find("GeometryRecord").bytes, sizeof(gpu::GeometryRecord));
    EXPECT_EQ(find("PushConstants").bytes, sizeof(gpu::PushConstants));
}

TEST(InteropLayout, HasNoOtherTypes) {
    const Diagnostic layouts =
        mustFail(compiler::interopLayouts("struct A {\n    uint a;  // ok\n    double b;\n};\n"));
    EXPECT_EQ(layouts.id, "internal");
    EXPECT_FALSE(compiler::interopLayouts("struct A {\n    uint a;\n"));
}

TEST(InteropLayout, IsTheSameInSpirv) {
    compiler::CompileSettings settings;
    settings.debugInfo = true;
    settings.plan.keys.alpha = package::AlphaPolicy::Tested;
    // FrameConstants is whole in such packages alone.
    settings.effects = {false, compiler::builtinEffects({"shadow", "reflection", "refraction"})};
    settings.skyLight = compiler::SkyLight::On;
    settings.sizedLights = compiler::SizedLights::On;
    settings.layers = {"motion", "virtual-motion", "refraction.radiance"};
    gltf::Scene scene = makeSampleScene();
    scene.materials[0]["transmissionFactor"] = 0.5F;
    const compiler::CompiledPackage package = must(compilePackage(scene, settings, &sharedModules()));
    expectInModules(package, layoutsOf(Of::Frame));
}

// The record of a material is declared, so its layout is made and not compiled.
TEST(InteropLayout, OfMaterialsIsThatOfThePackage) {
    compiler::CompileSettings settings;
    settings.debugInfo = true;
    const compiler::CompiledPackage package = compileSample(settings);
    const compiler::MaterialLayout layout = materialLayoutOf(package.plan);
    std::vector<compiler::MemberLayout> members;
    for (const compiler::RecordField& field : layout.fields) {
        members.push_back({field.name, field.offset});
    }
    members.push_back({"textures", layout.textureOffset});
    const compiler::StructLayout record{"MaterialRecord", layout.bytes, members};
    expectInModules(package, {&record, 1});
}

TEST(InteropLayout, OfThePassThatDeformsLikewise) {
    gltf::Scene scene = makeSampleScene();
    scene.meshes[0].primitives[0].targets.resize(1);
    gltf::Node node;
    node.mesh = 0;
    scene.nodes.push_back(node);
    compiler::CompileSettings settings;
    settings.debugInfo = true;
    const compiler::CompiledPackage package = must(compilePackage(scene, settings, &sharedModules()));
    expectInModules(package, layoutsOf(Of::Deform));
}

TEST(InteropLayout, OfTheAnswerOfHostsRays) {
    compiler::CompileSettings settings;
    settings.debugInfo = true;
    settings.strategies = package::kStrategyUber;
    settings.passes = package::Passes::Steps;
    settings.answer = package::HitAnswer::Surface;
    settings.effects = {};
    expectInModules(compileSample(settings), layoutsOf(Of::Steps));
}

}  // namespace
}  // namespace glint
