#include "cli/render/report.h"
#include "support/must.h"

#include <gtest/gtest.h>

namespace glint {
namespace {

TEST(OrderCheck, AnyErrorFailsAndIsCounted) {
    cli::RenderReport report;
    report.scene = "room.gltf";
    EXPECT_TRUE(checkOrder(report).ok());
    report.counters.orderErrors = 3;
    const Diagnostic failed = mustFail(checkOrder(report));
    EXPECT_EQ(failed.id, "order-check");
    EXPECT_EQ(failed.severity, Severity::Error);
    EXPECT_EQ(failed.where, "room.gltf");
    EXPECT_EQ(failed.message.substr(0, 7), "3 hits ");
}

}  // namespace
}  // namespace glint
