#include "verify/prover.h"

#include "verify/concrete.h"
#include "verify/gradient.h"
#include "verify/specialise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <random>
#include <utility>

namespace glint::verify {
namespace {

struct Box {
    std::vector<Interval> sides;
    double share = 1.0;
    std::uint64_t number = 0;  // boxes with equal shares come in the order in which they were made
    std::string why;

    bool operator<(const Box& other) const {
        return share != other.share ? share < other.share : number > other.number;
    }
};

double toSingle(double value) {
    return static_cast<double>(static_cast<float>(value));
}

// Returns the place where a side is cut: the greatest float of the lower half. The upper half begins with the
// next float.
std::optional<double> cutOf(const Interval& side, Scale scale) {
    if (scale == Scale::Whole || side.isPoint()) {
        return std::nullopt;
    }
    // Functions often decide at 0, which then gets a box of its own.
    constexpr double kLeast = std::numeric_limits<float>::denorm_min();
    const bool isLogarithmic = scale == Scale::Logarithmic;
    if (side.low == 0.0 && (isLogarithmic || side.high < 1e-3)) {
        return 0.0;
    }
    if (side.high == 0.0 && side.low > -1e-3) {
        return -kLeast;
    }
    const double middle = isLogarithmic && side.low > 0.0 ? std::sqrt(side.low) * std::sqrt(side.high)
                                                          : 0.5 * side.low + 0.5 * side.high;
    const double cut = toSingle(middle);
    // The nearest float may be the upper end.
    return cut < side.high ? std::max(cut, side.low) : side.low;
}

double nextSingle(double value) {
    return -static_cast<double>(nextFloatBelow(static_cast<float>(-value)));
}

double sizeOf(const Interval& side, const InputRange& range) {
    switch (range.scale) {
        case Scale::Linear:
            return range.high > range.low ? side.width() / (range.high - range.low) : 0.0;
        case Scale::Logarithmic: {
            constexpr double kLeast = 1e-30;
            const double whole = std::log(std::max(range.high, kLeast) / std::max(range.low, kLeast));
            return whole > 0.0 ? std::log(std::max(side.high, kLeast) / std::max(side.low, kLeast)) / whole
                               : 0.0;
        }
        case Scale::Whole:
            break;
    }
    return 0.0;
}

class Search {
public:
    Search(Program program, const Claim& claim, const ProofOptions& options)
        : program_(std::move(program)),
          claim_(claim),
          options_(options),
          boxes_(program_),
          gradient_(program_),
          random_(options.seed) {}

    ProofResult run();

private:
    bool tryPoint(const std::vector<double>& point);
    bool samplePoints();
    double pointIn(const Interval& side, Scale scale);
    // Returns whether the claim is proved for the box, or the box is not in the domain.
    bool isProved(Box& box);
    bool holds(Box& box, bool withForms);
    bool learnFromGradient(const Box& box);
    bool isOutside() const;
    std::string failureOf(NodeId& blamed) const;
    std::string describeFinding(const Finding& finding) const;
    std::vector<bool> inputsOf(NodeId target) const;
    std::optional<std::size_t> sideToCut(const Box& box);
    void cut(const Box& box, std::size_t side);

    const Program program_;
    const Claim& claim_;
    const ProofOptions& options_;
    BoxEvaluator boxes_;
    GradientEvaluator gradient_;
    std::mt19937_64 random_;
    std::priority_queue<Box> open_;
    ProofResult result_;
    NodeId blamed_ = kNoNode;
    std::uint64_t made_ = 0;
};

double Search::pointIn(const Interval& side, Scale scale) {
    const double share = static_cast<double>(random_() >> 11U) * 0x1p-53;
    // Functions fail at the ends.
    if (share < 0.1) {
        return side.low;
    }
    if (share > 0.9) {
        return side.high;
    }
    const double place = (share - 0.1) / 0.8;
    double value = side.low + place * side.width();
    if (scale == Scale::Logarithmic && side.high > 0.0) {
        const double low = std::max(side.low, std::min(1e-30, side.high));
        value = low * std::exp(place * std::log(side.high / low));
    }
    return std::clamp(toSingle(value), side.low, side.high);
}

bool Search::tryPoint(const std::vector<double>& point) {
    if (const std::optional<std::string> what = refute(program_, claim_, point)) {
        result_.state = ProofState::Refuted;
        result_.counterexample = Counterexample{point, *what};
        return true;
    }
    return false;
}

bool Search::samplePoints() {
    std::vector<double> point(claim_.inputs.size());
    for (std::uint64_t sample = 0; sample < options_.samples; ++sample) {
        for (std::size_t k = 0; k < point.size(); ++k) {
            const InputRange& range = claim_.inputs[k];
            point[k] = pointIn({range.low, range.high}, range.scale);
        }
        if (tryPoint(point)) {
            return true;
        }
    }
    return false;
}

bool Search::isOutside() const {
    return claim_.hasCondition && boxes_.value(program_.outputs[claim_.outputs.size()]).high <= 0.0;
}

std::string Search::describeFinding(const Finding& finding) const {
    const Node& node = program_.nodes[finding.node];
    std::string text = fmt::format("{} in {}", nameOf(finding.hazard), describe(program_, finding.node));
    for (const NodeId operand : {node.a, node.b, node.c}) {
        if (operand != kNoNode) {
            const Interval& value = boxes_.value(operand);
            text += fmt::format("{} [{:.6g}, {:.6g}]", operand == node.a ? ":" : ",", value.low, value.high);
        }
    }
    return text;
}

// Returns the failures that the bounds can't exclude, and the node that causes them; empty if there are none.
std::string Search::failureOf(NodeId& blamed) const {
    if (!boxes_.findings().empty()) {
        const Finding& finding = boxes_.findings().front();
        const Node& node = program_.nodes[finding.node];
        blamed = node.op == Op::Divide ? node.b : node.op == Op::Normalized ? node.c : node.a;
        return describeFinding(finding);
    }
    for (std::size_t k = 0; k < claim_.outputs.size(); ++k) {
        const OutputRange& range = claim_.outputs[k];
        const Interval& value = boxes_.value(program_.outputs[k]);
        if (!value.isEmpty() && !value.isWithin({range.low, range.high})) {
            blamed = program_.outputs[k];
            return fmt::format("{} in [{:.6g}, {:.6g}]", range.name, value.low, value.high);
        }
    }
    return {};
}

bool Search::holds(Box& box, bool withForms) {
    boxes_.run(box.sides, withForms);
    blamed_ = kNoNode;
    box.why = isOutside() ? std::string() : failureOf(blamed_);
    return box.why.empty();
}

// Narrows the bounds of the blamed node, by the ends of the inputs in which it is monotone. Returns whether
// that gave anything.
bool Search::learnFromGradient(const Box& box) {
    const NodeId target = blamed_;
    if (target == kNoNode || !gradient_.run(boxes_, target, box.sides.size())) {
        return false;
    }
    std::vector<Interval> least = box.sides;
    std::vector<Interval> greatest = box.sides;
    bool isMonotone = false;
    for (std::size_t k = 0; k < box.sides.size(); ++k) {
        const Interval& derivative = gradient_.derivative(k);
        const bool rises = derivative.low >= 0.0;
        if (box.sides[k].isPoint() || (!rises && !(derivative.high <= 0.0))) {
            continue;
        }
        isMonotone = true;
        least[k] = Interval::of(rises ? box.sides[k].low : box.sides[k].high);
        greatest[k] = Interval::of(rises ? box.sides[k].high : box.sides[k].low);
    }
    if (!isMonotone) {
        return false;
    }
    const Interval before = boxes_.value(target);
    boxes_.run(least, true);
    const double low = boxes_.value(target).low;
    boxes_.run(greatest, true);
    const double high = boxes_.value(target).high;
    if (!(low > before.low) && !(high < before.high)) {
        return false;
    }
    boxes_.know(target, {std::max(low, before.low), std::min(high, before.high)});
    return true;
}

bool Search::isProved(Box& box) {
    // Forms cost ten times as much as intervals, and decide more.
    if (holds(box, false) || holds(box, true)) {
        return true;
    }
    constexpr int kMostLessons = 8;
    bool proved = false;
    for (int lesson = 0; lesson < kMostLessons && !proved && learnFromGradient(box); ++lesson) {
        proved = holds(box, true);
    }
    if (!proved) {
        // The side to cut is chosen by the forms over the box itself.
        proved = holds(box, true);
    }
    boxes_.forget();
    return proved;
}

// The inputs on which a node depends, with the conditions under which it is computed.
std::vector<bool> Search::inputsOf(NodeId target) const {
    std::vector<bool> inputs(claim_.inputs.size());
    std::vector<bool> isNeeded(program_.nodes.size());
    const auto need = [&](NodeId id) {
        if (id != kNoNode) {
            isNeeded[id] = true;
        }
    };
    need(target);
    for (NodeId id = target + 1; id-- > 0;) {
        if (!isNeeded[id]) {
            continue;
        }
        const Node& node = program_.nodes[id];
        if (node.op == Op::Input && static_cast<std::size_t>(node.value) < inputs.size()) {
            inputs[static_cast<std::size_t>(node.value)] = true;
        }
        for (const NodeId operand : {node.a, node.b, node.c, node.guard}) {
            need(operand);
        }
        for (std::uint32_t k = 0; k < node.count; ++k) {
            need(program_.edges[node.first + k].guard);
            need(program_.edges[node.first + k].value);
        }
    }
    return inputs;
}

// Returns the side whose halves have the narrowest bound of the blamed node, or a large side if the bounds
// are equal.
std::optional<std::size_t> Search::sideToCut(const Box& box) {
    const NodeId target = blamed_;
    const double width = target == kNoNode ? kInfinity : boxes_.value(target).width();
    const std::vector<bool> matters =
        target == kNoNode ? std::vector<bool>(box.sides.size(), true) : inputsOf(target);
    std::optional<std::size_t> best;
    double bestScore = -kInfinity;
    for (std::size_t k = 0; k < box.sides.size(); ++k) {
        const std::optional<double> cut = cutOf(box.sides[k], claim_.inputs[k].scale);
        if (!cut || !matters[k]) {
            continue;
        }
        double gain = 0.0;
        if (std::isfinite(width) && width > 0.0) {
            std::vector<Interval> half = box.sides;
            double widest = 0.0;
            for (const bool upper : {false, true}) {
                half[k] =
                    upper ? Interval{nextSingle(*cut), box.sides[k].high} : Interval{box.sides[k].low, *cut};
                boxes_.run(half, true);
                widest += boxes_.value(target).isEmpty() ? 0.0 : 0.5 * boxes_.value(target).width();
            }
            gain = std::isfinite(widest) ? 1.0 - widest / width : 0.0;
        }
        const double score = gain + 0.3 * sizeOf(box.sides[k], claim_.inputs[k]);
        if (score > bestScore) {
            bestScore = score;
            best = k;
        }
    }
    return best;
}

void Search::cut(const Box& box, std::size_t side) {
    const double place = *cutOf(box.sides[side], claim_.inputs[side].scale);
    const double shareBelow = box.sides[side].low == place && place == 0.0 ? 0.0 : 0.5;
    for (const bool upper : {false, true}) {
        Box half = box;
        (upper ? half.sides[side].low : half.sides[side].high) = upper ? nextSingle(place) : place;
        half.share *= upper ? 1.0 - shareBelow : shareBelow;
        half.number = ++made_;
        open_.push(std::move(half));
    }
}

ProofResult Search::run() {
    if (samplePoints()) {
        return result_;
    }
    Box whole;
    for (const InputRange& range : claim_.inputs) {
        whole.sides.push_back({range.low, range.high});
    }
    open_.push(std::move(whole));
    double stuck = 0.0;  // boxes that are a point and are not proved
    while (!open_.empty() && result_.boxes < options_.mostBoxes) {
        Box box = open_.top();
        open_.pop();
        ++result_.boxes;
        if (isProved(box)) {
            continue;
        }
        std::vector<double> point;
        for (std::size_t k = 0; k < box.sides.size(); ++k) {
            point.push_back(pointIn(box.sides[k], claim_.inputs[k].scale));
        }
        if (tryPoint(point)) {
            result_.undecidedShare = 1.0;
            return result_;
        }
        if (const std::optional<std::size_t> side = sideToCut(box)) {
            cut(box, *side);
            continue;
        }
        stuck += box.share;
        if (result_.undecidedBox.empty()) {
            result_.undecidedBox = box.sides;
            result_.undecidedWhy = box.why;
        }
    }
    result_.undecidedShare = stuck;
    if (!open_.empty()) {
        result_.undecidedBox = open_.top().sides;
        result_.undecidedWhy = open_.top().why;
    }
    for (; !open_.empty(); open_.pop()) {
        result_.undecidedShare += open_.top().share;
    }
    result_.state = result_.undecidedShare > 0.0 ? ProofState::Undecided : ProofState::Proved;
    return result_;
}

}  // namespace

const char* nameOf(ProofState state) {
    switch (state) {
        case ProofState::Proved:
            return "proved";
        case ProofState::Undecided:
            return "undecided";
        case ProofState::Refuted:
            return "refuted";
    }
    return "";
}

std::optional<std::string> refute(const Program& program, const Claim& claim,
                                  std::span<const double> inputs) {
    PointEvaluator evaluator(program);
    std::vector<double> all(inputs.begin(), inputs.end());
    all.resize(std::max<std::size_t>(all.size(), program.inputCount));
    const PointResult point = evaluator.run(all);
    if (claim.hasCondition && !(point.outputs[claim.outputs.size()] > 0.0)) {
        return std::nullopt;
    }
    if (point.failed) {
        return fmt::format("{} is {}", describe(program, *point.failed), evaluator.value(*point.failed));
    }
    for (std::size_t k = 0; k < claim.outputs.size(); ++k) {
        const OutputRange& range = claim.outputs[k];
        const double value = point.outputs[k];
        if (!(value >= range.low && value <= range.high)) {
            return fmt::format("{} is {:.9g}, which is not in [{:.9g}, {:.9g}]", range.name, value, range.low,
                               range.high);
        }
    }
    return std::nullopt;
}

ProofResult prove(const Program& program, const Claim& claim, const ProofOptions& options) {
    std::vector<Interval> domain;
    for (const InputRange& input : claim.inputs) {
        domain.push_back({input.low, input.high});
    }
    return Search(specialise(program, domain), claim, options).run();
}

}  // namespace glint::verify
