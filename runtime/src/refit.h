// Bottom levels that are built and refitted in place, frame by frame.
#pragma once

#include "acceleration.h"
#include "blas_build.h"
#include "motion_rules.h"

#include <span>
#include <vector>

namespace glint {

class RefittedBlases {
public:
    // Structures and scratch, not yet built. The inputs' geometry stays where it is. `pool` must outlive the
    // result.
    static Result<RefittedBlases> create(Context::State& context, MemoryPool& pool,
                                         std::span<const BlasInput> inputs);

    // Records what is to be done with each; the first time, all are built. Scratch is shared: batches that it
    // has no room for wait for those before. No dependency is recorded before the first or after the last.
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
