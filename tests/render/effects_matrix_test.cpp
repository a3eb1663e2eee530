// A package has exactly what its scene calls for: modules, pipelines, images, buffers, passes.
#include "render/harness.h"
#include "render/scene_builder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

namespace {

using namespace glint;
using namespace glint::testing;

// The properties of a scene.
struct Properties {
    bool light;
    bool smooth;
    bool glass;
    bool lit;  // otherwise everything is unlit, whatever else it says
};

gltf::Scene sceneWith(const Properties& has) {
    gltf::Scene scene = sceneWithCamera();
    materials::Material plaster;
    plaster["metallicFactor"] = 0.0F;
    materials::Material mirror = mirrorMaterial();
    if (!has.lit) {
        plaster.give("KHR_materials_unlit");
        mirror.give("KHR_materials_unlit");
    }
    materials::Material glass = plaster;
    glass.give("KHR_materials_transmission");
    glass["transmissionFactor"] = 0.75F;
    const auto place = [&](const materials::Material& material, float x) {
        addQuad(scene, material, {x, -1, -1}, {1, 0, 0}, {0, 2, 0});
    };
    place(plaster, -1.0F);
    if (has.smooth) {
        place(mirror, 0.0F);
    }
    if (has.glass) {
        place(glass, -0.5F);
    }
    if (has.light) {
        addDirectionalLight(scene, {0, 0, -1}, 1.0F);
    }
    return scene;
}

std::string describe(const Properties& has) {
    return std::string(has.lit ? "lit" : "unlit") + (has.light ? ", light" : "") +
           (has.smooth ? ", smooth" : "") + (has.glass ? ", glass" : "");
}

// The names of the modules, without those of cases, and the numbers of cases' modules.
struct Modules {
    std::multiset<std::string> roles;
    std::size_t firstCases = 0;
    std::size_t cases = 0;
};

Modules modulesOf(const compiler::CompiledPackage& package) {
    Modules modules;
    for (const compiler::CompiledModule& module : package.modules) {
        if (module.key.role == package::roleNamed("ShadeCase")) {
            ++modules.cases;
        } else if (module.key.role == package::ModuleRole::FirstHit) {
            ++modules.firstCases;
        } else {
            modules.roles.insert(module.name);
        }
    }
    return modules;
}

std::vector<std::string> passesOf(Renderer& renderer) {
    const Result<std::vector<PassTiming>> timings = renderer.timings();
    EXPECT_TRUE(timings);
    std::vector<std::string> names;
    for (const PassTiming& timing : timings ? *timings : std::vector<PassTiming>{}) {
        // Counts one for each case, without the name of the case.
        names.push_back(timing.pass == Pass::ShadeCase   ? "shade"
                        : timing.pass == Pass::FirstCase ? "first"
                                                         : timing.name);
    }
    return names;
}

class EffectsMatrix : public ::testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(Scenes, EffectsMatrix, ::testing::Range(0, 16));

TEST_P(EffectsMatrix, PresentIsWhatIsCalledFor) {
    const Properties has{(GetParam() & 1) != 0, (GetParam() & 2) != 0, (GetParam() & 4) != 0,
                         (GetParam() & 8) != 0};
    SCOPED_TRACE(describe(has));
    const gltf::Scene scene = sceneWith(has);
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyVisibility;
    settings.effects = {true, 0};
    settings.plan.merge = compiler::MergePolicy::None;
    const LoadedScene loaded(scene, settings);

    // The expectation for each property is written by hand.
    const bool shadow = has.lit && has.light;
    const bool reflection = has.lit && has.smooth;
    const bool refraction = has.lit && has.glass;
    const bool rays = reflection || refraction;
    std::multiset<std::string> expected{"gbuffer.vert",    "gbuffer.frag",       "first_count.comp",
                                        "first_copy.comp", "bucket_offset.comp", "first_miss.comp",
                                        "compose.comp"};
    if (shadow) {
        expected.insert("first_shadows.comp");
    }
    if (rays) {
        expected.insert({"ray_dispatch.comp", "trace.comp", "shade_miss.comp", "order_check.comp"});
        for (const char* const ordering : {"global_atomics", "wave_loop", "wave_aggregated", "wave_ballot",
                                           "local_histogram", "tile_sort"}) {
            expected.insert({std::string("bucket_count_") + ordering + ".comp",
                             std::string("bucket_copy_") + ordering + ".comp"});
        }
    }
    if (reflection) {
        expected.insert("reflection_rays.comp");
    }
    if (refraction) {
        expected.insert({"refraction_rays.comp", "refraction_walk.comp"});
    }
    const Modules modules = modulesOf(loaded.compiled());
    EXPECT_EQ(modules.roles, expected);
    const std::size_t keys = loaded.compiled().plan.keys.size();
    EXPECT_EQ(modules.firstCases, keys);
    EXPECT_EQ(modules.cases, rays ? keys : 0);
    // Without shadows, only the list's own passes trace.
    for (const compiler::CompiledModule& module : loaded.compiled().modules) {
        const bool traces = module.statistics.rayQueries > 0;
        const bool mayTrace =
            module.name == "trace.comp" || module.name == "refraction_walk.comp" ||
            (shadow && (module.name == "first_shadows.comp" || module.name.starts_with("shade_")));
        EXPECT_TRUE(!traces || mayTrace) << module.name;
    }

    RendererOptions options;
    options.strategy = package::kStrategyVisibility;
    options.ordering = package::Ordering::GlobalAtomics;
    options.width = 16;
    options.height = 9;
    options.screenMarch = true;
    const auto renderer = loaded.makeRenderer(options);
    const Renderer::Footprint footprint = renderer->footprint();
    // G-buffer, compose; of first hits: count, offset, copy, misses, cases; and of the list: dispatch, trace,
    // count, copy, misses, cases.
    const auto cases = static_cast<std::uint32_t>(keys);
    std::uint32_t pipelines = 6 + cases + (shadow ? 1 : 0);
    pipelines += rays ? 5 + cases : 0;
    pipelines += reflection ? 1 : 0;
    pipelines += refraction ? 2 : 0;
    EXPECT_EQ(footprint.pipelines, pipelines);
    // The images are surface, radiance, mean, residual and depth; the march over the screen also needs
    // positions.
    EXPECT_EQ(footprint.images, 5U + (reflection ? 1U : 0U));
    // The buffers are constants, counters, read-back; order, keys, buckets and their dispatch; samples in
    // three parts, rays, hits and their dispatch; shadow rays and their numbers.
    EXPECT_EQ(footprint.buffers, 9U + (rays ? 6U : 0U) + (shadow ? 2U : 0U));

    FrameOptions frame = defaultSetup(scene, 16, 9).frame;
    frame.timing = Timing::Passes;
    ASSERT_TRUE(renderer->render(frame));
    std::vector<std::string> passes{"gbuffer", "first count", "first offset", "first copy", "first miss"};
    passes.insert(passes.end(), keys, "first");
    passes.insert(passes.end(), shadow ? 1 : 0, "first shadows");
    for (const char* const effect : {"reflection", "refraction"}) {
        const bool walks = effect == std::string("refraction");
        if (walks ? refraction : reflection) {
            if (walks) {
                passes.emplace_back("refraction walk");
            }
            passes.push_back(std::string(effect) + " rays");
            passes.insert(passes.end(), {"ray dispatch", "trace", "count", "offset", "copy", "shade miss"});
            passes.insert(passes.end(), keys, "shade");
        }
    }
    passes.emplace_back("compose");
    EXPECT_EQ(passesOf(*renderer), passes);
}

}  // namespace
