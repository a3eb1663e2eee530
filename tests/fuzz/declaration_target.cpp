// Fuzzes the declaration of a material feature or an effect of a pack, beside those of Glint.
#include "fuzz/fuzz_target.h"
#include "materials/declaration_files.h"
#include "materials/declarations.h"
#include "materials/material.h"
#include "plan/plan.h"

#include <algorithm>
#include <vector>

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using glint::fuzz::require;
    std::vector<glint::materials::DeclarationFile> files;
    for (const glint::base::BuiltinFile& file : glint::materials::declarationFiles()) {
        files.push_back({file.name, file.text});
    }
    files.push_back({"pack/pack.json", glint::fuzz::asText(data, size), true});
    const glint::Result<glint::materials::MaterialModel> model = glint::materials::readDeclarations(files);
    if (!model) {
        require(model.error().id == "declaration" && !model.error().message.empty(),
                "an error has an id and a message");
        return 0;
    }
    for (const glint::materials::Feature& feature : glint::materials::builtinMaterialModel().features) {
        require(model->mask(feature.name) == feature.mask(), "a pack moves no bit of Glint's own features");
    }
    const std::vector<glint::materials::EffectDeclaration>& effects =
        glint::materials::builtinMaterialModel().effects;
    for (std::size_t i = 0; i < effects.size(); ++i) {
        require(model->effects[i].name == effects[i].name, "a pack moves no bit of Glint's own effects");
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
        for (int i = 0; parameter.aliasOf < 0 && i < parameter.channels; ++i) {
            material.values[static_cast<std::size_t>(parameter.first + i)] = parameter.hold(parameter.high);
        }
    }
    std::ranges::fill(material.given, std::uint8_t{1});
    require((glint::compiler::makeKey(material, primitive, {}) & ~all) == 0, "keys have declared features");
    return 0;
}
