#include "verify/identities.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace glint::verify {
namespace {

constexpr NodeId kReciprocal = 0x80000000U;
// Longer polynomials take more time than they decide.
constexpr std::size_t kMostTerms = 100;
constexpr std::size_t kMostProducts = 600;
constexpr std::size_t kMostFactors = 14;
constexpr std::size_t kMostVariables = 3;
constexpr std::size_t kMostCoefficients = 128;  // of a Bernstein form
// Coefficients are floats or results of them, so a rest of this size is a rounding error.
constexpr double kRest = 1e-5;
// A bound above the rounding errors of all operations on a coefficient, relative to its terms.
constexpr double kCoefficientSlack = 0x1p-40;

Interval timesReal(const Interval& a, const Interval& b) {
    const auto at = [](double x, double y) { return x == 0.0 || y == 0.0 ? 0.0 : x * y; };
    const double p[] = {at(a.low, b.low), at(a.low, b.high), at(a.high, b.low), at(a.high, b.high)};
    return {std::min({p[0], p[1], p[2], p[3]}), std::max({p[0], p[1], p[2], p[3]})};
}

}  // namespace

Identities::Identities(const Program& program)
    : program_(program), expansions_(program.nodes.size()), errors_(program.nodes.size(), -1.0) {
    for (NodeId id = 0; id < program.nodes.size(); ++id) {
        const NodeId bare = bareOf(id);
        if (bare != id && program.nodes[bare].guard == program.nodes[id].guard) {
            refined_[bare] = id;
        }
        if (program.nodes[id].format == Format::Single) {
            expand(id);
        }
    }
}

// The node whose value this one has.
NodeId Identities::bareOf(NodeId id) const {
    for (;;) {
        const Node& node = program_.nodes[id];
        switch (node.op) {
            case Op::Refine:
            case Op::Bounded:
            case Op::UnitSum:
            case Op::PartOfUnit:
            case Op::WeightedUnit:
            case Op::UnitQuotient:
            case Op::Share:
            case Op::TriangleSum:
            case Op::MirroredSum:
                id = node.a;
                break;
            case Op::SquareOfRoot:
            case Op::SphereSum:
                id = node.b;
                break;
            case Op::CircleSum:
                id = node.c;
                break;
            default:
                return id;
        }
    }
}

void Identities::addTo(Polynomial& sum, const Polynomial& terms, double factor) {
    for (const auto& [monomial, coefficient] : terms) {
        Coefficient& total = sum[monomial];
        total.value += factor * coefficient.value;
        total.weight += std::abs(factor) * coefficient.weight;
    }
}

std::optional<Identities::Polynomial> Identities::product(const Polynomial& a, const Polynomial& b) const {
    if (a.size() * b.size() > kMostProducts) {
        return std::nullopt;
    }
    Polynomial result;
    for (const auto& [first, x] : a) {
        for (const auto& [second, y] : b) {
            Monomial both;
            both.reserve(first.size() + second.size());
            std::merge(first.begin(), first.end(), second.begin(), second.end(), std::back_inserter(both));
            if (both.size() > kMostFactors) {
                return std::nullopt;
            }
            Coefficient& total = result[both];
            total.value += x.value * y.value;
            total.weight += x.weight * y.weight;
        }
    }
    return result;
}

// Returns whether a term of one operand cancels a term of the other.
bool Identities::cancels(const Polynomial& sum, const Polynomial& a, const Polynomial& b) {
    return std::any_of(a.begin(), a.end(), [&](const auto& term) {
        const auto other = b.find(term.first);
        return other != b.end() && std::abs(term.second.value) > kRest * term.second.weight &&
               std::abs(sum.at(term.first).value) < kRest * std::abs(term.second.value);
    });
}

const Identities::Polynomial* Identities::termsOf(NodeId id) const {
    const std::optional<Expansion>& expansion = expansions_[bareOf(id)];
    return expansion ? &expansion->terms : nullptr;
}

// Returns the polynomial of an operation's operands; no value for a node that is no sum or product.
std::optional<Identities::Polynomial> Identities::expansionOf(const Node& node) const {
    const auto of = [&](NodeId id) -> Polynomial {
        const NodeId bare = bareOf(id);
        if (expansions_[bare]) {
            return expansions_[bare]->terms;
        }
        return {{{bare}, {1.0, 1.0}}};
    };
    Polynomial result;
    switch (node.op) {
        case Op::Constant:
            return Polynomial{{{}, {node.value, std::abs(node.value)}}};
        case Op::Add:
        case Op::Subtract:
            if (node.op == Op::Subtract && program_.nodes[node.b].op == Op::Floor &&
                program_.nodes[node.b].a == node.a) {
                return std::nullopt;  // more is known of it than of its terms
            }
            addTo(result, of(node.a), 1.0);
            addTo(result, of(node.b), node.op == Op::Add ? 1.0 : -1.0);
            return result;
        case Op::Negate:
            addTo(result, of(node.a), -1.0);
            return result;
        case Op::Multiply:
            return product(of(node.a), of(node.b));
        case Op::Square:
            return product(of(node.a), of(node.a));
        case Op::Mix:
        case Op::Lerp: {
            Polynomial difference = of(node.b);
            addTo(difference, of(node.a), -1.0);
            std::optional<Polynomial> whole = product(difference, of(node.c));
            if (whole) {
                addTo(*whole, of(node.a), 1.0);
            }
            return whole;
        }
        case Op::Divide: {
            const NodeId divisor = bareOf(node.b);
            if (program_.nodes[divisor].op == Op::Constant) {
                addTo(result, of(node.a), 1.0 / program_.nodes[divisor].value);
                return result;
            }
            return product(of(node.a), {{{divisor | kReciprocal}, {1.0, 1.0}}});
        }
        default:
            return std::nullopt;
    }
}

// Cancels a multiple of a divisor against its reciprocal. Returns whether there was one.
bool Identities::reduce(Expansion& expansion) const {
    NodeId reciprocal = kNoNode;
    for (const auto& [monomial, coefficient] : expansion.terms) {
        if (!monomial.empty() && (monomial.back() & kReciprocal) != 0) {
            reciprocal = monomial.back();
        }
    }
    const Polynomial* const divisor = reciprocal == kNoNode ? nullptr : termsOf(reciprocal & ~kReciprocal);
    if (divisor == nullptr || divisor->size() < 2) {
        return false;
    }
    const auto& [pivot, ofPivot] = *divisor->begin();
    for (const auto& [monomial, coefficient] : expansion.terms) {
        if (monomial.empty() || monomial.back() != reciprocal ||
            std::abs(coefficient.value) <= kRest * coefficient.weight ||
            !std::includes(monomial.begin(), monomial.end() - 1, pivot.begin(), pivot.end())) {
            continue;
        }
        Monomial rest;
        std::set_difference(monomial.begin(), monomial.end() - 1, pivot.begin(), pivot.end(),
                            std::back_inserter(rest));
        Monomial multiple = rest;
        multiple.push_back(reciprocal);
        std::sort(multiple.begin(), multiple.end());
        const double factor = coefficient.value / ofPivot.value;
        const std::optional<Polynomial> taken = product(*divisor, {{multiple, {1.0, 1.0}}});
        if (!taken) {
            return false;
        }
        Polynomial left = expansion.terms;
        addTo(left, *taken, -factor);
        const auto count = [](const Polynomial& terms) {
            return std::count_if(terms.begin(), terms.end(), [](const auto& term) {
                return std::abs(term.second.value) > kRest * term.second.weight;
            });
        };
        if (count(left) + 2 > count(expansion.terms)) {
            continue;
        }
        addTo(left, {{rest, {1.0, 1.0}}}, factor);
        expansion.terms = std::move(left);
        expansion.cancelled.push_back({std::move(rest), factor, reciprocal & ~kReciprocal});
        return true;
    }
    return false;
}

void Identities::expand(NodeId id) {
    const Node& node = program_.nodes[id];
    if (bareOf(id) != id) {
        return;
    }
    std::optional<Polynomial> terms = expansionOf(node);
    if (!terms || terms->size() > kMostTerms) {
        return;
    }
    Expansion expansion;
    expansion.terms = std::move(*terms);
    if (node.op == Op::Add || node.op == Op::Subtract) {
        const Polynomial* const a = termsOf(node.a);
        const Polynomial* const b = termsOf(node.b);
        const Polynomial itself{{{bareOf(node.a)}, {1.0, 1.0}}};
        const Polynomial other{{{bareOf(node.b)}, {1.0, 1.0}}};
        expansion.isIdentity =
            cancels(expansion.terms, a != nullptr ? *a : itself, b != nullptr ? *b : other);
    }
    for (int turn = 0; turn < 4 && reduce(expansion); ++turn) {
        expansion.isIdentity = true;
    }
    if (node.op == Op::Add || node.op == Op::Subtract || node.op == Op::Lerp || node.op == Op::Mix ||
        node.op == Op::Multiply) {
        expansion.variables = variablesOf(expansion.terms);
        expansion.isIdentity = expansion.isIdentity || !expansion.variables.empty();
    }
    expansions_[id] = std::move(expansion);
}

void Identities::forgetBox() {
    for (const NodeId id : computed_) {
        errors_[id] = -1.0;
    }
    computed_.clear();
}

Interval Identities::valueOf(const Monomial& monomial, NodeId before,
                             std::span<const Interval> values) const {
    Interval result{1.0, 1.0};
    for (std::size_t k = 0; k < monomial.size();) {
        const NodeId factor = monomial[k];
        std::size_t end = k;
        while (end < monomial.size() && monomial[end] == factor) {
            ++end;
        }
        const NodeId bare = factor & ~kReciprocal;
        const auto refined = refined_.find(bare);
        Interval value =
            values[refined != refined_.end() && refined->second < before ? refined->second : bare];
        if ((factor & kReciprocal) != 0) {
            value = value.low > 0.0 || value.high < 0.0 ? Interval{1.0 / value.high, 1.0 / value.low}
                                                        : Interval{};
        }
        // A power, so that an even one is not negative.
        Interval power{1.0, 1.0};
        for (std::size_t n = k; n < end; ++n) {
            power = timesReal(power, value);
        }
        if ((end - k) % 2 == 0) {
            power.low = std::max(power.low, 0.0);
        }
        result = timesReal(result, power);
        k = end;
    }
    return result;
}

// Bounds how far the float is from the polynomial.
double Identities::errorOf(NodeId id, std::span<const Interval> values) {
    id = bareOf(id);
    const Node& node = program_.nodes[id];
    if (!expansions_[id] || node.op == Op::Constant) {
        return 0.0;
    }
    if (errors_[id] >= 0.0) {
        return errors_[id];
    }
    const auto size = [&](NodeId of) { return of == kNoNode ? 0.0 : values[of].magnitude(); };
    const double a = node.a == kNoNode ? 0.0 : errorOf(node.a, values);
    const double b = node.b == kNoNode || node.op == Op::Divide ? 0.0 : errorOf(node.b, values);
    const double c = node.c == kNoNode ? 0.0 : errorOf(node.c, values);
    double error = 0.0;
    double roundings = 2.0;
    double rounded = size(id);
    switch (node.op) {
        case Op::Negate:
            error = a;
            roundings = 0.0;
            break;
        case Op::Multiply:
            error = size(node.a) * b + (size(node.b) + b) * a;
            break;
        case Op::Square:
            error = (2.0 * size(node.a) + a) * a;
            break;
        case Op::Mix:
        case Op::Lerp:
            error = (1.0 + size(node.c) + c) * (a + b) + (size(node.a) + size(node.b)) * c;
            roundings = 10.0;
            rounded = (size(node.a) + size(node.b)) * (1.0 + size(node.c));
            break;
        case Op::Divide: {
            const Interval& divisor = values[node.b];
            const double least = std::min(std::abs(divisor.low), std::abs(divisor.high));
            error = divisor.contains(0.0) ? kInfinity : a / least;
            break;
        }
        default:
            error = a + b;
            break;
    }
    error += roundings * unitRoundoff(node.format) * rounded + 4.0 * halfDenormal(node.format);
    for (const Cancelled& part : expansions_[id]->cancelled) {
        const Interval& divisor = values[part.divisor];
        const double least = std::min(std::abs(divisor.low), std::abs(divisor.high));
        error += divisor.contains(0.0)
                     ? kInfinity
                     : std::abs(part.factor) * valueOf(part.monomial, id, values).magnitude() *
                           errorOf(part.divisor, values) / least;
    }
    errors_[id] = std::isnan(error) ? kInfinity : error * (1.0 + 0x1p-30);
    computed_.push_back(id);
    return errors_[id];
}

// The variables of a polynomial that the Bernstein form is made of: few, none of them a reciprocal, and one
// that is in several terms. Empty for others.
std::vector<Identities::Variable> Identities::variablesOf(const Polynomial& terms) {
    std::map<NodeId, std::pair<std::size_t, std::size_t>> found;  // degree, terms
    for (const auto& [monomial, coefficient] : terms) {
        for (std::size_t k = 0; k < monomial.size();) {
            const auto end = static_cast<std::size_t>(
                std::upper_bound(monomial.begin(), monomial.end(), monomial[k]) - monomial.begin());
            auto& [degree, uses] = found[monomial[k]];
            degree = std::max(degree, end - k);
            ++uses;
            k = end;
        }
    }
    std::vector<Variable> variables;
    std::size_t coefficients = 1;
    bool isRepeated = false;
    for (const auto& [node, use] : found) {
        variables.push_back({node, use.first});
        coefficients *= use.first + 1;
        isRepeated = isRepeated || use.second > 1;
        if ((node & kReciprocal) != 0 || variables.size() > kMostVariables ||
            coefficients > kMostCoefficients) {
            return {};
        }
    }
    return isRepeated ? variables : std::vector<Variable>();
}

// The hull of the Bernstein coefficients over the box of the variables.
Interval Identities::bernstein(const Expansion& expansion, NodeId before,
                               std::span<const Interval> values) const {
    std::array<long double, kMostCoefficients> tensor{};
    std::array<Interval, kMostVariables> box;
    std::size_t count = 1;
    for (std::size_t k = 0; k < expansion.variables.size(); ++k) {
        box[k] = valueOf({expansion.variables[k].node}, before, values);
        if (box[k].isEmpty() || !box[k].isFinite()) {
            return {};
        }
        count *= expansion.variables[k].degree + 1;
    }
    long double size = 0.0L;
    for (const auto& [monomial, coefficient] : expansion.terms) {
        std::size_t place = 0;
        long double weight = coefficient.weight;
        for (std::size_t k = 0; k < expansion.variables.size(); ++k) {
            const Variable& variable = expansion.variables[k];
            const auto [first, last] = std::equal_range(monomial.begin(), monomial.end(), variable.node);
            place = place * (variable.degree + 1) + static_cast<std::size_t>(last - first);
            const Interval& value = box[k];
            weight *= std::pow(std::abs(value.low) + value.width(), static_cast<double>(last - first));
        }
        tensor[place] = coefficient.value;
        size += weight;
    }
    std::size_t stride = count;
    for (std::size_t variable = 0; variable < expansion.variables.size(); ++variable) {
        const std::size_t degree = expansion.variables[variable].degree;
        const std::size_t block = stride;
        stride /= degree + 1;
        const long double low = box[variable].low;
        const long double width = static_cast<long double>(box[variable].high) - low;
        for (std::size_t start = 0; start < count; start += block) {
            for (std::size_t within = 0; within < stride; ++within) {
                const auto at = [&](std::size_t k) -> long double& {
                    return tensor[start + within + k * stride];
                };
                // Taylor's shift to the lower end, by Horner's scheme.
                for (std::size_t k = 0; k < degree; ++k) {
                    for (std::size_t j = degree; j-- > k;) {
                        at(j) += low * at(j + 1);
                    }
                }
                // Powers of the width, over binomials; then the sums of Pascal's triangle.
                long double scale = 1.0L;
                for (std::size_t k = 1; k <= degree; ++k) {
                    scale *= width * static_cast<long double>(k) / static_cast<long double>(degree - k + 1);
                    at(k) *= scale;
                }
                for (std::size_t k = 1; k <= degree; ++k) {
                    for (std::size_t j = degree; j >= k; --j) {
                        at(j) += at(j - 1);
                    }
                }
            }
        }
    }
    const auto [least, greatest] =
        std::minmax_element(tensor.begin(), tensor.begin() + static_cast<std::ptrdiff_t>(count));
    const double slack = static_cast<double>(size) * 0x1p-48;
    return {static_cast<double>(*least) - slack, static_cast<double>(*greatest) + slack};
}

Interval Identities::bound(NodeId id, std::span<const Interval> values) {
    if (!expansions_[id] || !expansions_[id]->isIdentity) {
        return {};
    }
    const bool hasForm = !expansions_[id]->variables.empty();
    const Interval form = hasForm ? bernstein(*expansions_[id], id, values) : Interval{};
    Interval sum{0.0, 0.0};
    double slack = 0.0;
    for (const auto& [monomial, coefficient] : expansions_[id]->terms) {
        const Interval value = valueOf(monomial, id, values);
        if (value.isEmpty() || !value.isFinite()) {
            return {};
        }
        const Interval term = timesReal(value, Interval::of(coefficient.value));
        sum = {sum.low + term.low, sum.high + term.high};
        slack += coefficient.weight * value.magnitude() * kCoefficientSlack;
    }
    const double error = errorOf(id, values) + slack;
    const Interval best = meet(sum, form);
    return std::isfinite(error) ? Interval{best.low - error, best.high + error} : Interval{};
}

}  // namespace glint::verify
