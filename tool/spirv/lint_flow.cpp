#include "spirv/lint_flow.h"

#include <algorithm>
#include <functional>

namespace glint::compiler {

namespace {

enum class Step { On, Stop };

// Visits all events after `start`, along all paths that `visit` does not stop. If a loop leads back, the
// events behind `start` in its block are visited a second time. Returns whether a path reached the end of the
// function.
bool walk(const FlowFunction& function, EventPlace start, const std::function<Step(EventPlace)>& visit) {
    std::vector<bool> entered(function.blocks.size(), false);
    std::vector<EventPlace> pending{{start.block, start.event + 1}};
    bool reachedEnd = false;
    while (!pending.empty()) {
        EventPlace place = pending.back();
        pending.pop_back();
        const FlowBlock& block = function.blocks[place.block];
        bool stopped = false;
        for (; place.event < block.events.size() && !stopped; ++place.event) {
            stopped = visit(place) == Step::Stop;
        }
        if (stopped) {
            continue;
        }
        reachedEnd = reachedEnd || block.exits;
        for (const std::size_t successor : block.successors) {
            if (!entered[successor]) {
                entered[successor] = true;
                pending.push_back({successor, 0});
            }
        }
    }
    return reachedEnd;
}

// Calls `visit` for events of the object of `start`, up to where it is initialised again.
bool walkObject(const FlowFunction& function, EventPlace start,
                const std::function<Step(EventPlace)>& visit) {
    const std::size_t object = at(function, start).object;
    return walk(function, start, [&](EventPlace place) {
        if (at(function, place).object != object) {
            return Step::On;
        }
        return visit(place);
    });
}

}  // namespace

std::vector<EventPlace> eventsAfter(const FlowFunction& function, EventPlace start) {
    std::vector<EventPlace> events;
    walkObject(function, start, [&](EventPlace place) {
        if (at(function, place).act == QueryAct::Initialize) {
            return Step::Stop;
        }
        events.push_back(place);
        return Step::On;
    });
    std::sort(events.begin(), events.end());
    // walk() may visit an event twice.
    events.erase(std::unique(events.begin(), events.end()), events.end());
    return events;
}

bool canAvoid(const FlowFunction& function, EventPlace start, EventPlace via) {
    bool again = false;
    const bool reachedEnd = walkObject(function, start, [&](EventPlace place) {
        again = again || (place != via && at(function, place).act == QueryAct::Initialize);
        return place == via || at(function, place).act == QueryAct::Initialize ? Step::Stop : Step::On;
    });
    return again || reachedEnd;
}

bool repeats(const FlowFunction& function, EventPlace event) {
    bool repeated = false;
    walkObject(function, event, [&](EventPlace place) {
        repeated = repeated || place == event;
        return repeated || at(function, place).act == QueryAct::Initialize ? Step::Stop : Step::On;
    });
    return repeated;
}

}  // namespace glint::compiler
