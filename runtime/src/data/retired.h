// Resources that are no longer part of a scene, while frames may still use them.
#pragma once

#include "context/resources.h"
#include "data/acceleration.h"

#include <cstdint>
#include <deque>
#include <memory>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace glint {

// Destroys the resource and gives its memory back. A resource without a handle changes nothing.
void discard(MemoryPool& pool, Buffer&& buffer);
void discard(MemoryPool& pool, DeviceImage&& image);
void discard(MemoryPool& pool, AccelerationStructure&& structure);

// Resources that are freed together, with the object. Their pool must outlive it, unless it keeps the pool.
class RetiredLot {
public:
    RetiredLot() = default;
    explicit RetiredLot(MemoryPool& pool) : pool_(&pool) {}
    RetiredLot(RetiredLot&& other) noexcept = default;
    RetiredLot& operator=(RetiredLot&& other) noexcept;
    RetiredLot(const RetiredLot&) = delete;
    RetiredLot& operator=(const RetiredLot&) = delete;
    ~RetiredLot();

    // Takes a resource of one of the kinds below. One without a handle changes nothing.
    template <typename Resource>
    void add(Resource&& resource) {
        if (isThere(resource)) {
            std::get<std::vector<std::remove_cvref_t<Resource>>>(kinds_).push_back(
                std::forward<Resource>(resource));
        }
    }
    // Lets the lot outlive everything else that uses its pool.
    void keep(std::shared_ptr<MemoryPool> pool) {
        owner_ = std::move(pool);
    }
    bool isEmpty() const;
    std::uint64_t bytes() const;
    std::uint32_t count() const;  // of buffers and images

private:
    template <typename Resource>
    static bool isThere(const Resource& resource) {
        if constexpr (requires { resource.handle; }) {
            return isThere(resource.handle);
        } else {
            return resource.get() != VK_NULL_HANDLE;
        }
    }
    template <typename Resource>
    const std::vector<Resource>& all() const {
        return std::get<std::vector<Resource>>(kinds_);
    }
    void free();

    std::shared_ptr<MemoryPool> owner_;  // may be null; destroyed last
    MemoryPool* pool_ = nullptr;
    // In the order in which they are destroyed.
    std::tuple<std::vector<UniqueImageView>, std::vector<UniqueDescriptorPool>,
               std::vector<AccelerationStructure>, std::vector<Buffer>, std::vector<DeviceImage>>
        kinds_;
};

// A retired resource waits for the next recording, whose commands may still use it, and then for its frame.
class Retired {
public:
    explicit Retired(MemoryPool& pool) : pool_(pool), open_(pool) {}

    template <typename Resource>
    void add(Resource&& resource) {
        open_.add(std::forward<Resource>(resource));
    }
    // Assigns the resources that were added since the last call to this frame.
    void close(std::uint64_t frame);
    // Returns them instead, to whom knows when the recording is complete.
    RetiredLot take();
    // Frees the resources of frames up to `frame`.
    void complete(std::uint64_t frame);
    std::uint64_t bytes() const;
    std::uint32_t count() const;

private:
    MemoryPool& pool_;
    RetiredLot open_;
    std::deque<std::pair<std::uint64_t, RetiredLot>> closed_;  // by ascending frame
};

}  // namespace glint
