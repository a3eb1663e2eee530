// Domains and ranges of the claims in proofs_hit.glsl.
#include "proof_inputs.h"

namespace glint::numerics {
namespace {

verify::InputRange counterInput(std::string name) {
    return {std::move(name), 0.0, 4294967040.0, verify::Scale::Linear};
}

std::vector<verify::OutputRange> unitVector(const std::string& name) {
    return {{name + ".x", -kOne, kOne},
            {name + ".y", -kOne, kOne},
            {name + ".z", -kOne, kOne},
            {"squared length", 1.0 - 1e-5, kOne}};
}

std::vector<verify::OutputRange> vectorOf(const std::string& name, double size) {
    return {{name + ".x", -size, size}, {name + ".y", -size, size}, {name + ".z", -size, size}};
}

std::vector<verify::OutputRange> both(std::vector<verify::OutputRange> a,
                                      const std::vector<verify::OutputRange>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

}  // namespace

std::vector<Proof> hitProofs() {
    constexpr auto kWhole = Hemisphere::Whole;
    const verify::InputRange entry = rangeInput("row", -1000.0, 1000.0);
    const verify::InputRange place = rangeInput("position", -1e6, 1e6);
    return {
        {"OctahedralEncode",
         "octahedralEncode",
         "in the square [-1, 1]²",
         {unitInput("v", kWhole), {{"x", -kOne, kOne}, {"y", -kOne, kOne}}}},
        {"OctahedralDecode",
         "octahedralDecode",
         "a unit vector",
         {{rangeInput("x", -1.0, 1.0), rangeInput("y", -1.0, 1.0)}, unitVector("v")}},
        {"TransformPoint",
         "transformPoint",
         "at most the sum of its terms",
         {{entry, entry, entry, place, place, place, place}, {{"x", -3.1e9, 3.1e9}}}},
        {"TransformNormal",
         "transformNormal",
         "at most the length of the row",
         {inputs({{entry, entry, entry}, unitInput("n", kWhole)}), {{"x", -1733.0, 1733.0}}}},
        {"DirectionOr",
         "directionOr",
         "a unit vector, for lengths from 1e-37 to 1e37",
         {inputs({unitInput("v", kWhole), {{"length", 1e-37F, 1e37F, verify::Scale::Logarithmic}}}),
          unitVector("v")},
         kManyBoxes},
        {"OnSide",
         "onSide",
         "components of a unit vector",
         {inputs({unitInput("direction", kWhole), unitInput("side", kWhole)}), vectorOf("v", kOne)}},
        {"ConeAxes",
         "coneAxes",
         "finite, at most 400 times the width",
         {inputs({unitInput("direction", kWhole),
                  {rangeInput("n.z", -1.0, 1.0), rangeInput("azimuth of n", -3.1415927F, 3.1415927F),
                   rangeInput("width", 0.0, 1.0)}}),
          both(vectorOf("across", 4.0), vectorOf("along", 400.0))},
         kManyBoxes},
        {"SampleLight",
         "sampleLight (spot)",
         "finite, not negative",
         {inputs({unitInput("axis", kWhole),
                  {{"range", 1e-18F, 1e6, verify::Scale::Logarithmic},
                   {"intensity", 0.0, 1e9, verify::Scale::Logarithmic},
                   rangeInput("spotScale", 0.0, 1000.0),
                   rangeInput("spotOffset", -1000.0, 1000.0)},
                  unitInput("direction", kWhole),
                  {{"distance", 0.0, 1e6, verify::Scale::Logarithmic}}}),
          both({{"distance", 0.0, 1.8e6}, {"irradiance", 0.0, kAny}}, vectorOf("direction", 1.8))}},
        {"SampleLightArea",
         "sampleLightArea",
         "a unit vector",
         {{rangeInput("sine", 0.0, 1.0), randomInput("u.x"), randomInput("u.y")}, unitVector("l")}},
        {"RandomUnit",
         "randomUnit",
         "in [0, 1)",
         {{counterInput("pixel"), counterInput("sample"), counterInput("seed"), counterInput("dimension")},
          {{"u", 0.0, 0.99999994F}}}},
        {"SequencePair",
         "sequencePair",
         "in [0, 1)²",
         {{counterInput("pixel"), counterInput("sample"), counterInput("seed"), counterInput("pair")},
          {{"u.x", 0.0, 0.99999994F}, {"u.y", 0.0, 0.99999994F}}}},
        {"IncludeSample",
         "includeSample",
         "finite",
         {{rangeInput("mean", 0.0, 1e6),
           rangeInput("residual", -1.0, 1.0),
           rangeInput("value", 0.0, 1e6),
           {"count", 0.0, 1e6, verify::Scale::Logarithmic}},
          {{"mean", -4e6, 4e6}, {"residual", -4e6, 4e6}}}},
        {"DirectionBin",
         "directionBin",
         "below kMaxDirectionBins",
         {unitInput("v", kWhole), {{"octahedral", 0.0, 63.0}, {"sign", 0.0, 7.0}}}},
        {"ValueNoise",
         "valueNoise",
         "in [0, 1], but for rounding",
         {{rangeInput("x", -1e6, 1e6), rangeInput("y", -1e6, 1e6), rangeInput("z", -1e6, 1e6)},
          {{"noise", -1e-4, 1.0 + 1e-4}}}},
        {"LeavesAt",
         "leavesAt",
         "not negative, at most `far`",
         {{rangeInput("value", -1e4, 1e4), rangeInput("slope", -2.0, -1e-30F), rangeInput("far", 1.0, 1e30)},
          {{"distance", 0.0, 1e30F}}}},
    };
}

}  // namespace glint::numerics
