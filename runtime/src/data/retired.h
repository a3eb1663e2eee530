// Resources that are no longer part of a scene, while frames may still use them.
#pragma once

#include "context/resources.h"
#include "data/acceleration.h"

#include <cstdint>
#include <deque>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace glint {

// Resources that are freed together, with the object.
class RetiredLot {
public:
    // Takes a handle, or what has one in its member `handle`. One without a handle changes nothing.
    template <typename Resource>
    void add(Resource&& resource) {
        static_assert(!std::is_reference_v<Resource>, "the lot takes the resource");
        const std::uint64_t bytes = bytesOf(resource);
        if (isThere(resource)) {
            bytes_ += bytes;
            count_ += bytes > 0 ? 1 : 0;
            resources_.push_back(std::make_shared<Resource>(std::forward<Resource>(resource)));
        }
    }
    bool isEmpty() const {
        return resources_.empty();
    }
    std::uint64_t bytes() const {
        return bytes_;
    }
    std::uint32_t count() const {  // of buffers and images
        return count_;
    }

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
    static std::uint64_t bytesOf(const Resource& resource) {
        if constexpr (requires { resource.bytes; }) {
            return resource.bytes;
        } else if constexpr (requires { resource.buffer; }) {
            return resource.buffer.bytes;
        } else {
            return 0;
        }
    }

    std::vector<std::shared_ptr<void>> resources_;
    std::uint64_t bytes_ = 0;
    std::uint32_t count_ = 0;
};

// A retired resource waits for the next recording, whose commands may still use it, and then for its frame.
class Retired {
public:
    template <typename Resource>
    void add(Resource&& resource) {
        open_.add(std::forward<Resource>(resource));
    }
    // Assigns the resources that were added since the last call to this frame.
    void close(std::uint64_t frame) {
        if (!open_.isEmpty()) {
            closed_.emplace_back(frame, take());
        }
    }
    // Returns them instead, to whom knows when the recording is complete.
    RetiredLot take() {
        return std::exchange(open_, {});
    }
    // Frees the resources of frames up to `frame`.
    void complete(std::uint64_t frame) {
        while (!closed_.empty() && closed_.front().first <= frame) {
            closed_.pop_front();
        }
    }
    std::uint64_t bytes() const {
        std::uint64_t sum = open_.bytes();
        for (const auto& [frame, lot] : closed_) {
            sum += lot.bytes();
        }
        return sum;
    }
    std::uint32_t count() const {
        std::uint32_t sum = open_.count();
        for (const auto& [frame, lot] : closed_) {
            sum += lot.count();
        }
        return sum;
    }

private:
    RetiredLot open_;
    std::deque<std::pair<std::uint64_t, RetiredLot>> closed_;  // by ascending frame
};

}  // namespace glint
