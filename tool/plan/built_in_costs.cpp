#include "plan/built_in_costs.h"

#include "plan/strategy_constants.h"

#include <algorithm>
#include <iterator>

namespace glint::compiler {

DeviceCosts builtInCosts(bool onCpu) {
    const auto* row = std::ranges::find(fitted::kDevices, onCpu, &fitted::DeviceRow::onCpu);
    if (row == std::end(fitted::kDevices)) {
        row = std::begin(fitted::kDevices);
    }
    DeviceCosts costs{std::string(row->device),
                      std::string(row->driver),
                      row->onCpu,
                      row->subgroupSize,
                      std::string(row->tracer),
                      std::string(row->shadows),
                      std::string(row->command),
                      {}};
    for (const fitted::StrategyConstants& strategy : row->strategies) {
        costs.strategies.push_back({std::string(strategy.strategy), strategy.constants});
    }
    return costs;
}

}  // namespace glint::compiler
