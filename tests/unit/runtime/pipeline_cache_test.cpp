// Tests that data which a driver stored for pipelines is told from anything else before the driver gets it.
#include "context/context.h"
#include "device_fixture.h"
#include "support/must.h"

#include <algorithm>
#include <cstring>

namespace glint::test {
namespace {

constexpr PipelineCacheOwner kOwner{0x10DE, 0x2335, 4, 0x8B410000, {1, 2, 3, 4, 5, 6, 7, 8}};

std::vector<std::uint8_t> driverData(const PipelineCacheOwner& owner) {
    VkPipelineCacheHeaderVersionOne header{};
    header.headerSize = sizeof(header);
    header.headerVersion = VK_PIPELINE_CACHE_HEADER_VERSION_ONE;
    header.vendorID = owner.vendorId;
    header.deviceID = owner.deviceId;
    std::memcpy(header.pipelineCacheUUID, owner.cacheUuid.data(), VK_UUID_SIZE);
    std::vector<std::uint8_t> data(sizeof(header) + 100, 0xA5);
    std::memcpy(data.data(), &header, sizeof(header));
    return data;
}

std::string idOf(const PipelineCacheOwner& owner, std::span<const std::uint8_t> bytes) {
    const auto data = unwrapPipelineCache(owner, bytes);
    return data ? "" : data.error().id;
}

TEST(PipelineCacheWrapping, GivesBackWhatItWasGiven) {
    const std::vector<std::uint8_t> data = driverData(kOwner);
    const std::vector<std::uint8_t> wrapped = wrapPipelineCache(kOwner, data);
    const auto found = must(unwrapPipelineCache(kOwner, wrapped));
    EXPECT_TRUE(std::ranges::equal(found, data));
}

TEST(PipelineCacheWrapping, RefusesEveryLengthButTheWhole) {
    std::vector<std::uint8_t> wrapped = wrapPipelineCache(kOwner, driverData(kOwner));
    for (std::size_t bytes = 0; bytes < wrapped.size(); ++bytes) {
        EXPECT_EQ(idOf(kOwner, std::span(wrapped).first(bytes)), "pipeline-cache") << bytes;
    }
    wrapped.push_back(0);
    EXPECT_EQ(idOf(kOwner, wrapped), "pipeline-cache");
}

TEST(PipelineCacheWrapping, RefusesAChangeOfAnyByte) {
    std::vector<std::uint8_t> wrapped = wrapPipelineCache(kOwner, driverData(kOwner));
    for (std::uint8_t& byte : wrapped) {
        byte ^= 0x10U;
        EXPECT_EQ(idOf(kOwner, wrapped), "pipeline-cache") << &byte - wrapped.data();
        byte ^= 0x10U;
    }
    EXPECT_EQ(idOf(kOwner, wrapped), "");
}

TEST(PipelineCacheWrapping, RefusesEveryOtherOwner) {
    const std::vector<std::uint8_t> wrapped = wrapPipelineCache(kOwner, driverData(kOwner));
    std::vector<PipelineCacheOwner> others(5, kOwner);
    ++others[0].vendorId;
    ++others[1].deviceId;
    ++others[2].driverId;
    ++others[3].driverVersion;
    ++others[4].cacheUuid[15];
    for (const PipelineCacheOwner& other : others) {
        EXPECT_EQ(idOf(other, wrapped), "pipeline-cache") << nameOf(other);
        EXPECT_NE(nameOf(other), nameOf(kOwner));
    }
}

// The driver writes a header that is not its own, or none.
TEST(PipelineCacheWrapping, RefusesDataWithoutVulkansHeader) {
    const std::vector<std::uint8_t> data = driverData(kOwner);
    for (const std::size_t at : {0U, 4U, 8U, 12U, 16U, 31U}) {
        std::vector<std::uint8_t> changed = data;
        changed[at] ^= 0x80U;
        EXPECT_EQ(idOf(kOwner, wrapPipelineCache(kOwner, changed)), "pipeline-cache") << at;
    }
    EXPECT_EQ(idOf(kOwner, wrapPipelineCache(kOwner, {})), "pipeline-cache");
    EXPECT_EQ(idOf(kOwner, wrapPipelineCache(kOwner, std::span(data).first(31))), "pipeline-cache");
    EXPECT_EQ(idOf(kOwner, wrapPipelineCache(kOwner, std::span(data).first(32))), "");
}

using PipelineCacheOfDevice = DeviceTest;

TEST_F(PipelineCacheOfDevice, IsTakenByTheDeviceThatGaveIt) {
    const auto data = must(context().pipelineCacheData());
    HeadlessOptions options;
    options.validation = Validation::On;
    auto other = must(Context::createHeadless(options));
    EXPECT_EQ(other->pipelineCacheName(), context().pipelineCacheName());
    const Status added = other->addPipelineCache(data);
    EXPECT_TRUE(added) << toString(added.error());
    // It continues with the data that it has now.
    const auto again = must(other->pipelineCacheData());
    EXPECT_TRUE(other->addPipelineCache(again));
    EXPECT_EQ(other->validationMessages(), std::vector<std::string>());
}

TEST_F(PipelineCacheOfDevice, IsAsItWasAfterARefusal) {
    auto data = must(context().pipelineCacheData());
    const VkPipelineCache before = context().state().pipelineCache;
    data.back() ^= 1U;
    EXPECT_EQ(mustFail(context().addPipelineCache(data)).id, "pipeline-cache");
    EXPECT_EQ(context().state().pipelineCache, before);
}

}  // namespace
}  // namespace glint::test
