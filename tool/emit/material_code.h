// The generated GLSL that calls the code of material features.
#pragma once

#include "emit/material_layout.h"
#include "emit/source_set.h"
#include "materials/material_model.h"

#include <glint/result.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace glint::compiler {

// Returns the features with code that runs where alpha is tested.
materials::FeatureMask maskCodeFeatures(const materials::MaterialModel& model);

// Adds "generated/layers.glsl", "layers_sky.glsl", "layers_traced.glsl" and "material_stages.glsl" for the
// features of `used` to `generated`. `sources` has the templates. Has the errors of renderTemplate().
Status addMaterialCode(const SourceSet& sources, const materials::MaterialModel& model,
                       const materials::FeatureMask& used, SourceSet& generated);

// Adds "generated/mask_stages.glsl" in the same way: the code that decides about the opacity of candidates of
// rays and of rasterised triangles, which may be of any case. `used` must be the features of the whole
// package.
Status addMaskCode(const SourceSet& sources, const materials::MaterialModel& model,
                   const materials::FeatureMask& used, SourceSet& generated);

// Returns "generated/attributes.glsl": the attributes of vertices that the features of `used` read beside
// those of glTF.
std::string vertexAttributeCode(const materials::MaterialModel& model, const materials::FeatureMask& used);

// Says what to do about an error in GLSL to which packs or a host may have contributed, and which feature it
// is of. `host` is the folder of --host.
Diagnostic explainGlslError(Diagnostic error, const materials::MaterialModel& model, const std::string& host);

// The material code of modules that know their features: those of a case. Their text then has no code of
// other features, so that a change of a feature's GLSL leaves the shaders of other cases as they are.
class MaterialCodeOfCases {
public:
    // The model of the plan must outlive this.
    explicit MaterialCodeOfCases(const Plan& plan);

    // Returns whether those of another plan would have the same files.
    bool isOf(const Plan& plan) const;
    // Returns the files for keys with features of `used` alone. `sources` has the templates. Has the errors
    // of renderTemplate().
    Result<std::shared_ptr<const SourceSet>> find(const SourceSet& sources,
                                                  const materials::FeatureMask& used);

private:
    const materials::MaterialModel& model_;
    std::vector<RecordUse> records_;  // of the plan, on which the layout depends
    MaterialLayout layout_;
    materials::FeatureMask ofMasks_;       // maskCodeFeatures()
    materials::FeatureMask withCode_ = 0;  // all features that have code
    // By the features that have code.
    std::map<materials::FeatureMask, std::shared_ptr<const SourceSet>> made_;
};

}  // namespace glint::compiler
