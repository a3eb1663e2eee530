// The library in shaders of the tests' own, against Glint's shading; and a host of the tests' own.
#include "base/files.h"
#include "emit/compile.h"
#include "emit/context.h"
#include "emit/glsl/passes.h"
#include "gltf/import.h"
#include "materials/declarations.h"
#include "plan/effects.h"
#include "render/hit_kernel.h"
#include "render/pixel_test.h"
#include "render/scene_builder.h"
#include "spirv/compiler.h"
#include "spirv/optimize.h"
#include "support/must.h"
#include "support/nightly.h"
#include "support/printed_files.h"
#include "support/shared_modules.h"
#include "support/temporary_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#ifdef GLINT_HAS_SPIRV_LINK
#include <spirv-tools/libspirv.hpp>
#include <spirv-tools/linker.hpp>
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

namespace glint::testing {
namespace {

const std::string kPacks = GLINT_SOURCE_DIR "/examples/materials";
const std::string kShaders = GLINT_SOURCE_DIR "/tests/render/shaders/";
constexpr std::size_t kValues = 32;  // as in library_values.comp
constexpr std::uint32_t kTilts = 4;
constexpr const char* kProduct =
    "#include \"bsdf/sample.glsl\"\n#include \"hit/shade.glsl\"\n#include \"generated/cases.glsl\"\n";

const gltf::Scene& packsScene() {
    static const gltf::Scene kScene = [] {
        const Result<const materials::MaterialModel*> model =
            materials::loadMaterialModel(std::vector{kPacks});
        EXPECT_TRUE(model) << toString(model.error());
        gltf::ImportOptions import;
        import.decodeImages = true;
        import.materialModel = *model;
        Result<gltf::Scene> scene = importScene(kPacks + "/scene.gltf", import);
        EXPECT_TRUE(scene) << toString(scene.error());
        return std::move(*scene);
    }();
    return kScene;
}

// The same with two materials, flakes under a clearcoat and triplanar textures. By night it has fibres, too.
const gltf::Scene& libraryScene() {
    static const gltf::Scene kScene = [] {
        gltf::Scene scene = packsScene();
        for (gltf::Node& node : scene.nodes) {
            const bool kept =
                node.mesh >= 0 && scene.meshes[static_cast<std::size_t>(node.mesh)].primitives[0].material %
                                          (test::nightly() ? 2 : 4) ==
                                      0;
            node.mesh = kept ? node.mesh : -1;
        }
        return scene;
    }();
    return kScene;
}

compiler::CompileSettings librarySettings() {
    compiler::CompileSettings settings;
    settings.plan.merge = compiler::MergePolicy::None;
    settings.strategies = package::kStrategyUber;
    settings.effects = {};
    return settings;
}

std::string textAt(const std::string& path) {
    const base::Bytes bytes = must(base::readFile(path));
    return std::string(bytes.begin(), bytes.end());
}

// The functions of each case. If they are inlined, compiling takes several times as long.
std::vector<std::string> functionsOfCases(const compiler::Plan& plan) {
    std::vector<std::string> names;
    for (const compiler::Case& shaderCase : plan.cases) {
        names.push_back("shade" + shaderCase.name);
        for (const char* const function :
             {"surface", "evaluate", "sample", "density", "radiance", "mirror", "shadeAll"}) {
            names.push_back(fmt::format("glint_{}OfCase{}", function, shaderCase.shaderId));
        }
    }
    return names;
}

// A scene with its library, and the values that kernels read from both.
class Library : public ::testing::Test {
protected:
    using Sky = std::array<gpu::vec3, 3>;

    static void SetUpTestSuite() {
        loaded_ = std::make_unique<LoadedScene>(libraryScene(), librarySettings());
        compiler::CompileSettings settings = librarySettings();
        settings.emitLibrary = true;
        settings.emitLinkable = true;
        files_ = must(makeLibrary(gltf::SceneList({&libraryScene(), 1}), loaded_->compiled().plan, settings,
                                  &sharedModules()));
        library_ = fileText("library/glint_library.glsl");
        both_ = must(HitKernel::create(*loaded_, must(compileShader(kernel(library_, true), {}))));
    }
    static void TearDownTestSuite() {
        both_.reset();
        loaded_.reset();
        files_.clear();
    }

    static std::string fileText(std::string_view name) {
        for (const compiler::PackageFile& file : files_) {
            if (file.name == name) {
                return {file.bytes.begin(), file.bytes.end()};
            }
        }
        ADD_FAILURE() << name;
        return {};
    }

    static std::uint32_t hits() {
        std::size_t geometries = 0;
        for (const gltf::Node& node : libraryScene().nodes) {
            geometries += node.mesh < 0
                              ? 0
                              : libraryScene().meshes[static_cast<std::size_t>(node.mesh)].primitives.size();
        }
        return static_cast<std::uint32_t>(geometries) * kTilts;
    }

    // The kernel's source with a text in the place of the library.
    static compiler::ShaderSource kernel(const std::string& library, bool product) {
        compiler::ShaderSource source{"library_values.comp", compiler::ShaderStage::Compute, {}, {}};
        const gltf::SceneList scenes({&libraryScene(), 1});
        const compiler::CompileSettings settings = librarySettings();
        compiler::SourceSet sources = must(makeSourceSet(scenes, loaded_->compiled().plan, settings));
        kainjow::mustache::data cases = compiler::makeContext(scenes, settings.plan);
        addCases(cases, scenes, loaded_->compiled().plan, settings.plan);
        sources.add("generated/cases.glsl", must(renderTemplate(sources, "cases.glsl.mustache", cases)));
        sources.add("library.glsl", library);
        sources.add("library_host.glsl", textAt(kShaders + "library_host.glsl"));
        std::string text = textAt(kShaders + source.name);
        text.insert(text.find('\n') + 1,
                    fmt::format("#define PRODUCT {}\nconst uint kTestMaterials = {}u;\n{}", product ? 1 : 0,
                                libraryScene().materials.size(), product ? kProduct : ""));
        const Result<compiler::GlslUnit> glsl =
            flatten(source.name, text, sources.lookup(), compiler::FlattenSide::Glsl);
        EXPECT_TRUE(glsl) << toString(glsl.error());
        source.glsl = glsl ? glsl->withPlaces() : "";
        source.functionsApart = functionsOfCases(loaded_->compiled().plan);
        return source;
    }

    // Returns the values that a kernel writes under a sky, `perHit` for each hit.
    static std::vector<float> valuesOf(HitKernel& kernel, const Sky& sky, std::size_t perHit) {
        gpu::FrameConstants constants{};
        constants.seed = 7;
        constants.skyZenith = sky[0];
        constants.skyHorizon = sky[1];
        constants.skyGround = sky[2];
        const std::vector<std::uint32_t> output = must(kernel.run(constants, {}, hits(), hits() * perHit));
        std::vector<float> values(output.size());
        std::memcpy(values.data(), output.data(), values.size() * sizeof(float));
        return values;
    }

    static inline std::unique_ptr<LoadedScene> loaded_;
    static inline std::vector<compiler::PackageFile> files_;
    static inline std::string library_;
    // Writes the values of the library and of the product. It takes longest to compile.
    static inline std::unique_ptr<HitKernel> both_;
};

void expectClose(float value, float reference, float tolerance, std::size_t hit, std::size_t place) {
    ASSERT_TRUE(std::isfinite(value)) << "hit " << hit << " value " << place;
    EXPECT_LE(std::abs(value - reference), tolerance * std::max(1.0F, std::abs(reference)))
        << "hit " << hit << " value " << place << ": " << value << " " << reference;
}

TEST_F(Library, GivesWhatTheRendererGives) {
    const Sky sky{{{0.3F, 0.5F, 0.9F}, {0.8F, 0.7F, 0.6F}, {0.1F, 0.2F, 0.1F}}};
    const std::vector<float> values = valuesOf(*both_, sky, 2 * kValues);
    float sum = 0.0F;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::size_t hit = i / (2 * kValues);
        const std::size_t place = i % (2 * kValues);
        if (place < kValues) {
            expectClose(values[i], values[i + kValues], 1e-5F, hit, place);
            sum += std::abs(values[i]);
        }
    }
    EXPECT_GT(sum, static_cast<float>(hits()));
}

#ifdef GLINT_HAS_SPIRV_LINK

// The part of a host that is written by hand, as another front end might: a sky of one colour.
constexpr const char* kSky = R"(
               OpCapability Shader
               OpCapability PhysicalStorageBufferAddresses
               OpCapability Linkage
               OpMemoryModel PhysicalStorageBuffer64 GLSL450
               OpDecorate %around LinkageAttributes "glintHostSkyAround" Export
               OpDecorate %irradiance LinkageAttributes "glintHostSkyIrradianceOverPi" Export
      %float = OpTypeFloat 32
    %v3float = OpTypeVector %float 3
        %of2 = OpTypeFunction %v3float %v3float %float
        %of1 = OpTypeFunction %v3float %v3float
          %r = OpConstant %float 0.25
          %g = OpConstant %float 0.5
          %b = OpConstant %float 0.75
     %colour = OpConstantComposite %v3float %r %g %b
     %around = OpFunction %v3float None %of2
  %direction = OpFunctionParameter %v3float
  %roughness = OpFunctionParameter %float
          %1 = OpLabel
               OpReturnValue %colour
               OpFunctionEnd
 %irradiance = OpFunction %v3float None %of1
     %normal = OpFunctionParameter %v3float
          %2 = OpLabel
               OpReturnValue %colour
               OpFunctionEnd
)";

// The program is the kernel, which imports the library's functions and exports the host's, but for the sky.
TEST_F(Library, LinkedGivesWhatTheGlslGives) {
    Sky sky;
    sky.fill({0.25F, 0.5F, 0.75F});
    const std::vector<float> expected = valuesOf(*both_, sky, 2 * kValues);

    // The declarations of the library, with bodies that are not used.
    std::string declared = library_.substr(0, library_.find("\n// Reads the surface that a ray has hit"));
    compiler::LinkNames names;
    names.keepsEntryPoint = true;
    const std::pair<const char*, const char*> functions[] = {
        {"GlintSurface glintSurface", "const GlintHit hit"},
        {"vec3 glintEvaluate", "const GlintSurface surface, const vec3 wo, const vec3 wi"},
        {"GlintSample glintSample", "const GlintSurface surface, const vec3 wo, const vec3 random"},
        {"float glintDensity", "const GlintSurface surface, const vec3 wo, const vec3 wi"},
        {"GlintRadiance glintRadiance", "const GlintSurface surface"},
        {"GlintMirror glintMirror", "const GlintSurface surface"}};
    for (const auto& [function, parameters] : functions) {
        const std::string head = function;
        const std::string type = head.substr(0, head.find(' '));
        declared += fmt::format("\n{}({}) {{\n    {} none;\n    return none;\n}}\n", head, parameters, type);
        names.imported.push_back(head.substr(type.size() + 1));
    }
    for (const char* const name :
         {"Geometry", "ObjectToWorld", "Vertex", "Position", "Normal", "Tangent", "TexCoord", "Color",
          "Materials", "Texture", "TextureFilter", "LightCount", "Light", "Random", "Attribute", "Time"}) {
        names.exported.push_back(std::string("glintHost") + name);
    }
    compiler::ShaderSource source = kernel(declared, false);
    // Every function that is exported is called.
    const std::string calls =
        "    store(glintHostNormal(0u, 0u) + glintHostTangent(0u, 0u).xyz + glintHostColor(0u, 0u).xyz);\n"
        "    store(glintHostTexCoord(0u, 0u, 0u).x + float(glintHostMaterials().x + "
        "glintHostLightCount(vec3(0.0))) +\n"
        "          float(glintHostGeometry(0u).shaderId) + glintHostRandom(0u, 0u) +\n"
        "          glintHostAttribute(0u, 0u, 0u) + glintHostTime());\n"
        "    store(glintHostTexture(0u, 0u, vec2(0.0), vec2(0.0), vec2(0.0)).x + glintHostTextureFilter(0u, "
        "0u).x +\n"
        "          glintHostLight(0u, vec3(0.0), vec3(0.0)).distance);\n";
    source.glsl.insert(source.glsl.rfind('}'), "    if (GLINT_FRAME.width == 0u) {\n" + calls + "    }\n");
    const std::vector<std::uint32_t> imports = must(compileLinkable(source, names, {}));

    const std::string bytes = fileText("library/glint_library.spv");
    std::vector<std::uint32_t> module(bytes.size() / sizeof(std::uint32_t));
    std::memcpy(module.data(), bytes.data(), bytes.size());
    std::string message;
    spvtools::Context context(SPV_ENV_UNIVERSAL_1_5);
    context.SetMessageConsumer(
        [&](spv_message_level_t, const char*, const spv_position_t&, const char* text) { message += text; });
    std::vector<std::uint32_t> hostSky;
    spvtools::SpirvTools tools(SPV_ENV_UNIVERSAL_1_5);
    ASSERT_TRUE(tools.Assemble(kSky, &hostSky));
    std::vector<std::uint32_t> linked;
    ASSERT_EQ(spvtools::Link(context, {imports, hostSky, module}, &linked), SPV_SUCCESS) << message;
    must(compiler::validateSpirv(linked, "linked"));

    const std::unique_ptr<HitKernel> program = must(HitKernel::create(*loaded_, linked));
    const std::vector<float> values = valuesOf(*program, sky, kValues);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::size_t hit = i / kValues;
        expectClose(values[i], expected[i + hit * kValues], 1e-6F, hit, i % kValues);
    }
}

#endif

std::string textOf(const compiler::PackageFile& file) {
    return {file.bytes.begin(), file.bytes.end()};
}

// Bodies for the functions that glint_host.glsl declares. What they return does not matter.
std::string hostBodies(const std::string& host) {
    std::string bodies;
    for (std::size_t place = host.find(" glintHost"); place != std::string::npos;
         place = host.find(" glintHost", place + 1)) {
        const std::size_t begin = host.rfind('\n', place) + 1;
        const std::string type = host.substr(begin, place - begin);
        if (type.find(' ') == std::string::npos) {
            const std::string head = host.substr(begin, host.find(';', place) - begin);
            bodies += fmt::format("{} {{\n    {} none;\n    return none;\n}}\n", head, type);
        }
    }
    return bodies;
}

// A shader of a user's own has nothing of Glint's but the library. At night it is that of the gallery.
TEST(LibraryFiles, CompileInAShaderOfAUser) {
    const gltf::Scene scene =
        must(test::nightly() ? gltf::importScene(GLINT_GALLERY_SCENE) : Result<gltf::Scene>(libraryScene()));
    const gltf::SceneList list({&scene, 1});
    compiler::CompileSettings settings = librarySettings();
    settings.plan.merge = compiler::MergePolicy::Family;
    settings.emitLibrary = true;
    const compiler::Plan plan = makePlan(list.materials(), list.primitives(), settings.plan);
    const std::vector<compiler::PackageFile> files = must(makeLibrary(list, plan, settings));
    ASSERT_EQ(files.size(), 2 + plan.cases.size());
    EXPECT_GE(plan.cases.size(), 2U);
    const std::string host = textOf(files.front());
    ASSERT_NE(hostBodies(host).find("glintHostTexture("), std::string::npos);
    // Names that a user may have, too.
    const std::string user =
        "struct Hit { float kPi; };\nfloat luminance(vec3 v) { return v.x; }\n"
        "layout(binding = 0) buffer Output { vec3 sum; };\nlayout(local_size_x = 1) in;\n"
        "void main() {\n";
    const std::string calls =
        "    GlintSurface surface = glintSurface(GlintHit(0u, 0u, vec2(0.3), sum, 0.0, 0u));\n"
        "    sum = glintEvaluate(surface, sum, sum) + glintRadiance(surface).radiance +\n"
        "          glintSample(surface, sum, sum).weight * glintDensity(surface, sum, sum) +\n"
        "          glintMirror(surface).weight + glintRayOrigin(surface, sum) +\n"
        "          glintShadeAll(surface, sum, sum, sum);\n";
    for (std::size_t i = 1; i < files.size(); ++i) {
        // Every text is compiled. Only the switch and one case are called, too, which takes most of the time.
        const std::string text = textOf(files[i]);
        for (const char* const foreign : {"void main", "binding", "push_constant", "#include", "#line"}) {
            EXPECT_EQ(text.find(foreign), std::string::npos) << files[i].name << ": " << foreign;
        }
        const Result<std::vector<std::uint32_t>> words = compiler::compileShader(
            {files[i].name, compiler::ShaderStage::Compute,
             "#version 460\n" + host + text + hostBodies(host) + user + (i <= 2 ? calls : "") + "}\n",
             functionsOfCases(plan)},
            {});
        EXPECT_TRUE(words) << toString(words.error());
    }
}

// Sums the lights of a wall as a host does: all of them, and all but the first.
constexpr const char* kLightLoop = R"(#version 460
const uint kTestMaterials = 1u;
#define GLINT_TEST_WITHOUT_TEXTURES
#include "library.glsl"
#include "library_host.glsl"

layout(local_size_x = kRayGroupSize) in;

void main() {
    GlintSurface surface = glintSurface(GlintHit(0u, 0u, vec2(0.3), vec3(0.0, 0.0, -1.0), 0.0, 0u));
    vec3 first = vec3(0.0);
    vec3 whole = vec3(0.0);
    for (uint i = 0u; i < glintHostLightCount(surface.position); ++i) {
        GlintLight light = glintHostLight(i, surface.position, vec3(0.0));
        vec3 scattered = glintEvaluate(surface, surface.view, light.direction) * light.irradiance;
        first = i == 0u ? scattered : first;
        whole += scattered;
    }
    vec3 seen[2] = vec3[](glintShadeAll(surface, surface.view, whole, whole),
                          glintShadeAll(surface, surface.view, whole, whole - first));
    for (uint i = 0u; i < 6u && gl_GlobalInvocationID.x == 0u; ++i) {
        GLINT_FRAME.counters.data[i] = floatBitsToUint(seen[i / 3u][i % 3u]);
    }
}
)";

// A wall of the model cel under two lights, of which a roof takes one away.
TEST(LibraryFiles, ModelsThatShadeAllLightsHaveTheTonesOfTheFrame) {
    const test::TemporaryFolder folder;
    test::writePrintedFiles("material_features.md", folder.path(),
                            {"cel/cel.json", "cel/cel.glsl", "cel/cel_surface.glsl"});
    materials::Material cel(*must(materials::loadMaterialModel(std::vector{folder.path().string()})));
    cel.give("EXAMPLE_materials_cel");
    cel["celColor"] = {0.6F, 0.4F, 0.2F, 1.0F};
    const auto room = [&](bool blocked) {
        gltf::Scene scene = sceneWithCamera();
        addQuad(scene, cel, {-3, -1, -6}, {6, 0, 0}, {0, 4, 0});
        if (blocked) {
            addQuad(scene, cel, {-40, 30, 1000}, {0, 0, -2000}, {39, 0, 0});
        }
        for (const float side : {0.48F, -0.48F}) {
            addDirectionalLight(scene, {side, -0.62F, -0.62F}, 1.5F);
        }
        return scene;
    };
    const auto middle = [&](bool blocked) {
        const gltf::Scene scene = room(blocked);
        compiler::CompileSettings settings;
        settings.strategies = package::kStrategyUber;
        settings.effects = {false, compiler::builtinEffects({"shadow"})};
        RenderSetup setup = defaultSetup(scene, 9, 9);
        setup.frame.sky = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
        return at(LoadedScene(scene, settings).render(package::kStrategyUber, setup), 4, 4);
    };

    const gltf::Scene scene = room(false);
    const gltf::SceneList list({&scene, 1});
    const LoadedScene loaded(scene, librarySettings());
    compiler::CompileSettings settings = librarySettings();
    settings.emitLibrary = true;
    const std::vector<compiler::PackageFile> files =
        must(makeLibrary(list, loaded.compiled().plan, settings));
    compiler::SourceSet sources = must(makeSourceSet(list, loaded.compiled().plan, settings));
    sources.add("library.glsl", textOf(files.at(1)));
    sources.add("library_host.glsl", textAt(kShaders + "library_host.glsl"));
    const std::string glsl =
        must(flatten("light_loop.comp", kLightLoop, sources.lookup(), compiler::FlattenSide::Glsl))
            .withPlaces();
    const auto kernel = must(HitKernel::create(
        loaded,
        must(compiler::compileShader({"light_loop.comp", compiler::ShaderStage::Compute, glsl, {}}, {}))));
    const std::vector<std::uint32_t> words = must(kernel->run({}, {}, 1, 6));
    const Pixel pixels[] = {middle(false), middle(true)};
    for (std::size_t i = 0; i < words.size(); ++i) {
        const float expected = pixels[i / 3][i % 3];
        EXPECT_GT(expected, 0.05F);
        EXPECT_NEAR(std::bit_cast<float>(words[i]), expected, 1e-5F) << i;
    }
}

TEST(Host, OfAnotherVertexLayoutGivesTheSamePicture) {
    RenderSetup setup = defaultSetup(packsScene(), 75, 30);
    compiler::CompileSettings settings;
    settings.strategies = package::kStrategyUber;
    settings.plan.merge = compiler::MergePolicy::All;
    const LoadedScene own(packsScene(), settings);
    settings.host = GLINT_SOURCE_DIR "/tests/render/host";
    const LoadedScene other(packsScene(), settings);
    const LinearImage reference = own.render(package::kStrategyUber, setup);
    expectSameImage(other.render(package::kStrategyUber, setup), reference, "host");
    // It is not the same shader.
    for (std::size_t i = 0; i < own.compiled().modules.size(); ++i) {
        const compiler::CompiledModule& module = own.compiled().modules[i];
        if (module.key.role == package::roleNamed("UberShade")) {
            EXPECT_NE(module.spirv, other.compiled().modules[i].spirv);
        }
    }
}

}  // namespace
}  // namespace glint::testing
