#include "probe_kernel.h"

#include "evaluate.h"

#include <fmt/format.h>

namespace glint::numerics {
namespace {

// Returns the text between the #version line and the rest: what the scene decides, and the meaning of PROBE
// on the device.
std::string prelude(ProbePrecision precision) {
    const std::string relaxed = precision == ProbePrecision::Mixed
                                    ? "precision highp float;\nprecision highp int;\n"
                                      "#define GLINT_PRECISION 16\n#define GLINT_RELAXED mediump\n"
                                    : "";
    return relaxed + fmt::format(
                         "#define GLINT_ENERGY_COMPENSATION 1\n"
                         "#define PROBE(name) void probe##name(float i[{}], inout float o[{}])\n",
                         kMaxInputs, kMaxOutputs);
}

// Returns the entry with everything after the directives that must come first.
std::string withText(std::string entry, ProbePrecision precision) {
    std::string text(probeText());
    const std::size_t firstLine = text.find("#line");
    text.insert(firstLine == std::string::npos ? 0 : firstLine, prelude(precision));
    return text + std::move(entry);
}

std::string declarations() {
    return fmt::format(R"(
layout(local_size_x = {}) in;
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Floats {{ float data[]; }};
layout(push_constant, scalar) uniform Block {{
    Floats inputs;
    Floats outputs;
    Floats ones;
    uint count;
    uint repeats;
}} block;
)",
                       kProbeGroup);
}

std::string readInputs(int inputs, std::string_view array) {
    std::string text;
    for (int k = 0; k < inputs; ++k) {
        text += fmt::format("    {}[{}] = block.inputs.data[element * {}u + {}u];\n", array, k, inputs, k);
    }
    return text;
}

}  // namespace

std::string_view probeText() {
    static constexpr std::string_view kText =
#include "probes_text.inc"
        ;
    return kText;
}

// Arrays are indexed by constants only, so that the optimiser can split them.
std::string probeKernel(std::string_view probe, int inputs, int outputs, ProbePrecision precision) {
    std::string text = declarations();
    text += fmt::format(
        "void main() {{\n"
        "    uint element = gl_GlobalInvocationID.x;\n"
        "    if (element >= block.count) {{\n        return;\n    }}\n"
        "    float i[{}];\n    float o[{}];\n",
        kMaxInputs, kMaxOutputs);
    text += readInputs(inputs, "i");
    for (int k = 0; k < outputs; ++k) {
        text += fmt::format("    o[{}] = 0.0;\n", k);
    }
    text += fmt::format("    probe{}(i, o);\n", probe);
    for (int k = 0; k < outputs; ++k) {
        text += fmt::format("    block.outputs.data[element * {}u + {}u] = o[{}];\n", outputs, k, k);
    }
    return withText(text + "}\n", precision);
}

std::string timedKernel(std::string_view probe, int inputs, int outputs, ProbePrecision precision) {
    std::string text = declarations();
    text += fmt::format(
        "void main() {{\n"
        "    uint element = gl_GlobalInvocationID.x % block.count;\n"
        "    float given[{0}];\n    float i[{0}];\n    float o[{1}];\n    float sum = 0.0;\n",
        kMaxInputs, kMaxOutputs);
    text += readInputs(inputs, "given");
    text +=
        "    for (uint repeat = 0u; repeat < block.repeats; ++repeat) {\n"
        "        float one = block.ones.data[repeat & 15u];\n";
    for (int k = 0; k < inputs; ++k) {
        text += fmt::format("        i[{0}] = given[{0}] * one;\n", k);
    }
    for (int k = 0; k < kMaxOutputs && !probe.empty(); ++k) {
        text += fmt::format("        o[{}] = 0.0;\n", k);
    }
    if (probe.empty()) {
        for (int k = 0; k < inputs; ++k) {
            text += fmt::format("        sum += i[{}];\n", k);
        }
    } else {
        text += fmt::format("        probe{}(i, o);\n", probe);
        for (int k = 0; k < outputs; ++k) {
            text += fmt::format("        sum += o[{}];\n", k);
        }
    }
    text +=
        "    }\n"
        "    block.outputs.data[gl_GlobalInvocationID.x] = sum;\n"
        "}\n";
    return withText(text, precision);
}

}  // namespace glint::numerics
