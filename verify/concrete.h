// Evaluates a program at one point, as C++ in single precision does.
#pragma once

#include "verify/program.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace glint::verify {

inline double signOf(double a) {
    return a > 0.0 ? 1.0 : a < 0.0 ? -1.0 : 0.0;
}

// The value of an operation for values of its operands: floats of the node's format, integers and truth
// values.
double evaluateNode(const Node& node, double a, double b, double c);

struct PointResult {
    std::vector<double> outputs;
    // The first operation whose result is infinite or not a number although its operands are numbers.
    std::optional<NodeId> failed;
};

class PointEvaluator {
public:
    explicit PointEvaluator(const Program& program) : program_(program), values_(program.nodes.size()) {}
    PointResult run(std::span<const double> inputs);
    double value(NodeId node) const {
        return values_[node];
    }

private:
    const Program& program_;
    std::vector<double> values_;
};

}  // namespace glint::verify
