// glint_proofs: proves the claims about the shaders' functions and prints how far it came.
#include "proofs.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
    CLI::App app("Proves claims about the functions of the shaders on intervals");
    std::string only;
    std::uint64_t boxes = 0;
    app.add_option("--only", only, "the claims whose name contains this");
    app.add_option("--boxes", boxes, "the most boxes for each claim (default: as the table says)");
    CLI11_PARSE(app, argc, argv);
    std::vector<glint::numerics::Proof> proofs;
    for (const glint::numerics::Proof& proof : glint::numerics::allProofs()) {
        if (proof.name.find(only) != std::string_view::npos) {
            proofs.push_back(proof);
        }
    }
    const auto programs = glint::numerics::compileProofs(proofs);
    if (!programs) {
        std::fprintf(stderr, "%s\n", glint::toString(programs.error()).c_str());
        return 1;
    }
    for (std::size_t k = 0; k < proofs.size(); ++k) {
        glint::prove::ProofOptions options;
        options.mostBoxes = boxes > 0 ? boxes : proofs[k].boxes;
        const auto start = std::chrono::steady_clock::now();
        const glint::prove::ProofResult result =
            glint::prove::prove((*programs)[k], proofs[k].claim, options);
        const double seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        fmt::print("{:28} {:9} {:8.2e} {:7} boxes {:6} nodes {:6.2f} s\n", proofs[k].name,
                   nameOf(result.state), result.undecidedShare, result.boxes, (*programs)[k].nodes.size(),
                   seconds);
        if (std::getenv("TRACE") != nullptr && !result.undecidedBox.empty()) {
            glint::prove::BoxEvaluator e((*programs)[k]);
            e.run(result.undecidedBox, true);
            for (unsigned id = 0; id < (*programs)[k].nodes.size(); ++id) {
                if ((*programs)[k].nodes[id].op != glint::prove::Op::Constant) {
                    fmt::print("  {} {} [{:.6g}, {:.6g}]\n", id,
                               glint::prove::describe((*programs)[k], id, 2), e.value(id).low,
                               e.value(id).high);
                }
            }
        }
        if (result.counterexample) {
            fmt::print("    {}", result.counterexample->what);
            for (const double input : result.counterexample->inputs) {
                fmt::print(" {:.9g}", input);
            }
            fmt::print("\n");
        } else if (!result.undecidedWhy.empty()) {
            fmt::print("    {}", result.undecidedWhy);
            for (const auto& side : result.undecidedBox) {
                fmt::print(" [{:.7g}, {:.7g}]", side.low, side.high);
            }
            fmt::print("\n");
        }
        std::fflush(stdout);
    }
    return 0;
}
