// The cost of a plan by the model of plan/cost.h, case by case. It explains to people how a plan came about.
// The unit is that of plan/cost.h: SPIR-V instructions that an average hit runs in vain.
#pragma once

#include "plan/plan.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace glint::compiler {

// A feature that a case branches on.
struct BranchCost {
    const materials::Feature* feature = nullptr;  // of the plan's model
    double share = 0.0;  // share of the case's hits that have it; 0 if nothing hits the case
    double cost = 0.0;
};

struct KeyCost {
    int key = 0;               // index into Plan::keys
    CodeEstimate own;          // estimate of a shader of this key alone
    double leavingAdds = 0.0;  // growth of the plan's cost if the key gets a case of its own; below 0 it
                               // shrinks
};

// The case with which merging would add the least cost.
struct NearestCase {
    int shaderId = 0;
    double adds = 0.0;  // surplus that merging would add; it would save kCaseCost
};

struct CaseCost {
    int shaderId = 0;
    CodeEstimate code;             // estimate of the case's shader
    double ownInstructions = 0.0;  // average over its hits of the shaders of its keys alone
    double inVain = 0.0;
    double saved = 0.0;                // kCaseCost for each key except the first
    std::vector<BranchCost> branches;  // the most costly first, then by bit
    std::vector<KeyCost> keys;         // as in Case::keys
    std::optional<NearestCase> nearest;
};

struct PlanCost {
    std::vector<CaseCost> cases;  // by shader ID, without retired ones
    double inVain = 0.0;
};

// Takes O(n^2) steps in the number of cases.
PlanCost costPlan(const Plan& plan, const PlanOptions& options);

// Returns the total cost: the surplus, plus kCaseCost for each case.
double totalCost(double inVain, std::size_t cases);

}  // namespace glint::compiler
