// Claims about the shaders' functions hold; what proves them encloses what the functions compute; and faults
// that are planted are found.
#include "proofs.h"

#include "proof_functions.h"
#include "support/must.h"
#include "verify/concrete.h"
#include "verify/evaluate.h"
#include "verify/interval.h"
#include "verify/prover.h"
#include "verify/specialise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace glint::numerics {
namespace {

using verify::Interval;

const std::vector<verify::Program>& programs() {
    static const std::vector<verify::Program> kPrograms = [] { return must(compileProofs(allProofs())); }();
    return kPrograms;
}

// A number in [0, 1), and often an end.
double randomShare(std::mt19937_64& random) {
    const double share = static_cast<double>(random() >> 11U) * 0x1p-53;
    return share < 0.05 ? 0.0 : share > 0.95 ? 0.99999 : share;
}

double between(std::mt19937_64& random, const Interval& range) {
    const auto value =
        static_cast<double>(static_cast<float>(range.low + randomShare(random) * range.width()));
    return std::clamp(value, range.low, range.high);
}

TEST(Proofs, SucceedForTheQuickSet) {
    ASSERT_EQ(programs().size(), allProofs().size());
    std::size_t proved = 0;
    for (std::size_t k = 0; k < programs().size(); ++k) {
        const Proof& proof = allProofs()[k];
        if (!isProvedQuickly(proof)) {
            continue;
        }
        verify::ProofOptions options;
        options.mostBoxes = proof.boxes;
        options.samples = 100;
        const verify::ProofResult result = verify::prove(programs()[k], proof.claim, options);
        EXPECT_EQ(result.state, verify::ProofState::Proved)
            << proof.name << ": " << result.undecidedWhy
            << (result.counterexample ? result.counterexample->what : std::string());
        ++proved;
    }
    EXPECT_GE(proved, 30U);
}

TEST(Proofs, NoClaimIsRefutedBySamples) {
    ASSERT_EQ(programs().size(), allProofs().size());
    for (std::size_t k = 0; k < programs().size(); ++k) {
        verify::ProofOptions options;
        options.mostBoxes = 1;
        options.samples = 3000;
        options.seed = 7;
        const verify::ProofResult result = verify::prove(programs()[k], allProofs()[k].claim, options);
        ASSERT_TRUE(result.state != verify::ProofState::Refuted)
            << allProofs()[k].name << ": " << result.counterexample->what;
    }
}

// Inputs for which claims once were wrong.
TEST(Proofs, HoldForEarlierCounterexamples) {
    struct Case {
        const char* claim;
        std::vector<double> inputs;
    };
    const Case cases[] = {
        // The cosine of the view was rounded to more than 1, and a power of a negative number was taken.
        {"EvaluateSheen",
         {0.163801059F, 1.0, 0.595538139F, 1.0, -3.14159274F, 1.32458908e-07F, 0.0479270294F, 2.0699687F,
          2.00000002e-07F}},
        // The mean of the bias fell below 0.
        {"AnisotropicGgxMeanAlbedo", {0.743968368F, 1.0}},
        // The fourth power of the distance over the range overflowed.
        {"SampleLight",
         {0.140447244F, 2.27492142F, -1.39183172e-07F, 2.18818389e-16F, 2.00296691e-23F, 239.830826F,
          758.09082F, -0.0635154843F, -1.80689096F, -1.06979094e-07F, 0.160171479F}},
    };
    for (const Case& known : cases) {
        const auto found = std::find_if(allProofs().begin(), allProofs().end(),
                                        [&](const Proof& proof) { return proof.name == known.claim; });
        ASSERT_NE(found, allProofs().end());
        const auto place = static_cast<std::size_t>(found - allProofs().begin());
        const auto wrong = verify::refute(programs()[place], found->claim, known.inputs);
        EXPECT_FALSE(wrong.has_value()) << known.claim << ": " << *wrong;
    }
}

// The condition of a branch that the box does not take has no value. It does not decide about that of another
// branch.
TEST(Intervals, ConditionsOfBranchesThatAreNotTakenDecideNothing) {
    using verify::Format;
    using verify::Op;
    verify::Program program;
    program.inputCount = 1;
    const auto add = [&](verify::Node node) {
        program.nodes.push_back(node);
        return static_cast<verify::NodeId>(program.nodes.size() - 1);
    };
    const auto truth = [&](double value) {
        return add({.op = Op::Constant, .format = Format::Integer, .value = value});
    };
    const verify::NodeId x = add({.op = Op::Input});
    const verify::NodeId zero = add({.op = Op::Constant});
    const verify::NodeId below =
        add({.op = Op::Refine, .relation = verify::Relation::Less, .a = x, .b = zero});
    const verify::NodeId isBelow = add({.op = Op::Less, .format = Format::Integer, .a = below, .b = zero});
    const verify::NodeId no = truth(0.0);
    const verify::NodeId yes = truth(1.0);
    const verify::NodeId either = add({.op = Op::Or, .format = Format::Integer, .a = isBelow, .b = no});
    const verify::NodeId both = add({.op = Op::And, .format = Format::Integer, .a = isBelow, .b = yes});
    verify::BoxEvaluator boxes(program);
    const std::vector<Interval> box = {{0.5, 1.0}};
    boxes.run(box, false);
    ASSERT_TRUE(boxes.value(isBelow).isEmpty());
    EXPECT_TRUE(boxes.value(either).contains(0.0));
    EXPECT_TRUE(boxes.value(both).contains(1.0));
}

// For random boxes: whatever any operation gives at a point of the box lies in its interval, with and without
// forms.
TEST(Intervals, EncloseEveryOperationAtPointsOfTheBox) {
    std::mt19937_64 random(3);
    std::uint64_t compared = 0;
    for (std::size_t k = 0; k < programs().size(); ++k) {
        const verify::Claim& claim = allProofs()[k].claim;
        std::vector<Interval> domain;
        for (const verify::InputRange& input : claim.inputs) {
            domain.push_back({input.low, input.high});
        }
        // The program that proofs evaluate has more patterns than the one from which it was made.
        const verify::Program program =
            k % 4 == 0 ? programs()[k] : verify::specialise(programs()[k], domain);
        verify::BoxEvaluator boxes(program);
        verify::PointEvaluator points(program);
        for (int turn = 0; turn < 12; ++turn) {
            std::vector<Interval> box;
            for (const verify::InputRange& input : claim.inputs) {
                const double a = between(random, {input.low, input.high});
                const double size = std::exp2(-static_cast<double>(turn) * 2.0) * (input.high - input.low);
                const auto b = static_cast<double>(static_cast<float>(a + size * randomShare(random)));
                box.push_back({a, std::clamp(b, a, input.high)});
            }
            boxes.run(box, turn % 3 != 0);
            for (int point = 0; point < 6; ++point) {
                std::vector<double> inputs;
                for (const Interval& side : box) {
                    inputs.push_back(between(random, side));
                }
                points.run(inputs);
                for (verify::NodeId id = 0; id < program.nodes.size(); ++id) {
                    const double value = points.value(id);
                    if (!std::isfinite(value)) {
                        continue;
                    }
                    ++compared;
                    ASSERT_TRUE(boxes.value(id).contains(value))
                        << allProofs()[k].name << ": " << verify::describe(program, id) << " is " << value
                        << ", not in [" << boxes.value(id).low << ", " << boxes.value(id).high << "]";
                }
            }
        }
    }
    EXPECT_GT(compared, 500'000U);
}

// The intervals are about SPIR-V, and these builds about the text: both mean the same functions.
TEST(Intervals, EncloseTheFloatAndTheDoubleBuild) {
    std::mt19937_64 random(5);
    std::size_t functions = 0;
    for (std::size_t k = 0; k < proofFunctions<float>().size(); ++k) {
        const auto proof = std::find_if(allProofs().begin(), allProofs().end(), [&](const Proof& candidate) {
            return candidate.name == proofFunctions<float>()[k].name;
        });
        if (proof == allProofs().end()) {
            continue;
        }
        ++functions;
        const verify::Program& program = programs()[static_cast<std::size_t>(proof - allProofs().begin())];
        verify::BoxEvaluator boxes(program);
        for (int turn = 0; turn < 40; ++turn) {
            float given[kMaxInputs] = {};
            double exact[kMaxInputs] = {};
            std::vector<Interval> box;
            for (std::size_t input = 0; input < proof->claim.inputs.size(); ++input) {
                const verify::InputRange& range = proof->claim.inputs[input];
                exact[input] = between(random, {range.low, range.high});
                given[input] = static_cast<float>(exact[input]);
                box.push_back(Interval::of(exact[input]));
            }
            boxes.run(box, false);
            if (!boxes.findings().empty()) {
                continue;
            }
            float single[kMaxOutputs] = {};
            double real[kMaxOutputs] = {};
            proofFunctions<float>()[k].call(given, single);
            proofFunctions<double>()[k].call(exact, real);
            for (std::size_t output = 0; output < proof->claim.outputs.size(); ++output) {
                const Interval& value = boxes.value(program.outputs[output]);
                ASSERT_TRUE(value.contains(static_cast<double>(single[output])))
                    << proof->name << " output " << output << ": " << single[output] << " is not in ["
                    << value.low << ", " << value.high << "]";
                // The text's constants are floats in SPIR-V, and doubles here.
                const double slack = 1e-6 * (1.0 + std::abs(real[output]));
                ASSERT_TRUE(value.low - slack <= real[output] && real[output] <= value.high + slack)
                    << proof->name << " output " << output << ": " << real[output] << " is not in ["
                    << value.low << ", " << value.high << "]";
            }
        }
    }
    EXPECT_GT(functions, 50U);
}

// Directed rounding: the bounds are the floats around the exact result, so that bounds which are narrower by
// one unit in the last place lose it.
TEST(Intervals, ABoundThatIsOneUnitTooNarrowIsNoticed) {
    std::mt19937_64 random(11);
    const verify::Arithmetic single(verify::Format::Single);
    int lostBelow = 0;
    int lostAbove = 0;
    for (int turn = 0; turn < 10'000; ++turn) {
        const auto a = static_cast<double>(static_cast<float>(std::exp2(randomShare(random) * 40.0 - 20.0)));
        const auto b = static_cast<double>(static_cast<float>(std::exp2(randomShare(random) * 40.0 - 20.0)));
        verify::Hazard hazard = verify::Hazard::None;
        const double exact[] = {a + b, a * b, a / b, std::sqrt(a)};
        const Interval bounds[] = {single.add(Interval::of(a), Interval::of(b), hazard),
                                   single.multiply(Interval::of(a), Interval::of(b), hazard),
                                   single.divide(Interval::of(a), Interval::of(b), hazard),
                                   single.apply(verify::Function::Sqrt, Interval::of(a), hazard)};
        ASSERT_EQ(hazard, verify::Hazard::None);
        for (std::size_t k = 0; k < 4; ++k) {
            ASSERT_TRUE(bounds[k].contains(exact[k]));
            ASSERT_LE(bounds[k].width(), std::abs(exact[k]) * 0x1p-22);
            const double narrowLow = -verify::nextFloatBelow(static_cast<float>(-bounds[k].low));
            const double narrowHigh = verify::nextFloatBelow(static_cast<float>(bounds[k].high));
            lostBelow += exact[k] < narrowLow ? 1 : 0;
            lostAbove += exact[k] > narrowHigh ? 1 : 0;
        }
    }
    EXPECT_GT(lostBelow, 30'000);
    EXPECT_GT(lostAbove, 30'000);
}

// The same for a claim: (1 - cosine)^5 is 1 at 0 and 0 at 1, and not a unit less or more.
TEST(Proofs, AClaimThatIsOneUnitTooNarrowIsRefuted) {
    const auto proof = std::find_if(allProofs().begin(), allProofs().end(),
                                    [](const Proof& candidate) { return candidate.name == "SchlickWeight"; });
    const verify::Program& program = programs()[static_cast<std::size_t>(proof - allProofs().begin())];
    verify::Claim claim = proof->claim;
    EXPECT_EQ(verify::prove(program, claim, {}).state, verify::ProofState::Proved);
    claim.outputs[0].high = verify::nextFloatBelow(1.0F);
    EXPECT_EQ(verify::prove(program, claim, {}).state, verify::ProofState::Refuted);
    claim.outputs[0] = {"weight", std::numeric_limits<float>::denorm_min(), 1.0};
    EXPECT_EQ(verify::prove(program, claim, {}).state, verify::ProofState::Refuted);
}

// Whatever intervals, forms and derivatives say together: a range that some point of the domain leaves is not
// proved.
TEST(Proofs, NeverSucceedForAClaimThatAPointRefutes) {
    std::mt19937_64 random(17);
    std::size_t claims = 0;
    for (std::size_t k = 0; k < programs().size(); ++k) {
        verify::Claim claim = allProofs()[k].claim;
        verify::PointEvaluator points(programs()[k]);
        std::vector<double> least(claim.outputs.size(), verify::kInfinity);
        std::vector<double> greatest(claim.outputs.size(), -verify::kInfinity);
        for (int point = 0; point < 300; ++point) {
            std::vector<double> inputs;
            for (const verify::InputRange& input : claim.inputs) {
                inputs.push_back(between(random, {input.low, input.high}));
            }
            const verify::PointResult result = points.run(inputs);
            for (std::size_t output = 0; output < claim.outputs.size(); ++output) {
                least[output] = std::min(least[output], result.outputs[output]);
                greatest[output] = std::max(greatest[output], result.outputs[output]);
            }
        }
        verify::ProofOptions options;
        options.samples = 0;
        options.mostBoxes = 40;
        for (const bool upper : {false, true}) {
            const std::size_t output = random() % claim.outputs.size();
            verify::OutputRange& range = claim.outputs[output];
            const verify::OutputRange whole = range;
            const auto bound = static_cast<float>(upper ? greatest[output] : -least[output]);
            (upper ? range.high : range.low) =
                upper ? verify::nextFloatBelow(bound) : -static_cast<double>(verify::nextFloatBelow(bound));
            EXPECT_NE(verify::prove(programs()[k], claim, options).state, verify::ProofState::Proved)
                << allProofs()[k].name << " " << range.name << " in [" << range.low << ", " << range.high
                << "]";
            range = whole;
            ++claims;
        }
    }
    EXPECT_GT(claims, 100U);
}

struct Planted {
    const char* code;
    verify::InputRange input;
    verify::ProofState state;
    const char* words;  // of what was found
};

// Each operation's domain is checked; a branch that keeps out of the way is understood.
TEST(Proofs, AMissingCheckOfADomainIsFound) {
    using verify::ProofState;
    const Planted cases[] = {
        {"o[0] = sqrt(i[0]);", {"x", -1.0, 1.0}, ProofState::Refuted, "sqrt"},
        {"o[0] = i[0] > 0.0 ? sqrt(i[0]) : 0.0;", {"x", -1.0, 1.0}, ProofState::Proved, ""},
        {"o[0] = 1.0 / i[0];", {"x", -1.0, 1.0}, ProofState::Refuted, "/"},
        {"if (i[0] > 0.25) { o[0] = 1.0 / i[0]; }", {"x", -1.0, 1.0}, ProofState::Proved, ""},
        {"o[0] = acos(i[0]);", {"x", -1.0, 1.0000002F}, ProofState::Refuted, "acos"},
        {"o[0] = acos(clamp(i[0], -1.0, 1.0));", {"x", -1.0, 1.0000002F}, ProofState::Proved, ""},
        {"o[0] = log(i[0]);", {"x", 0.0, 1.0}, ProofState::Refuted, "log"},
        {"o[0] = pow(i[0], 0.2);", {"x", -1e-7F, 1.0}, ProofState::Refuted, "pow"},
        {"o[0] = i[0] * i[0];", {"x", 0.0, 1e20F}, ProofState::Refuted, "square"},
        {"o[0] = exp(i[0]);", {"x", 0.0, 100.0}, ProofState::Refuted, "exp"},
        {"o[0] = normalize(vec2(i[0], 0.0)).x;", {"x", 0.0, 1.0}, ProofState::Refuted, ""},
        // 16 bits end at 65504.
        {"mediump float h = i[0]; o[0] = h * h;", {"x", 0.0, 300.0}, ProofState::Refuted, ""},
        {"mediump float h = i[0]; o[0] = h * h;", {"x", 0.0, 250.0}, ProofState::Proved, ""},
        {"for (int k = 0; k < 4; ++k) { o[0] += i[0]; }", {"x", 0.0, 1.0}, ProofState::Proved, ""},
    };
    for (const Planted& planted : cases) {
        const verify::Program program = must(compileClaim(planted.code));
        const verify::Claim claim{{planted.input}, {{"result", -kLargest, kLargest}}};
        const verify::ProofResult result = verify::prove(program, claim, {});
        EXPECT_EQ(result.state, planted.state)
            << planted.code << ": " << result.undecidedWhy
            << (result.counterexample ? result.counterexample->what : std::string());
        if (result.counterexample) {
            EXPECT_NE(result.counterexample->what.find(planted.words), std::string::npos)
                << result.counterexample->what;
        }
    }
}

// A proof follows nothing that depends on a resource.
TEST(Proofs, WhatCannotBeFollowedIsSaid) {
    EXPECT_EQ(mustFail(compileClaim("while (o[0] < i[0]) { o[0] = o[0] * 1.5 + 1.0; }")).id,
              "prove-unsupported");
}

}  // namespace
}  // namespace glint::numerics
