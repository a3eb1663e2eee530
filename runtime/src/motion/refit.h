// BLASes that are built and refitted in place, frame by frame.
#pragma once

#include "motion/motion_rules.h"
#include "scene/acceleration.h"
#include "scene/blas_build.h"

#include <span>
#include <vector>

namespace glint {

class RefittedBlases {
public:
    // Creates structures and scratch, which are not built yet. The geometry of the inputs must stay in place.
    // `pool` must outlive the result.
    static Result<RefittedBlases> create(Context::State& context, MemoryPool& pool,
                                         std::span<const BlasInput> inputs);

    // Records the action for each structure; the first time, all are built. Batches share scratch: a batch
    // that does not fit beside the earlier ones waits for them. No dependency is recorded before the first
    // batch or after the last.
    void record(VkCommandBuffer commands, std::span<const BuildAction> actions) const;

    std::size_t size() const {
        return structures_.size();
    }
    VkDeviceAddress address(std::size_t index) const {
        return structures_[index].address;
    }
    VkDeviceSize bytes() const;
    void addMemory(std::vector<MemoryItem>& items) const;

private:
    explicit RefittedBlases(Context::State& context) : context_(&context) {}

    Context::State* context_;
    Scratch scratch_;
    VkDeviceSize scratchBytes_ = 0;
    std::vector<BlasBuild> builds_;
    std::vector<AccelerationStructure> structures_;
};

}  // namespace glint
