// Evaluates a program for all inputs of a box: by intervals, and by affine forms where they are requested.
#pragma once

#include "verify/affine.h"
#include "verify/identities.h"
#include "verify/program.h"

#include <span>
#include <utility>
#include <vector>

namespace glint::verify {

// An operation that fails for some inputs of the box, as far as the intervals know.
struct Finding {
    NodeId node = kNoNode;
    Hazard hazard = Hazard::None;
};

// "division by zero".
const char* nameOf(Hazard hazard);

class BoxEvaluator {
public:
    explicit BoxEvaluator(const Program& program);

    // `box` has an interval for each input of the program.
    void run(std::span<const Interval> box, bool withAffineForms);

    // Adds known bounds of a node for the boxes to come, until forget().
    void know(NodeId node, const Interval& range);
    void forget() {
        known_.clear();
    }

    const Interval& value(NodeId node) const {
        return values_[node];
    }
    const std::vector<Finding>& findings() const {
        return findings_;
    }
    // Returns by how much the node changes over the box with one input alone, as far as forms are known; 0
    // otherwise.
    double change(NodeId node, std::size_t input) const;

private:
    void evaluate(NodeId id);
    void evaluateForm(NodeId id);
    Interval valueOf(const Node& node, Hazard& hazard);
    Interval inputOf(const Node& node) const;
    Interval bounded(const Node& node);
    Interval choice(const Node& node, Hazard& hazard);
    Interval share(const Node& node);
    Interval unitQuotient(const Node& node);
    void forgiveOverflow(NodeId id);
    Interval difference(const Node& node, const Interval& plain) const;
    Interval compared(const Node& node);
    Interval merged(const Node& node) const;
    Interval refined(const Node& node) const;
    Interval integer(const Node& node, Hazard& hazard) const;
    Interval selected(const Node& node) const;
    bool formOf(const Node& node, Affine& result);
    void formOfInput(const Node& node, Affine& result);
    void formOfMix(const Node& node, Affine& result);
    void formOfNormalized(const Node& node, Affine& result);
    void formOfBound(const Node& node, Affine& result);
    void formOfFunction(const Node& node, Affine& result);
    void formOfMerge(const Node& node, Affine& result);
    void formOfPower(const Node& node, Affine& result);
    void joinForm(const Affine& other, bool isFirst, Affine& result);

    const Interval& of(NodeId id) const {
        return values_[id];
    }

    const Program& program_;
    Identities identities_;
    std::vector<Interval> values_;
    std::vector<Affine> forms_;
    std::vector<double> slopes_;
    std::vector<double> scratch_[3];
    std::vector<std::size_t> symbols_;  // the inputs with a slope of their own
    std::span<const Interval> box_;
    std::vector<Finding> findings_;
    std::vector<std::pair<NodeId, Interval>> known_;
    bool withForms_ = false;
};

}  // namespace glint::verify
