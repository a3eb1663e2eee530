#include "cli/render/report.h"

#include <gtest/gtest.h>

namespace glint {
namespace {

TEST(OrderCheck, AnyErrorFailsAndIsCounted) {
    cli::RenderReport report;
    report.scene = "room.gltf";
    EXPECT_TRUE(checkOrder(report).ok());
    report.counters.orderErrors = 3;
    const Status failed = checkOrder(report);
    ASSERT_FALSE(failed.ok());
    EXPECT_EQ(failed.error().id, "order-check");
    EXPECT_EQ(failed.error().severity, Severity::Error);
    EXPECT_EQ(failed.error().where, "room.gltf");
    EXPECT_EQ(failed.error().message.substr(0, 7), "3 hits ");
}

}  // namespace
}  // namespace glint
