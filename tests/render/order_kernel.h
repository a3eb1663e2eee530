// Runs the ordering passes of a package over given hits: the product's modules, for any number of cases.
#pragma once

#include "commands.h"
#include "emit/compile.h"
#include "interop/frame.h"
#include "timer.h"

#include <glint/context.h>

#include <cstdint>
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
    enum class Where { Slots, Buckets };
    Where where = Where::Slots;
    std::size_t word = 0;
    std::uint32_t value = 0;
};

struct OrderResult {
    std::vector<gpu::BucketRecord> buckets;
    std::vector<gpu::DispatchArguments> dispatches;  // by bucket, then over all slots
    std::vector<std::uint32_t> slots;                // as many as there is room for
    std::uint32_t errors = 0;                        // that the check found
    double countMs = 0.0;                            // device time; 0 where the device tells none
    double offsetMs = 0.0;
    double copyMs = 0.0;
};

class OrderKernel {
public:
    // `context` must outlive the kernel. Errors: those of compileModules(), "vulkan-call".
    static Result<std::unique_ptr<OrderKernel>> create(Context& context, std::uint32_t caseCount,
                                                       package::HitRecordFormat hitRecord);

    ~OrderKernel();
    OrderKernel(const OrderKernel&) = delete;
    OrderKernel& operator=(const OrderKernel&) = delete;

    // What run() puts in order, until the next call.
    Status load(const OrderProblem& problem);
    // Slots that hold no hit are kNoHit.
    Result<OrderResult> run(package::Ordering ordering, std::span<const OrderFault> faults = {});

private:
    struct Buffers;
    static constexpr std::uint32_t kTimes = 3;  // stretches of the timer: count, offset, copy

    OrderKernel(Context::State& context, std::uint32_t caseCount, package::HitRecordFormat hitRecord);
    Status createPipelines();
    Status createBuffers(const OrderProblem& problem, Buffers& buffers) const;
    void recordPasses(VkCommandBuffer commands, package::Ordering ordering, const Buffers& buffers,
                      std::span<const OrderFault> faults) const;
    void recordInput(VkCommandBuffer commands, const Buffers& buffers) const;
    void recordOutput(VkCommandBuffer commands, const Buffers& buffers) const;
    OrderResult readResult(const Buffers& buffers) const;
    void bind(VkCommandBuffer commands, package::ModuleKey key) const;

    Context::State& context_;
    std::uint32_t caseCount_;
    package::HitRecordFormat hitRecord_;
    UniquePipelineLayout layout_;
    std::map<package::ModuleKey, UniquePipeline> pipelines_;
    std::optional<Timer> timer_;
    std::optional<CommandRunner> runner_;
    std::unique_ptr<Buffers> buffers_;
};

}  // namespace glint::testing
