// The passes that shade the rays of the list.
#pragma once

#include "renderer/pass_recorder.h"

namespace glint {

class HitPasses {
public:
    HitPasses(PassState& state, PassRecorder& passes) : state_(state), passes_(passes) {}

    // Sets the indirect arguments of the list, from its counter.
    void dispatchOfList();
    // Strategies that shade where they trace have nothing to do in these two.
    void trace();
    void order();
    void shade();

private:
    const PassDependencies& dependencies() const {
        return passes_.dependencies();
    }
    const PassPipeline& pass(package::ModuleRole role) const {
        return state_.pipelines.passes.at(role);
    }
    bool ordersHits() const {
        return (state_.choice.strategy & package::orderedStrategies()) != 0;
    }
    void dispatchRays(const PassLabel& label, package::ModuleRole role);
    // Dispatches the pass of a strategy's role, if it has one.
    void dispatch(const package::RoleInfo& info);
    void shadeCases(const package::RoleInfo& info);

    PassState& state_;
    PassRecorder& passes_;
};

}  // namespace glint
