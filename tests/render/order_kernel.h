// Runs the ordering passes of a package over given hits: the product's modules, for any number of cases.
#pragma once

#include "context/commands.h"
#include "emit/compile.h"
#include "interop/frame.h"

#include <glint/context.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace glint::testing {

struct OrderProblem {
    std::vector<std::uint32_t> shaderIds;  // by geometry
    std::vector<std::uint32_t> hits;       // the geometry that each ray hit, or gpu::kMissGeometry
    std::uint32_t alignment = 1;
};

// A word that is overwritten between the copy and the check.
struct OrderFault {
    enum class Where { Slots, Counts, Begins, Cursors };
    Where where = Where::Slots;
    std::size_t word = 0;
    std::uint32_t value = 0;
};

struct OrderResult {
    std::vector<std::uint32_t> counts;  // by bucket, as are the following
    std::vector<std::uint32_t> begins;
    std::vector<std::uint32_t> cursors;
    std::vector<gpu::DispatchArguments> dispatches;  // by bucket, then over all slots
    std::vector<std::uint32_t> slots;                // as many as there is room for
    std::uint32_t errors = 0;                        // that the check found
};

// Device times in milliseconds.
struct OrderTime {
    double count = 0.0;
    double offset = 0.0;  // 0 where there is no such pass
    double copy = 0.0;
    double total = 0.0;  // all of them, with nothing between that takes the time of one
};

struct OrderBuffers;

class OrderKernel {
public:
    // `context` must outlive the kernel. Errors: those of compileModules(), "vulkan-call".
    static Result<std::unique_ptr<OrderKernel>> create(Context& context, std::uint32_t caseCount,
                                                       package::HitRecordFormat hitRecord);

    ~OrderKernel();
    OrderKernel(const OrderKernel&) = delete;
    OrderKernel& operator=(const OrderKernel&) = delete;

    // Loads the problem that run() orders, until the next call.
    Status load(const OrderProblem& problem);
    // Slots without a hit are kNoHit.
    Result<OrderResult> run(package::Ordering ordering, std::span<const OrderFault> faults = {});

    // Loads the same problem several times, for times(), so that caches do not keep what the previous run
    // read. Records of the hits are left out, because only the check reads them.
    Status loadForTimes(const OrderProblem& problem, std::uint32_t copies);
    // Runs each of the copies, and then each again as a whole. Errors: "timings-unavailable".
    Result<std::vector<OrderTime>> times(package::Ordering ordering);
    // Returns the device time in milliseconds of copying as many words as there are hits from one of the
    // copies to the next, by a shader that moves 16 bytes in each thread. The vkCmdCopyBuffer() of some
    // drivers is slower than that.
    Result<std::vector<double>> copyTimes();
    // Returns the result of the last call of times(); errors are not counted.
    Result<OrderResult> result();

private:
    // The numbers of the timer's stretches.
    static constexpr std::uint32_t kMaxCopies = 8;
    static constexpr std::uint32_t kTimesOfRun = 4;

    OrderKernel(Context::State& context, std::uint32_t caseCount, package::HitRecordFormat hitRecord);
    Status createPipelines();
    void recordStart(VkCommandBuffer commands, const OrderBuffers& buffers) const;
    void recordPasses(VkCommandBuffer commands, package::Ordering ordering, const OrderBuffers& buffers,
                      const std::function<void(std::uint32_t pass)>& between) const;
    void recordCheck(VkCommandBuffer commands, const OrderBuffers& buffers,
                     std::span<const OrderFault> faults) const;
    void bind(VkCommandBuffer commands, package::ModuleKey key) const;
    void wait(VkCommandBuffer commands) const;
    Result<std::vector<double>> readTimes(std::uint32_t count) const;

    Context::State& context_;
    std::uint32_t caseCount_;
    package::HitRecordFormat hitRecord_;
    UniquePipelineLayout layout_;
    std::map<package::ModuleKey, UniquePipeline> pipelines_;
    UniquePipeline plainCopy_;
    std::optional<Timer> timer_;
    std::optional<CommandRunner> runner_;
    std::vector<std::unique_ptr<OrderBuffers>> buffers_;
};

}  // namespace glint::testing
