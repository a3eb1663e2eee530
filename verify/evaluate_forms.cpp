// The affine form of each operation.
#include "verify/evaluate.h"

#include <algorithm>
#include <cmath>

namespace glint::verify {

void BoxEvaluator::evaluateForm(NodeId id) {
    const Node& node = program_.nodes[id];
    Affine& form = forms_[id];
    if (formOf(node, form) && form.isValid) {
        const Interval range = form.range();
        values_[id] =
            meet(values_[id], {roundDown(range.low, node.format), roundUp(range.high, node.format)});
    }
    if (values_[id].isEmpty()) {
        form.isValid = false;
        return;
    }
    // A form that is wider than the interval only makes later operations worse.
    if (!form.isValid || form.error > 0.5 * values_[id].width()) {
        form.set(values_[id]);
    }
}

void BoxEvaluator::joinForm(const Affine& other, bool isFirst, Affine& result) {
    if (isFirst) {
        copyAffine(other, result);
        return;
    }
    if (!result.isValid || !other.isValid) {
        result.isValid = false;
        return;
    }
    // The mean of both, and half of the distance between them.
    double between = std::abs(result.center - other.center);
    for (std::size_t d = 0; d < result.slopes.size(); ++d) {
        between += std::abs(result.slopes[d] - other.slopes[d]);
        result.slopes[d] = 0.5 * (result.slopes[d] + other.slopes[d]);
    }
    result.center = 0.5 * (result.center + other.center);
    result.error = (std::max(result.error, other.error) + 0.5 * between) * (1.0 + 0x1p-46);
}

void BoxEvaluator::formOfMerge(const Node& node, Affine& result) {
    bool isFirst = true;
    const auto join = [&](NodeId id) {
        if (!of(id).isEmpty()) {
            joinForm(forms_[id], isFirst, result);
            isFirst = false;
        }
    };
    if (node.op == Op::Select) {
        if (!of(node.a).isFalse()) {
            join(node.b);
        }
        if (!of(node.a).isTrue()) {
            join(node.c);
        }
        return;
    }
    for (std::uint32_t k = 0; k < node.count; ++k) {
        const Edge& edge = program_.edges[node.first + k];
        const Interval guard = edge.guard == kNoNode ? kTrue : of(edge.guard);
        if (!guard.isFalse() && !guard.isEmpty()) {
            join(edge.value);
        }
    }
}

void BoxEvaluator::formOfFunction(const Node& node, Affine& result) {
    const Affine& a = forms_[node.a];
    const Interval& x = of(node.a);
    const bool isSine = node.function == Function::Sin;
    if (!isSine && node.function != Function::Cos) {
        applyAffine(node.function, a, x, result);
        return;
    }
    if (!a.isValid || x.width() > 2.0 || x.magnitude() > 1e6) {
        return;
    }
    // Taylor's theorem about the centre: the second derivative is at most 1.
    const double middle = 0.5 * (x.low + x.high);
    const double half = 0.5 * x.width() * (1.0 + 0x1p-50);
    const double value = isSine ? std::sin(middle) : std::cos(middle);
    const double slope = isSine ? std::cos(middle) : -std::sin(middle);
    scaleAffine(a, slope, result);
    result.center += value - slope * middle;
    result.error += 0.5 * half * half + 0x1p-45 * (1.0 + x.magnitude());
}

void BoxEvaluator::formOfPower(const Node& node, Affine& result) {
    const Interval& x = of(node.a);
    const Interval& y = of(node.b);
    if (y.isPoint()) {
        powerAffine(forms_[node.a], x, y.low, result);
        return;
    }
    if (x.low <= 0.0 || !forms_[node.b].isValid) {
        return;
    }
    Affine log;
    log.slopes = scratch_[0];
    applyAffine(Function::Log, forms_[node.a], x, log);
    Affine exponent;
    exponent.slopes = scratch_[1];
    if (!log.isValid) {
        return;
    }
    multiplyAffine(log, forms_[node.b], exponent);
    if (exponent.isValid) {
        applyAffine(Function::Exp, exponent, exponent.range(), result);
    }
}

void BoxEvaluator::formOfInput(const Node& node, Affine& result) {
    const auto found = std::find(symbols_.begin(), symbols_.end(), static_cast<std::size_t>(node.value));
    result.set(inputOf(node));
    if (found != symbols_.end()) {
        result.slopes[static_cast<std::size_t>(found - symbols_.begin())] = result.error;
        result.error = 0.0;
    }
}

// a + c (b - a), with some more roundings.
void BoxEvaluator::formOfMix(const Node& node, Affine& result) {
    Affine difference;
    difference.slopes = scratch_[0];
    addAffine(forms_[node.b], forms_[node.a], -1.0, difference);
    Affine product;
    product.slopes = scratch_[1];
    multiplyAffine(difference, forms_[node.c], product);
    addAffine(forms_[node.a], product, 1.0, result);
    if (result.isValid) {
        result.error += 0x1p-21 * (node.format == Format::Half ? 0x1p13 : 1.0) *
                        (of(node.a).magnitude() + of(node.b).magnitude()) * (1.0 + of(node.c).magnitude());
    }
}

void BoxEvaluator::formOfNormalized(const Node& node, Affine& result) {
    Affine scale;
    scale.slopes = scratch_[0];
    applyAffine(Function::InverseSqrt, forms_[node.c], of(node.c), scale);
    if (scale.isValid) {
        multiplyAffine(forms_[node.a], scale, result);
    }
}

void BoxEvaluator::formOfBound(const Node& node, Affine& result) {
    if (isRoundedSquare(node)) {
        squareAffine(forms_[node.a], result);
        roundAffine(result, node.format, node.op == Op::SphereSum ? 20.0 : 16.0);
    } else if (node.op == Op::SquareOfRoot) {
        copyAffine(forms_[node.a], result);
        roundAffine(result, node.format, 4.0);
    } else {
        copyAffine(forms_[node.op == Op::CircleSum ? node.c : node.a], result);
    }
}

// Returns whether there is a rule for the operation.
bool BoxEvaluator::formOf(const Node& node, Affine& result) {
    const auto form = [this](NodeId id) -> const Affine& { return forms_[id]; };
    result.isValid = false;
    double furtherUnits = 0.0;
    switch (node.op) {
        case Op::Input:
            formOfInput(node, result);
            return true;
        case Op::Add:
        case Op::Subtract:
            addAffine(form(node.a), form(node.b), node.op == Op::Add ? 1.0 : -1.0, result);
            break;
        case Op::Multiply:
            multiplyAffine(form(node.a), form(node.b), result);
            break;
        case Op::Square:
            squareAffine(form(node.a), result);
            break;
        case Op::Divide:
            divideAffine(form(node.a), form(node.b), of(node.b), scratch_[0], result);
            break;
        case Op::Negate:
            scaleAffine(form(node.a), -1.0, result);
            return true;
        case Op::Absolute: {
            Affine opposite;
            opposite.slopes = scratch_[1];
            scaleAffine(form(node.a), -1.0, opposite);
            maximumAffine(form(node.a), opposite, 1.0, scratch_[0], result);
            return true;
        }
        case Op::Minimum:
        case Op::Maximum:
            maximumAffine(form(node.a), form(node.b), node.op == Op::Maximum ? 1.0 : -1.0, scratch_[0],
                          result);
            return true;
        case Op::Mix:
            formOfMix(node, result);
            break;
        case Op::Normalized:
            formOfNormalized(node, result);
            furtherUnits = 3.0;
            break;
        case Op::Apply:
            formOfFunction(node, result);
            furtherUnits = node.function == Function::Sqrt ? 0.0 : 2.0;
            break;
        case Op::Power:
            formOfPower(node, result);
            furtherUnits = 2.0;
            break;
        case Op::Refine:
            copyAffine(form(node.a), result);
            return true;
        case Op::Select:
        case Op::Merge:
            formOfMerge(node, result);
            return true;
        case Op::Convert:
        case Op::SplitHigh:
            copyAffine(form(node.a), result);
            if (node.op == Op::SplitHigh && result.isValid) {
                result.error += of(node.a).magnitude() * 0x1p-12;
            }
            break;
        default:
            if (isBound(node.op)) {
                formOfBound(node, result);
            }
            return isBound(node.op);
    }
    roundAffine(result, node.format, furtherUnits);
    return true;
}

}  // namespace glint::verify
