#include "emit/compile.h"
#include "emit/module_files.h"
#include "emit/modules.h"
#include "spirv/reader.h"
#include "support/features.h"
#include "support/must.h"
#include "unit/emit/sample_scene.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <spirv-tools/optimizer.hpp>

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <vector>

namespace glint {
namespace {

using namespace glint::testing;
using package::ModuleRole;

nlohmann::json manifestOf(const compiler::CompiledPackage& package) {
    return nlohmann::json::parse(textOf(findFile(package, package::kManifestFile)));
}

std::map<ModuleRole, int> countRoles(const compiler::CompiledPackage& package) {
    std::map<ModuleRole, int> counts;
    for (const compiler::CompiledModule& module : package.modules) {
        ++counts[module.key.role];
    }
    return counts;
}

TEST(CompilePackage, HasTheModulesOfItsStrategies) {
    compiler::CompileSettings settings;
    settings.plan.merge = compiler::MergePolicy::None;
    settings.strategies = package::kStrategyUber;
    auto uber = countRoles(compileSample(settings));
    EXPECT_EQ(uber.size(), 12U);
    EXPECT_EQ(uber[package::roleNamed("UberShade")], 1);
    EXPECT_EQ(uber[ModuleRole::Trace], 0);
    settings.strategies = package::kStrategyVisibility;
    auto visibility = countRoles(compileSample(settings));
    EXPECT_EQ(visibility.size(), 17U);
    EXPECT_EQ(visibility[package::roleNamed("ShadeCase")], 4);
    EXPECT_EQ(visibility[ModuleRole::BucketCount], static_cast<int>(package::Ordering::Count));
    EXPECT_EQ(visibility[package::roleNamed("UberShade")], 0);
    settings.strategies = package::kStrategyHitShaders;
    settings.shadows = package::ShadowPlacement::Deferred;
    auto hitShaders = countRoles(compileSample(settings));
    EXPECT_EQ(hitShaders[package::roleNamed("HitCase")], 4);
    EXPECT_EQ(hitShaders[ModuleRole::ShadowTrace], 1);
    EXPECT_EQ(hitShaders[ModuleRole::Trace], 0);
}

// The first frame waits for the draft. So it has the features that say so, no rays, and little code.
TEST(CompilePackage, WithAFallbackHasASmallDraft) {
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyUber;
    settings.plan.fallback = true;
    const compiler::CompiledPackage package = compileSample(settings);
    const auto find = [&](ModuleRole role) {
        return *std::ranges::find(package.modules, role,
                                  [](const compiler::CompiledModule& module) { return module.key.role; });
    };
    ASSERT_EQ(countRoles(package)[ModuleRole::FirstDraft], 1);
    const compiler::CompiledModule draft = find(ModuleRole::FirstDraft);
    EXPECT_EQ(draft.statistics.rayQueries, 0U);
    EXPECT_LT(2 * draft.statistics.instructions, find(ModuleRole::FirstFallback).statistics.instructions);
    const compiler::Case shown = compiler::draftCase(package.plan);
    EXPECT_EQ(shown.always, 0U);
    EXPECT_NE(shown.sometimes, 0U);
    for (const materials::Feature& feature : package.plan.model->features) {
        EXPECT_TRUE(feature.isInDraft || (shown.sometimes & feature.mask()) == 0) << feature.name;
    }
}

// It has no function that samples them, and its sky is there in any case.
TEST(CompilePackage, DraftsLeaveOutLightsThatRaysFind) {
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyUber;
    settings.plan.fallback = true;
    settings.emissiveLights = compiler::EmissiveLights::On;
    settings.skyLight = compiler::SkyLight::On;
    settings.sizedLights = compiler::SizedLights::On;
    EXPECT_EQ(countRoles(compileSample(settings))[ModuleRole::FirstDraft], 1);
}

// The texts of all modules that a package would have, with every strategy and tracer.
std::string textsWithLayers(std::vector<std::string> layers) {
    compiler::CompileSettings settings;
    settings.strategies = package::allStrategies();
    settings.tracers = package::kAllTracers;
    settings.effects = {false,
                        compiler::builtinEffects({"shadow", "reflection", "refraction", "indirect-diffuse"})};
    settings.plan.fallback = true;
    settings.maxBounces = 4;
    settings.layers = std::move(layers);
    const gltf::Scene scene = makeSampleScene();
    const Result<compiler::PackagePlan> planned = compiler::planPackage({&scene, 1}, settings);
    EXPECT_TRUE(planned.ok()) << (planned.ok() ? std::string() : toString(planned.error()));
    std::string texts;
    for (std::size_t i = 0; planned && i < planned->modules.size(); ++i) {
        texts += planned->modules[i].text;
    }
    return texts;
}

// What is not asked for leaves no code: neither layers as such, nor one layer beside another.
TEST(CompilePackage, LayersThatAreOffLeaveNoCode) {
    const std::string none = textsWithLayers({});
    const std::string depth = textsWithLayers({"depth"});
    const std::string all = textsWithLayers({"all"});
    for (const package::LayerInfo& layer : package::layerTable()) {
        if (layer.function.empty() || layer.isDiagnostic) {
            continue;
        }
        const std::string function(layer.function);
        EXPECT_EQ(none.find(function), std::string::npos) << function;
        EXPECT_NE(all.find(function), std::string::npos) << function;
        EXPECT_EQ(depth.find(function) != std::string::npos, layer.name == "depth") << function;
    }
    for (const char* const function : {"demodulated(", "varianceWith(", "meanWith("}) {
        EXPECT_NE(all.find(function), std::string::npos) << function;
        EXPECT_EQ(depth.find(function), std::string::npos) << function;
        EXPECT_EQ(none.find(function), std::string::npos) << function;
    }
}

TEST(CompilePackage, RefusesNoStrategy) {
    compiler::CompileSettings settings;
    settings.strategies = 0;
    EXPECT_EQ(mustFail(compilePackage(makeSampleScene(), settings)).id, "strategy");
}

TEST(CompilePackage, FetchesNoTextureThatTheCaseDoesNotHave) {
    compiler::CompileSettings settings;
    settings.plan.merge = compiler::MergePolicy::None;
    const compiler::CompiledPackage package = compileSample(settings);
    int casesSeen = 0;
    for (const compiler::CompiledModule& module : package.modules) {
        if (module.key.role != package::roleNamed("ShadeCase")) {
            continue;
        }
        const compiler::Case& shaderCase = package.plan.cases[module.key.index];
        std::uint32_t expected = 0;
        for (const char* const feature : {"baseColorTexture", "metallicRoughnessTexture", "normalTexture",
                                          "occlusionTexture", "emissiveTexture"}) {
            expected += (shaderCase.always & bit(feature)) != 0 ? 1 : 0;
        }
        EXPECT_EQ(module.statistics.textureFetches, expected) << module.name;
        ++casesSeen;
    }
    EXPECT_EQ(casesSeen, 4);
}

// A package of everything that traces: each strategy, tracer and effect, with tests of alpha, deferred shadow
// rays and paths.
const compiler::CompiledPackage& everythingThatTraces() {
    static const compiler::CompiledPackage kPackage = [] {
        compiler::CompileSettings settings;
        settings.plan.merge = compiler::MergePolicy::None;
        settings.plan.fallback = true;
        settings.strategies = package::allStrategies();
        settings.tracers = package::kAllTracers;
        settings.effects = {
            false, compiler::builtinEffects({"shadow", "reflection", "refraction", "indirect-diffuse"})};
        settings.shadowThrough = package::ShadowThrough::Glass;
        settings.maxBounces = 4;
        settings.skyLight = compiler::SkyLight::On;
        return compileSample(settings);
    }();
    return kPackage;
}

// Mesa's driver of Adreno makes invalid code of queries that share a load, and SPIRV-Tools merges loads.
TEST(CompilePackage, EachRayQueryHasItsOwnLoadOfAPlainStructure) {
    constexpr std::uint32_t kOpLoad = 61;
    constexpr std::uint32_t kOpRayQueryInitialize = 4473;
    std::size_t queries = 0;
    for (const compiler::CompiledModule& module : everythingThatTraces().modules) {
        std::set<std::uint32_t> loads;
        std::set<std::uint32_t> variables;
        compiler::SpirvInstruction before;
        ASSERT_TRUE(compiler::visitSpirv(module.spirv, [&](const compiler::SpirvInstruction& it) {
            if (it.opcode == kOpRayQueryInitialize) {
                ASSERT_EQ(before.opcode, kOpLoad) << module.name;
                EXPECT_EQ(before.operands[1], it.operands[1]) << module.name;
                EXPECT_TRUE(loads.insert(it.operands[1]).second) << module.name;
                variables.insert(before.operands[2]);
            }
            before = it;
        }));
        // An access chain would be another pointer for each query.
        EXPECT_LE(variables.size(), 1U) << module.name;
        EXPECT_EQ(loads.size(), module.statistics.rayQueries);
        queries += loads.size();
    }
    EXPECT_GT(queries, 10U);
}

std::size_t countAtomicAdds(std::span<const std::uint32_t> spirv) {
    constexpr std::uint32_t kOpAtomicIAdd = 234;
    std::size_t count = 0;
    EXPECT_TRUE(compiler::visitSpirv(
        spirv, [&](const compiler::SpirvInstruction& it) { count += it.opcode == kOpAtomicIAdd ? 1 : 0; }));
    return count;
}

// A driver knows specialisation constants, and drops branches that they rule out, as these passes do.
TEST(CompilePackage, CountersThatAreOffLeaveNoCode) {
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyUber;
    settings.effects = {false, compiler::builtinEffects({"shadow", "ambient-occlusion"})};
    const compiler::CompiledPackage package = compileSample(settings);
    // An unlit case counts nothing.
    const auto first =
        std::ranges::max_element(package.modules, {}, [](const compiler::CompiledModule& module) {
            return module.key.role == ModuleRole::FirstHit ? module.statistics.instructions : 0;
        });
    ASSERT_NE(first, package.modules.end());
    ASSERT_EQ(first->key.role, ModuleRole::FirstHit);
    EXPECT_GT(countAtomicAdds(first->spirv), 2U);
    spvtools::Optimizer driver(SPV_ENV_VULKAN_1_2);
    driver.RegisterPass(spvtools::CreateFreezeSpecConstantValuePass())
        .RegisterPass(spvtools::CreateFoldSpecConstantOpAndCompositePass())
        .RegisterPass(spvtools::CreateCCPPass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass());
    std::vector<std::uint32_t> left;
    ASSERT_TRUE(driver.Run(first->spirv.data(), first->spirv.size(), &left));
    EXPECT_EQ(countAtomicAdds(left), 0U);
}

// These are all that a module of Glint's own may ask of a device.
TEST(CompilePackage, ModulesNameTheFeaturesThatTheyNeed) {
    const compiler::CompiledPackage& package = everythingThatTraces();
    const std::set<std::string> known{"VK_SUBGROUP_FEATURE_ARITHMETIC_BIT",
                                      "VK_SUBGROUP_FEATURE_BALLOT_BIT",
                                      "VK_SUBGROUP_FEATURE_SHUFFLE_RELATIVE_BIT",
                                      "bufferDeviceAddress",
                                      "rayQuery",
                                      "rayTracingPipeline",
                                      "runtimeDescriptorArray",
                                      "shaderSampledImageArrayNonUniformIndexing",
                                      "shaderStorageImageExtendedFormats"};
    std::map<std::string, std::vector<std::string>> listed;
    const auto list = [&](const nlohmann::json& module) {
        listed[module.at("file")] = module.at("features").get<std::vector<std::string>>();
    };
    const nlohmann::json manifest = manifestOf(package);
    for (const nlohmann::json& pass : manifest.at("passes")) {
        list(pass);
    }
    for (const nlohmann::json& shader : manifest.at("shaders")) {
        std::ranges::for_each(shader.at("stages"), list);
    }
    for (const compiler::CompiledModule& module : package.modules) {
        const std::vector<std::string>& features = listed.at(module.file);
        EXPECT_EQ(features, package::featuresOf(module.spirv)) << module.file;
        for (const std::string& feature : features) {
            EXPECT_TRUE(known.contains(feature)) << module.file << " needs " << feature;
        }
        // Neither keys of buckets nor what a module declares and does not use ask for more.
        const bool ordersHits = module.key.role == ModuleRole::BucketCount ||
                                module.key.role == ModuleRole::BucketOffset ||
                                module.key.role == ModuleRole::OrderCheck;
        EXPECT_TRUE(!ordersHits || std::ranges::find(features, "runtimeDescriptorArray") == features.end());
        EXPECT_EQ(std::ranges::find(features, "rayQuery") != features.end(), module.statistics.rayQueries > 0)
            << module.file;
    }
}

TEST(CompilePackage, IsTheSameToTheByteWhateverTheJobs) {
    compiler::CompileSettings settings;
    settings.plan.merge = compiler::MergePolicy::None;
    settings.emitGlsl = true;
    settings.jobs = 1;
    // Without a cache, which would have the modules of the first for the second.
    const auto one = compilePackage(makeSampleScene(), settings);
    settings.jobs = 2;
    const auto two = compilePackage(makeSampleScene(), settings);
    ASSERT_TRUE(one) << toString(one.error());
    ASSERT_TRUE(two) << toString(two.error());
    ASSERT_EQ(one->files.size(), two->files.size());
    ASSERT_FALSE(one->files.empty());
    for (std::size_t i = 0; i < one->files.size(); ++i) {
        EXPECT_EQ(one->files[i].name, two->files[i].name);
        EXPECT_EQ(one->files[i].bytes, two->files[i].bytes) << one->files[i].name;
    }
    EXPECT_TRUE(std::ranges::is_sorted(one->files, {}, &compiler::PackageFile::name));
}

TEST(CompilePackage, EmitsTheGlslThatItCompiled) {
    compiler::CompileSettings settings;
    settings.emitGlsl = true;
    settings.emitHeader = false;
    const compiler::CompiledPackage package = compileSample(settings);
    EXPECT_EQ(findFile(package, "glint_tables.h"), nullptr);
    for (const compiler::CompiledModule& module : package.modules) {
        const std::string readable(textOf(findFile(package, "glsl/" + module.name)));
        EXPECT_EQ(readable.find("#include"), std::string::npos);
        EXPECT_EQ(readable.find("#line"), std::string::npos);
        const compiler::ShaderStage stage =
            module.key.role == ModuleRole::GBufferVertex     ? compiler::ShaderStage::Vertex
            : module.key.role == ModuleRole::GBufferFragment ? compiler::ShaderStage::Fragment
                                                             : compiler::ShaderStage::Compute;
        compiler::ShaderSource source{module.name, stage, readable};
        const bool hasSwitch = module.key.role == package::roleNamed("UberShade");
        if (hasSwitch) {
            for (const compiler::Case& shaderCase : package.plan.cases) {
                source.functionsApart.push_back("shade" + shaderCase.name);
            }
        }
        const std::vector<std::uint32_t> again = must(compiler::compileMeasured(source, {})).spirv;
        if (hasSwitch) {
            // Parts know more about themselves than the whole, so the words differ, but not what they do.
            const auto counts = compiler::measureSpirv(again);
            ASSERT_TRUE(counts);
            EXPECT_EQ(counts->textureFetches, module.statistics.textureFetches);
            EXPECT_EQ(counts->rayQueries, module.statistics.rayQueries);
            EXPECT_LE(counts->functions, module.statistics.functions);
            // Parts hand each other values that the whole keeps in registers.
            EXPECT_LE(module.statistics.bytes, counts->bytes + counts->bytes / 8);
            continue;
        }
        EXPECT_EQ(again, module.spirv) << module.name;
    }
}

TEST(CompilePackage, RefusesMoreCasesThanAllowed) {
    compiler::CompileSettings settings;
    settings.plan.merge = compiler::MergePolicy::None;
    settings.plan.maxShaders = 3;
    const Diagnostic package = mustFail(compilePackage(makeSampleScene(), settings));
    EXPECT_EQ(package.id, "max-shaders");
    EXPECT_FALSE(package.message.empty());
    settings.plan.maxShaders = 4;
    EXPECT_TRUE(compilePackage(makeSampleScene(), settings, &sharedModules()));
}

TEST(Manifest, DescribesThePackage) {
    compiler::CompileSettings settings;
    settings.plan.merge = compiler::MergePolicy::None;
    const compiler::CompiledPackage package = compileSample(settings);
    const nlohmann::json manifest = manifestOf(package);
    EXPECT_EQ(manifest["format"], "glint-package");
    EXPECT_EQ(manifest["version"], package::kVersion);
    EXPECT_EQ(manifest["merge"], "none");
    EXPECT_EQ(manifest["strategies"], (nlohmann::json{"uber", "visibility"}));
    EXPECT_EQ(manifest["scenes"][0]["sources"][1]["file"], "data/sample.bin");
    EXPECT_EQ(manifest["counts"]["cases"], 4);
    EXPECT_TRUE(manifest["counts"]["keysPossible"].is_number_integer());
    EXPECT_EQ(manifest["counts"]["uniqueSpirv"], package.uniqueSpirv);
    EXPECT_EQ(manifest["buckets"], 5);
    ASSERT_EQ(manifest["effects"].size(), materials::builtinMaterialModel().effects.size());
    EXPECT_EQ(manifest["effects"][2]["name"], "reflection");
    EXPECT_EQ(manifest["effects"][2]["chosen"], true);
    EXPECT_EQ(manifest["effects"][3]["chosen"], false);
    EXPECT_EQ(manifest["features"].size(), materials::builtinMaterialModel().features.size());
    ASSERT_EQ(manifest["shaders"].size(), 4U);
    std::set<int> materials;
    for (std::size_t i = 0; i < 4; ++i) {
        const nlohmann::json& shader = manifest["shaders"][i];
        EXPECT_EQ(shader["id"], i);
        EXPECT_EQ(shader["keys"], 1);
        EXPECT_GT(shader["stages"]["visibility"]["instructions"], 0);
        for (const nlohmann::json& material : shader["materials"]) {
            materials.insert(material["index"].get<int>());
        }
    }
    EXPECT_EQ(materials, (std::set<int>{0, 1, 2, 3}));
    // The alpha mask is dropped, because hits are opaque.
    EXPECT_EQ(manifest["dropped"].size(), package.plan.dropped.size());
    // The manifest lists all files except itself.
    ASSERT_EQ(manifest["files"].size() + 1, package.files.size());
    for (const nlohmann::json& file : manifest["files"]) {
        const compiler::PackageFile* const found = findFile(package, file["file"].get<std::string>());
        ASSERT_NE(found, nullptr);
        EXPECT_EQ(file["hash"], base::hexHash(base::hashBytes(found->bytes)));
    }
}

TEST(Manifest, HoldsTheSettingsAndTheVariant) {
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyUber;
    const nlohmann::json usual = manifestOf(compileSample(settings));
    EXPECT_EQ(usual["settings"]["hitLobes"].size(),
              materials::builtinMaterialModel().names(materials::builtinMaterialModel().lobes).size());
    EXPECT_EQ(usual["settings"]["lights"], "all");
    EXPECT_EQ(usual["settings"]["energyCompensation"], true);
    EXPECT_EQ(usual["settings"]["textureLod"], "cones");
    EXPECT_EQ(usual["settings"]["precision"], 32);
    EXPECT_TRUE(usual["scenes"][0]["variant"].is_null());

    gltf::Scene scene = makeSampleScene();
    scene.variant = "Night";
    scene.materials[0]["sheenColorFactor"] = {1.0F, 1.0F, 1.0F};
    settings.plan.keys.keptLobes = bit("unlit") | bit("ior");
    settings.lightSamples = 4;
    settings.energyCompensation = false;
    settings.textureLod = compiler::TextureLod::Mip0;
    settings.precision = package::ShadingPrecision::Half;
    const auto package = must(compilePackage(scene, settings, &sharedModules()));
    const nlohmann::json other = manifestOf(package);
    EXPECT_EQ(other["settings"]["hitLobes"], (nlohmann::json{"unlit", "ior"}));
    EXPECT_EQ(other["settings"]["lights"], 4);
    EXPECT_EQ(other["settings"]["energyCompensation"], false);
    EXPECT_EQ(other["settings"]["textureLod"], "mip0");
    EXPECT_EQ(other["settings"]["precision"], 16);
    EXPECT_EQ(other["scenes"][0]["variant"], "Night");
    const auto& dropped = other["dropped"];
    EXPECT_TRUE(std::any_of(dropped.begin(), dropped.end(),
                            [](const auto& drop) { return drop["feature"] == "sheen"; }));
}

TEST(Manifest, TakesNamesThatAreNotUtf8) {
    gltf::Scene scene = makeSampleScene();
    scene.materials[0].name = "\xFF\xC0";
    const auto package = must(compiler::compilePackage(scene, {}, &sharedModules()));
    EXPECT_FALSE(manifestOf(package).empty());
}

}  // namespace
}  // namespace glint
