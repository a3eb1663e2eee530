#include "prove/prover.h"

#include "prove/concrete.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <queue>
#include <random>
#include <utility>

namespace glint::prove {
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

// Where a side is cut: a float inside of it.
std::optional<double> cutOf(const Interval& side, Scale scale) {
    double cut = 0.5 * (side.low + side.high);
    if (scale == Scale::Logarithmic && side.high > 0.0) {
        cut = side.low > 0.0 ? std::sqrt(side.low) * std::sqrt(side.high) : side.high * 0x1p-8;
    }
    cut = toSingle(cut);
    const bool isInside = side.low < cut && cut < side.high;
    return isInside && scale != Scale::Whole ? std::optional(cut) : std::nullopt;
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
    Search(const Program& program, const Claim& claim, const ProofOptions& options)
        : program_(program), claim_(claim), options_(options), boxes_(program), random_(options.seed) {}

    ProofResult run();

private:
    bool tryPoint(const std::vector<double>& point);
    bool samplePoints();
    double pointIn(const Interval& side, Scale scale);
    // Returns whether the claim is proved for the box, or the box is not in the domain.
    bool isProved(Box& box, bool withForms);
    bool isOutside() const;
    std::string failureOf(NodeId& blamed) const;
    std::string describeFinding(const Finding& finding) const;
    std::optional<std::size_t> sideToCut(const Box& box) const;
    void cut(const Box& box, std::size_t side);

    const Program& program_;
    const Claim& claim_;
    const ProofOptions& options_;
    BoxEvaluator boxes_;
    std::mt19937_64 random_;
    std::priority_queue<Box> open_;
    ProofResult result_;
    NodeId blamed_ = kNoNode;
    std::uint64_t made_ = 0;
};

double Search::pointIn(const Interval& side, Scale scale) {
    const double share = static_cast<double>(random_() >> 11U) * 0x1p-53;
    // The ends are where functions fail.
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

// Returns what the bounds can't exclude, and the node that is to blame; empty if nothing.
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

bool Search::isProved(Box& box, bool withForms) {
    boxes_.run(box.sides, withForms);
    blamed_ = kNoNode;
    box.why = isOutside() ? std::string() : failureOf(blamed_);
    return box.why.empty();
}

std::optional<std::size_t> Search::sideToCut(const Box& box) const {
    double changes = 0.0;
    double sizes = 0.0;
    for (std::size_t k = 0; k < box.sides.size(); ++k) {
        changes += blamed_ == kNoNode ? 0.0 : boxes_.change(blamed_, k);
        sizes += sizeOf(box.sides[k], claim_.inputs[k]);
    }
    std::optional<std::size_t> best;
    double bestScore = -1.0;
    for (std::size_t k = 0; k < box.sides.size(); ++k) {
        if (!cutOf(box.sides[k], claim_.inputs[k].scale)) {
            continue;
        }
        // What matters for the bound, and now and then what is large: the bound may depend on it nonlinearly.
        const double matters =
            changes > 0.0 && blamed_ != kNoNode ? boxes_.change(blamed_, k) / changes : 0.0;
        const double isLarge = sizes > 0.0 ? sizeOf(box.sides[k], claim_.inputs[k]) / sizes : 0.0;
        const double score = matters + 0.5 * isLarge;
        if (score > bestScore) {
            bestScore = score;
            best = k;
        }
    }
    return best;
}

void Search::cut(const Box& box, std::size_t side) {
    const double place = *cutOf(box.sides[side], claim_.inputs[side].scale);
    for (const bool upper : {false, true}) {
        Box half = box;
        (upper ? half.sides[side].low : half.sides[side].high) = place;
        half.share *= 0.5;
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
        // Forms cost ten times as much as intervals, and decide more.
        if (isProved(box, false) || isProved(box, true)) {
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
    return Search(program, claim, options).run();
}

}  // namespace glint::prove
