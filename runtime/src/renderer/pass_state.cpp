#include "renderer/pass_state.h"

#include "context/readback.h"

namespace glint {

Result<std::vector<PassTiming>> passTimings(PassState& state) {
    if (!state.recorded) {
        return frameNotRecorded();
    }
    const auto count = static_cast<std::uint32_t>(state.timed.size());
    Result<std::vector<double>> milliseconds = state.timer.read(count);
    if (!milliseconds) {
        return milliseconds.error();
    }
    std::vector<PassTiming> timings;
    for (std::uint32_t i = 0; i < count; ++i) {
        const PassLabel& label = state.timed[i];
        timings.push_back({label.name, (*milliseconds)[i], label.pass, label.shaderId});
    }
    return timings;
}

}  // namespace glint
