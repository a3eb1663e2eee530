// Fuzzes the declaration of a material feature or an effect of a pack, beside other declarations.
#include "fuzz/fuzz_target.h"
#include "fuzz/schema_mutator.h"
#include "materials/declaration_files.h"
#include "materials/declaration_members.h"
#include "materials/declarations.h"
#include "materials/material.h"
#include "plan/plan.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace {

using glint::materials::DeclarationFile;
using glint::materials::MaterialModel;

// Features that packs name. All of Glint's own take more than ten times as long to read, so most inputs are
// read beside these. Neither is parsed again for each input.
constexpr DeclarationFile kNeighbours[] = {
    {"materials/attributes/attributes.json",
     R"({"name": "attributes", "stage": "attributes", "features": [
         {"name": "vertexColor", "gltf": "meshes[].primitives[].attributes.COLOR_0", "given": "givesColors",
          "neutral": [{"when": "COLOR_0 == 1", "because": "colours are white"}]}]})"},
    {"materials/normal/normal.json",
     R"({"name": "normal", "stage": "surface", "glsl": {"surface": "normal.glsl"}, "parameters": [
         {"name": "normalScale", "at": "normalTexture/scale", "type": "float", "default": 1, "of": "normalTexture"}],
         "textures": [{"name": "normalTexture", "reads": "normal", "needs": "tangents",
                       "neutral": [{"when": "normalScale == 0", "because": "its scale is 0"}]}]})"},
    {"materials/specular/specular.json",
     R"({"name": "specular", "extension": "KHR_materials_specular", "stage": "surface",
         "glsl": {"surface": "specular.glsl"}, "parameters": [
         {"name": "specularFactor", "type": "float", "default": 1, "range": [0, 1]}],
         "neutral": [{"when": "specularFactor == 1", "because": "specularFactor is 1"}]})"},
    {"materials/anisotropy/anisotropy.json",
     R"({"name": "anisotropy", "extension": "KHR_materials_anisotropy", "stage": "layer",
         "glsl": {"bsdf": "anisotropy.glsl"}, "needs": "tangents", "parameters": [
         {"name": "anisotropyStrength", "type": "float", "default": 0, "range": [0, 1]}],
         "neutral": [{"when": "anisotropyStrength == 0", "because": "anisotropyStrength is 0"}]})"},
};

struct Others {
    glint::materials::ParsedDeclarations files;
    MaterialModel model;  // of these files alone
};

Others makeOthers(const std::vector<DeclarationFile>& files) {
    glint::Result<glint::materials::ParsedDeclarations> parsed = glint::materials::parseDeclarations(files);
    glint::fuzz::require(parsed.ok(), "the declarations without the input can be parsed");
    glint::Result<MaterialModel> model = glint::materials::readDeclarations(*parsed);
    if (!model) {
        std::fprintf(stderr, "%s\n", toString(model.error()).c_str());
    }
    glint::fuzz::require(model.ok(), "the declarations without the input can be read");
    return {std::move(*parsed), std::move(*model)};
}

// Glint's own declarations for one input in 256, chosen by its bytes, so that a finding can be repeated.
const Others& othersFor(const std::uint8_t* data, std::size_t size) {
    static const Others kFew = makeOthers({std::begin(kNeighbours), std::end(kNeighbours)});
    static const Others kAll = [] {
        std::vector<DeclarationFile> files;
        for (const glint::base::BuiltinFile& file : glint::materials::declarationFiles()) {
            files.push_back({file.name, file.text});
        }
        return makeOthers(files);
    }();
    std::uint8_t sum = 0;
    std::for_each(data, data + size,
                  [&](std::uint8_t byte) { sum = static_cast<std::uint8_t>(sum * 31 + byte); });
    return sum == 0 ? kAll : kFew;
}

}  // namespace

const glint::fuzz::InputSchema& glint::fuzz::inputSchema() {
    static const InputSchema kSchema{materials::declarationSchema(),
                                     {"wet",
                                      "wetTexture",
                                      "normalTexture",
                                      "normalScale",
                                      "specularFactor",
                                      "vertexColor",
                                      "anisotropy",
                                      "specular",
                                      "EXT_wet",
                                      "KHR_materials_specular",
                                      "wet.glsl",
                                      "rgba",
                                      "normal",
                                      "1 - a",
                                      "specularFactor.a",
                                      "doubleSided",
                                      "MASK or not BLEND",
                                      "has(wet)",
                                      "has(anisotropy)",
                                      "readable(normalTexture)",
                                      "wetness == 0",
                                      "specularFactor == 1",
                                      "wetness",
                                      "min(wetness, 0.5)",
                                      "texel(normalTexture).r == 1",
                                      "is {} at most",
                                      "_WEAR",
                                      "enum",
                                      "soft",
                                      "rim == soft",
                                      "rim",
                                      "radians",
                                      "infinity",
                                      "attribute(wear)"}};
    return kSchema;
}

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using glint::fuzz::require;
    const Others& others = othersFor(data, size);
    const DeclarationFile input{"pack/pack.json", glint::fuzz::asText(data, size), true};
    const glint::Result<MaterialModel> model = [&]() -> glint::Result<MaterialModel> {
        GLINT_TRY(auto files, glint::materials::parseDeclarations({&input, 1}));
        files.insert(files.end(), others.files.begin(), others.files.end());
        return glint::materials::readDeclarations(std::move(files));
    }();
    if (!model) {
        require(model.error().id == "declaration" && !model.error().message.empty(),
                "an error has an id and a message");
        return 0;
    }
    for (const glint::materials::Feature& feature : others.model.features) {
        require(model->mask(feature.name) == feature.mask(), "a pack moves no bit of the other features");
    }
    const std::vector<glint::materials::EffectDeclaration>& effects = others.model.effects;
    for (std::size_t i = 0; i < effects.size(); ++i) {
        require(model->effects[i].name == effects[i].name, "a pack moves no bit of the other effects");
    }
    glint::materials::FeatureMask all = 0;
    for (const glint::materials::Feature& feature : model->features) {
        require((all & feature.mask()) == 0, "features have bits of their own");
        all |= feature.mask();
    }
    // Keys of a material with every default, and of one with the ends of the ranges.
    glint::materials::Material material(*model);
    glint::materials::PrimitiveInputs primitive;
    primitive.hasNormals = primitive.hasTexCoords0 = true;
    const glint::materials::FeatureMask usual = glint::compiler::makeKey(material, primitive, {});
    require((usual & ~all) == 0, "keys have declared features");
    for (const glint::materials::Parameter& parameter : model->parameters) {
        for (int i = 0; parameter.aliasOf < 0 && i < parameter.numbers; ++i) {
            material.values.of(parameter)[static_cast<std::size_t>(i)] = parameter.hold(parameter.high);
        }
    }
    for (std::size_t object = 0; object < model->objects.size(); ++object) {
        material.given.add(static_cast<int>(object));
    }
    require((glint::compiler::makeKey(material, primitive, {}) & ~all) == 0, "keys have declared features");
    return 0;
}
