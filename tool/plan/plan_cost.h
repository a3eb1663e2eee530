// What a plan costs by the model of plan/cost.h, case by case, and what other cases would cost: how a plan
// came about, for people. Unit: as there, SPIR-V instructions that an average hit runs in vain.
#pragma once

#include "plan/plan.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace glint {

// A feature that a case branches on.
struct BranchCost {
    Feature feature{};
    double share = 0.0;  // of the case's hits that have it; 0 where nothing hits the case
    double cost = 0.0;
};

struct KeyCost {
    int key = 0;               // index into Plan::keys
    CodeEstimate own;          // a shader of this key alone
    double leavingAdds = 0.0;  // to the cost of the plan, were it a case of its own; less than 0: that spares
};

// The case with which merging would add least.
struct NearestCase {
    int shaderId = 0;
    double adds = 0.0;  // in vain; kCaseCost is what it would spare
};

struct CaseCost {
    int shaderId = 0;
    CodeEstimate code;             // of its shader
    double ownInstructions = 0.0;  // of shaders of its keys alone, on average over its hits
    double inVain = 0.0;
    double saved = 0.0;                // kCaseCost for each key beyond the first
    std::vector<BranchCost> branches;  // the most costly first, then by bit
    std::vector<KeyCost> keys;         // as in Case::keys
    std::optional<NearestCase> nearest;
};

// The same keys under a policy, within the budget of the plan's options where the policy keeps to one.
struct PolicyCost {
    MergePolicy merge{};
    std::size_t cases = 0;
    double inVain = 0.0;
};

struct PlanCost {
    std::vector<CaseCost> cases;  // by shader ID, without retired ones
    double inVain = 0.0;
    std::vector<PolicyCost> policies;  // None, Family, All, Auto
};

// O(n^2) in the number of cases.
PlanCost costPlan(const Plan& plan, const PlanOptions& options);

// What cases cost in all: what is in vain, and kCaseCost for each.
double totalCost(double inVain, std::size_t cases);

}  // namespace glint
