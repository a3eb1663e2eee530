#include "renderer/pass_state.h"

namespace glint {

Diagnostic frameNotRecorded() {
    return makeError("frame-not-recorded", "", "no frame has been recorded",
                     "record a frame, submit it and wait for it first");
}

Result<std::vector<PassTiming>> passTimings(PassState& state) {
    if (!state.recorded) {
        return frameNotRecorded();
    }
    const auto count = static_cast<std::uint32_t>(state.timed.size());
    GLINT_TRY(auto milliseconds, state.timer.read(count));
    std::vector<PassTiming> timings;
    for (std::uint32_t i = 0; i < count; ++i) {
        const PassLabel& label = state.timed[i];
        timings.push_back({label.name, milliseconds[i], label.pass, label.shaderId});
    }
    return timings;
}

}  // namespace glint
