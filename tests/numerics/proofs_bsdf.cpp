// Domains and ranges of the claims in proofs_bsdf.glsl. Domains are those that the shaders' comments state.
#include "proof_inputs.h"

#include <deque>

namespace glint::numerics {
namespace {

using verify::OutputRange;

std::vector<OutputRange> components(const std::string& name, double size) {
    return {{name + ".x", -size, size}, {name + ".y", -size, size}, {name + ".z", -size, size}};
}

// None is negative, so that none is above the sum.
std::vector<OutputRange> sharesOfOne(double least = 0.0) {
    return {{"reflected", least, kAny}, {"passed", least, kAny}, {"sum", 1.0 - 1e-5, 1.0 + 1e-5}};
}

verify::InputRange etaInput() {
    return {"eta", 0.25, 4.0, verify::Scale::Logarithmic};
}

std::vector<Proof> exactProofs() {
    constexpr auto kUpper = Hemisphere::Upper;
    constexpr auto kWhole = Hemisphere::Whole;
    return {
        {"AddProduct",
         "exactAddProduct",
         "finite; the error is at most 1e-7 of the terms",
         {{rangeInput("a", -1000.0, 1000.0), rangeInput("b", -1000.0, 1000.0),
           rangeInput("c", -1000.0, 1000.0)},
          {{"sum", -1002000.0, 1002000.0}, {"error", -0.13, 0.13}}}},
        {"DifferenceOfProducts",
         "differenceOfProducts",
         "at most the sum of the products",
         {{rangeInput("a", -2.0, 2.0), rangeInput("b", -2.0, 2.0), rangeInput("c", -2.0, 2.0),
           rangeInput("d", -2.0, 2.0)},
          {{"difference", -8.00001, 8.00001}}}},
        {"AccurateDot",
         "accurateDot",
         "in [-1, 1] but for rounding",
         {inputs({unitInput("a", kWhole), unitInput("b", kWhole)}), {{"dot", -1.00001, 1.00001}}}},
        {"HalfCosine2",
         "halfCosine2",
         "a squared cosine, at most 1",
         {inputs({unitInput("a", kUpper), unitInput("b", kUpper)}),
          {{"squared", -1e-6, 1.00001}, {"error", -1e-6, 1e-6}}}},
        {"RefractedCosine2",
         "refractedCosine2",
         "at most 1; finite beyond the critical angle",
         {{cosineInput("cosine"), etaInput()}, {{"squared", -16.0, kOne}}},
         kManyBoxes},
        {"AccurateCrossOfSum",
         "accurateCrossOfSum",
         "finite, at most the length of the sum",
         {inputs({unitInput("n", kWhole), unitInput("a", kUpper), unitInput("b", kUpper)}),
          components("cross", 4.0)}},
    };
}

std::vector<Proof> fresnelProofs() {
    return {
        {"DielectricF0",
         "dielectricF0",
         "in [0, 1]",
         {{{"ior", 0.0, 1e6, verify::Scale::Logarithmic}}, {{"f0", 0.0, kOne}}},
         kManyBoxes},
        {"SchlickWeight",
         "schlickWeight",
         "in [0, 1]",
         {{rangeInput("cosine", 0.0, 1.0000002F)}, {{"weight", 0.0, 1.0}}}},
        {"SchlickRest",
         "schlickRest",
         "in [0, 1], and 1 with schlickWeight()",
         {{rangeInput("cosine", 0.0, 1.0000002F)}, {{"rest", 0.0, kOne}, {"sum", 1.0 - 1e-4, 1.0 + 1e-4}}}},
        {"FresnelSchlick",
         "fresnelSchlick, schlickPassed",
         "shares, together 1",
         {{shareInput("f0"), shareInput("f90 between f0 and 1"), rangeInput("cosine", 0.0, 1.0)},
          sharesOfOne()}},
        {"FresnelInterface",
         "fresnelInterface, interfacePassed",
         "shares, together 1",
         {{shareInput("f0"), shareInput("f90 between f0 and 1"), cosineInput("cosine"), etaInput()},
          sharesOfOne()}},
        {"SchlickF0",
         "schlickF0",
         "in [0, 1]",
         {{shareInput("reflectance"), shareInput("f90"), shareInput("cosine")}, {{"f0", 0.0, 1.0}}}},
        {"Luminance",
         "luminance",
         "in [0, 1] for colours in [0, 1]",
         {{shareInput("red"), shareInput("green"), shareInput("blue")}, {{"luminance", 0.0, kOne}}}},
    };
}

std::vector<Proof> ggxProofs() {
    constexpr auto kUpper = Hemisphere::Upper;
    return {
        {"GgxDistribution",
         "ggxDistribution",
         "positive, at most 1 / (pi alpha²)",
         {inputs({unitInput("h", Hemisphere::Whole), {alphaInput("alpha.x"), alphaInput("alpha.y")}}),
          {{"density", 0.0, 3.4e7}}}},
        {"GgxProjection",
         "ggxProjection",
         "positive, at most 1",
         {inputs({unitInput("v", kUpper), {alphaInput("alpha.x"), alphaInput("alpha.y")}}),
          {{"area", 1e-8, kOne}}}},
        {"GgxVisibility",
         "ggxVisibility",
         "finite and positive",
         {inputs({unitInput("l", kUpper),
                  unitInput("v", kUpper),
                  {alphaInput("alpha.x"), alphaInput("alpha.y")}}),
          {{"visibility", 0.0, kAny}}}},
        {"SampleVisibleNormal",
         "sampleVisibleNormal",
         "a unit vector above the surface",
         {inputs({unitInput("v", kUpper),
                  {alphaInput("alpha.x"), alphaInput("alpha.y"), randomInput("u.x"), randomInput("u.y")}}),
          {{"h.x", -kOne, kOne},
           {"h.y", -kOne, kOne},
           {"h.z", 0.0, kOne},
           {"length", 1.0 - 1e-5, 1.0 + 1e-5}}}},
        {"VisibleNormalPdf",
         "visibleNormalPdf",
         "finite, not negative",
         {inputs({unitInput("v", kUpper),
                  unitInput("h", Hemisphere::Whole),
                  {alphaInput("alpha.x"), alphaInput("alpha.y")}}),
          {{"density", 0.0, kAny}}}},
        {"MirroredPdf",
         "mirroredPdf",
         "finite, not negative",
         {inputs({unitInput("v", kUpper),
                  unitInput("h", Hemisphere::Whole),
                  {alphaInput("alpha.x"), alphaInput("alpha.y")}}),
          {{"density", 0.0, kAny}}}},
    };
}

std::vector<Proof> albedoProofs() {
    return {
        {"GgxLoss",
         "ggxLoss",
         "a share",
         {{cosineInput("nDotV"), alphaInput("alpha")}, {{"loss", 0.0, 1.0}}}},
        {"GgxAlbedo",
         "ggxAlbedo",
         "0 <= bias <= E <= 1",
         {{cosineInput("nDotV"), alphaInput("alpha")},
          {{"loss", 0.0, 1.0}, {"bias", 0.0, 1.0}, {"E - bias", -1e-6, 1.0}}}},
        {"GgxMeanAlbedo",
         "ggxMeanAlbedo",
         "shares, together at most 1",
         {{alphaInput("alpha")}, {{"loss", 0.0, 1.0}, {"bias", 0.0, 1.0}, {"E - bias", 0.0, 1.0}}}},
        {"AnisotropicGgxAlbedo",
         "anisotropicGgxAlbedo",
         "shares",
         {inputs(
              {unitInput("v", Hemisphere::Upper), {alphaInput("alpha.x"), alphaInput("alpha.y / alpha.x")}}),
          {{"loss", 0.0, 1.0}, {"bias", 0.0, 1.0}, {"E - bias", -1e-6, 1.0}}}},
        {"AnisotropicGgxMeanAlbedo",
         "anisotropicGgxMeanAlbedo",
         "shares",
         {{alphaInput("alpha.x"), alphaInput("alpha.y / alpha.x")},
          {{"loss", 0.0, 1.0}, {"bias", 0.0, 1.0}}}},
    };
}

std::vector<Proof> layerProofs() {
    return {
        {"SampleCosine",
         "sampleCosine, cosineDensity",
         "a direction above the surface, a density at most 1 / pi",
         {{randomInput("u.x"), randomInput("u.y")},
          {{"l.x", -kOne, kOne}, {"l.y", -kOne, kOne}, {"l.z", 0.0, 1.0}, {"density", 0.0, 0.31831}}}},
        {"ReflectAbout",
         "reflectAbout",
         "finite, at most the length 1 in each component",
         {inputs({unitInput("v", Hemisphere::Upper), unitInput("h", Hemisphere::Whole)}),
          components("l", 3.0)}},
        {"BuildBasis",
         "buildBasis",
         "components of unit vectors",
         {{rangeInput("n.z", -1.0, 1.0), rangeInput("azimuth of n", -3.1415927F, 3.1415927F)},
          {{"tangent.x", -kOne, kOne},
           {"tangent.y", -1.1, 1.1},
           {"tangent.z", -kOne, kOne},
           {"bitangent.x", -1.1, 1.1},
           {"bitangent.y", -kOne, kOne},
           {"bitangent.z", -kOne, kOne}}}},
        {"SheenDistribution",
         "sheenDistribution",
         "finite, not negative",
         {{shareInput("sine²"), sheenAlphaInput("alpha")}, {{"density", 0.0, 33.0}}}},
        {"SheenLambda",
         "sheenLambda",
         "finite, positive",
         {{cosineInput("cosine"), sheenAlphaInput("alpha")}, {{"lambda", 0.0, kAny}}}},
        {"SheenVisibility",
         "sheenVisibility",
         "finite, positive",
         {{cosineInput("nDotL"), cosineInput("nDotV"), sheenAlphaInput("alpha")},
          {{"visibility", 0.0, kAny}}}},
        {"SheenMasking",
         "sheenMasking",
         "finite, positive",
         {{cosineInput("nDotV"), sheenAlphaInput("alpha")}, {{"masking", 0.0, 10.0}}}},
        {"SheenHorizon",
         "sheenHorizon",
         "a share",
         {{cosineInput("nDotV"), sheenAlphaInput("alpha")}, {{"share", 0.0, 1.0}}}},
        {"SheenAlbedo",
         "sheenAlbedo",
         "finite, not negative",
         {{cosineInput("nDotV"), sheenAlphaInput("alpha")}, {{"albedo", 0.0, 1000.0}}}},
        {"SheenShares",
         "sheenShares",
         "shares, together 1",
         {{shareInput("color"), sheenAlphaInput("alpha"), cosineInput("nDotV")}, sharesOfOne()}},
        {"ClearcoatFresnel",
         "clearcoatFresnel, clearcoatPassed",
         "shares, together 1",
         {{shareInput("factor"), rangeInput("nDotV", 0.0, 1.0)}, sharesOfOne()}},
        {"ClearcoatProjection",
         "clearcoatProjection",
         "positive, at most 1",
         {{cosineInput("cosine"), alphaInput("alpha")}, {{"area", 1e-8, kOne}}}},
        {"ClearcoatGain",
         "clearcoatGain",
         "1 to 3.3",
         {{cosineInput("nDotV"), alphaInput("alpha")}, {{"gain", 1.0, 3.3}}}},
        {"CosineOfCycles",
         "cosineOfCycles",
         "in [-1, 1]",
         {{rangeInput("cycles", -1e6, 1e6)}, {{"cosine", -1.0, 1.0}}}},
        {"FilmSensitivity",
         "filmSensitivity",
         "finite",
         {{{"path difference", 0.0, 1e9, verify::Scale::Logarithmic}, rangeInput("turns", 0.0, 2.0)},
          components("sensitivity", 8.0)}},
        {"IridescentFresnel",
         "iridescentFresnel",
         "in [0, 1]",
         {{rangeInput("cosine", 0.0, 1.0),
           shareInput("base F0"),
           rangeInput("film's index", 1.0, 3.0),
           {"thickness", 0.0, 10000.0, verify::Scale::Logarithmic}},
          {{"reflectance", 0.0, 1.0}}}},
        {"DispersedIor",
         "dispersedIor",
         "finite",
         {{rangeInput("ior", 1.0, 4.0), rangeInput("dispersion", 0.0, 10.0)}, components("ior", 4.8)}},
        {"VolumeTransmittance",
         "volumeTransmittance",
         "a share",
         {{{"absorption", 0.0, 1e30, verify::Scale::Logarithmic},
           {"distance", 0.0, 1e8, verify::Scale::Logarithmic}},
          {{"share", 0.0, 1.0 + 1e-6}}}},
        {"RefractDirection",
         "refractDirection",
         "components of a unit vector",
         {inputs({unitInput("v", Hemisphere::Upper), unitInput("h", Hemisphere::Whole), {etaInput()}}),
          components("l", kOne)}},
        {"ThinTransmission",
         "thinTransmission",
         "finite, not negative",
         {inputs({unitInput("v", Hemisphere::Upper),
                  unitInput("-l", Hemisphere::Upper),
                  {alphaInput("alpha.x"), alphaInput("alpha.y")}}),
          {{"light", 0.0, kAny}, {"cosine", 0.0, 1.0}}}},
    };
}

// A view that prepareBsdf() takes as it is: no rounding makes its cosine less than kMinViewCosine.
std::vector<verify::InputRange> viewInput() {
    std::vector<verify::InputRange> view = unitInput("view", Hemisphere::Upper);
    view[0].low = 1.00001e-7F;
    return view;
}

// A surface with some lobes, about which CLAIMS_OF_SURFACE of proofs_bsdf.glsl makes claims.
struct ClaimedSurface {
    std::string name;
    std::string lobes;   // for people
    bool samplesFacets;  // in a way that other surfaces don't
    std::vector<verify::InputRange> own;
};

std::vector<Proof> surfaceProofs(const ClaimedSurface& of) {
    const std::vector<verify::InputRange> surface =
        inputs({{shareInput("f0"), alphaInput("alpha"), shareInput("color")}, viewInput()});
    const std::vector<verify::InputRange> lit = inputs({surface, unitInput("l", Hemisphere::Upper), of.own});
    const std::vector<verify::InputRange> drawn =
        inputs({surface, {randomInput("u.x"), randomInput("u.y"), randomInput("u.z")}, of.own});
    // Claims that read no direction leave its place out.
    const std::vector<verify::InputRange> alone =
        of.own.empty()
            ? surface
            : inputs({surface,
                      {rangeInput("azimuth (unused)", 0.0, 0.0), rangeInput("azimuth (unused)", 0.0, 0.0),
                       rangeInput("azimuth (unused)", 0.0, 0.0)},
                      of.own});
    // Proofs keep views of these.
    static std::deque<std::string> texts;
    const auto text = [&](const std::string& front, const std::string& back) -> std::string_view {
        return texts.emplace_back(front + back);
    };
    const std::string title = of.lobes.empty() ? std::string() : " (" + of.lobes + ")";
    std::vector<Proof> all{
        {text("Prepare", of.name),
         text("prepareBsdf", title),
         "shares",
         {alone, {{"loss", 0.0, 1.0}, {"bias", 0.0, 1.0}, {"mean loss", 0.0, 1.0}, {"mean bias", 0.0, 1.0}}}},
        {text("Evaluate", of.name),
         text("evaluateBsdf", title),
         "finite, not negative",
         {lit, {{"light", -1e-3, kAny}}}},
        {text("Density", of.name),
         text("bsdfPdf", title),
         "finite, not negative",
         {lit, {{"density", -1e-3, kAny}}}},
        {text("Chances", of.name),
         text("lobeChances", title),
         "chances, together 1",
         {alone,
          {{"microfacets", 0.0, kOne},
           {"diffuse", -1e-5, kOne},
           {"passed", -1e-5, kOne},
           {"sum", 0.999, 1.001}}}},
    };
    if (of.samplesFacets) {
        all.push_back({text("Sample", of.name),
                       text("baseSample", title),
                       "a vector of length 1 or 0: no longer than 1",
                       {drawn, {{"squared length", 0.0, 1.0 + 1e-4}}}});
    }
    return all;
}

std::vector<Proof> energyProofs() {
    const std::vector<verify::InputRange> reflectances{shareInput("f0"), shareInput("f90 between f0 and 1")};
    const verify::InputRange meanLoss = rangeInput("mean loss", 0.0, 0.75);
    std::vector<Proof> all{
        {"RefractedTransmission",
         "refractedTransmission",
         "finite, not negative",
         {inputs({unitInput("v", Hemisphere::Upper),
                  unitInput("-l", Hemisphere::Upper),
                  {alphaInput("alpha.x"), alphaInput("alpha.y"), etaInput()}}),
          {{"light", 0.0, kAny}, {"cosine", 0.0, kOne}}}},
        {"MultiScatterOf",
         "multiScatterOf, meanFresnel",
         "a share",
         {inputs({reflectances, {meanLoss}}), {{"share", 0.0, kOne}}},
         kManyBoxes},
        {"PassedAgain",
         "passedAgain",
         "a share; 1 with multiScatterOf()",
         {inputs({reflectances, {meanLoss}}), {{"share", 0.0, kAny}, {"sum", 1.0 - 1e-5, 1.0 + 1e-5}}}},
        {"FacetChances",
         "facetChances",
         "chances, together at most 1",
         {inputs({reflectances, {shareInput("transmitted"), cosineInput("cosine"), etaInput()}}),
          {{"reflects", 0.0, kOne}, {"passes", 0.0, kOne}, {"sum", 0.0, kOne}}},
         kManyBoxes},
        {"SpecularShares",
         "specularAlbedo, specularPassed",
         "shares, together 1",
         {inputs({reflectances, {shareInput("loss"), shareInput("bias over E"), meanLoss}}),
          sharesOfOne(-1e-6)}},
    };
    const ClaimedSurface surfaces[] = {
        {"Base", "", true, {}},
        {"Coated", "clearcoat", false, {}},
        {"Sheen", "sheen", false, {}},
        {"Thin", "transmission", true, {}},
        {"Translucent", "diffuse transmission", false, {}},
        {"Volume", "volume", true, {etaInput()}},
        {"Anisotropic", "anisotropy", false, {alphaInput("alpha.y / alpha.x")}},
    };
    for (const ClaimedSurface& surface : surfaces) {
        const std::vector<Proof> proofs = surfaceProofs(surface);
        all.insert(all.end(), proofs.begin(), proofs.end());
    }
    return all;
}

}  // namespace

std::vector<Proof> bsdfProofs() {
    std::vector<Proof> all;
    for (const std::vector<Proof>& group :
         {exactProofs(), fresnelProofs(), ggxProofs(), albedoProofs(), layerProofs(), energyProofs()}) {
        all.insert(all.end(), group.begin(), group.end());
    }
    return all;
}

}  // namespace glint::numerics
