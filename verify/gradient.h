// Encloses the partial derivatives of a value by the inputs over a box. Where one has a constant sign, the
// value's bounds lie at an end of that input.
//
// Floats are no smooth functions, but each operation is a smooth one times 1 + rho, where |rho| is at most
// the rounding error. The derivatives are enclosed for all rho. So the greatest value over the box, for any
// rounding, is at most the greatest value at the end, for any rounding there. Intervals enclose that value.
#pragma once

#include "verify/evaluate.h"
#include "verify/program.h"

#include <span>
#include <vector>

namespace glint::verify {

class GradientEvaluator {
public:
    explicit GradientEvaluator(const Program& program) : program_(program), adjoints_(program.nodes.size()) {}

    // Sets derivative(k) for each input over the box that `values` has evaluated. Returns false if the node
    // jumps in the box, as far as is known: an undecided choice, a rounding to integers.
    bool run(const BoxEvaluator& values, NodeId of, std::size_t inputs);
    const Interval& derivative(std::size_t input) const {
        return derivatives_[input];
    }

private:
    bool spread(const BoxEvaluator& values, NodeId id);
    void spreadExtremum(const Node& node, const Interval& a, const Interval& b, const Interval& adjoint);
    bool spreadPower(const Node& node, const Interval& a, const Interval& b, const Interval& z,
                     const Interval& adjoint);
    bool spreadChoice(const BoxEvaluator& values, const Node& node, const Interval& adjoint);
    // Returns the operand of a choice that counts for all inputs of the box, or kNoNode.
    NodeId onlyChoice(const BoxEvaluator& values, const Node& node) const;
    void give(NodeId to, const Interval& adjoint, const Interval& factor);

    const Program& program_;
    std::vector<Interval> adjoints_;
    std::vector<Interval> derivatives_;
};

}  // namespace glint::verify
