#include "render/ways.h"

#include "support/nightly.h"

#include <gtest/gtest.h>

namespace glint::testing {

namespace {

// Returns the strategies (bits) that forEachWay() renders with the tracer. A strategy whose turn falls on a
// tracer that it or the device lacks takes the other one.
std::uint32_t strategiesWith(package::Tracer tracer) {
    const std::uint32_t tracers = sharedContext().handles().tracers;
    std::uint32_t strategies = 0;
    std::size_t turn = 0;
    for (const package::Strategy strategy : package::strategies()) {
        const package::Tracer own = package::kTracers[turn++ % std::size(package::kTracers)];
        const bool takesOwn = (package::tracersOf(strategy, own) & own & tracers) != 0;
        const bool takes = (package::tracersOf(strategy, tracer) & tracer) != 0;
        if (takes && (test::nightly() || tracer == own || !takesOwn)) {
            strategies |= strategy;
        }
    }
    return strategies;
}

}  // namespace

std::string nameOf(const Way& way) {
    return std::string(package::nameOf(way.strategy)) + " with " + std::string(package::nameOf(way.tracer));
}

RendererOptions optionsOf(const Way& way) {
    RendererOptions options;
    options.strategy = way.strategy;
    options.tracer = way.tracer;
    options.checkOrder = true;
    return options;
}

std::vector<Way> waysOf(std::uint32_t strategies, std::uint32_t tracers) {
    std::vector<Way> ways;
    for (const package::Strategy strategy : package::strategies()) {
        for (const package::Tracer tracer : package::kTracers) {
            const bool has = (sharedContext().handles().tracers & tracer) != 0;
            if (has && (strategies & strategy) != 0 &&
                (package::tracersOf(strategy, tracers) & tracer) != 0) {
                ways.push_back({strategy, tracer});
            }
        }
    }
    return ways;
}

void forEachWay(const gltf::Scene& scene, compiler::CompileSettings settings,
                const std::function<void(const LoadedScene&, const Way&)>& visit,
                const std::function<void(session::SceneViewData&)>& change) {
    for (const package::Tracer tracer : package::kTracers) {
        settings.tracers = tracer;
        settings.strategies = strategiesWith(tracer);
        const std::vector<Way> ways = waysOf(settings.strategies, tracer);
        if (ways.empty()) {
            continue;
        }
        const LoadedScene loaded(scene, settings, change);
        for (const Way& way : ways) {
            SCOPED_TRACE(nameOf(way));
            visit(loaded, way);
        }
    }
}

}  // namespace glint::testing
