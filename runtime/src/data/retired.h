// Resources that are no longer part of a scene, while frames may still use them.
#pragma once

#include "context/resources.h"
#include "data/acceleration.h"

#include <cstdint>
#include <deque>
#include <vector>

namespace glint {

// Destroys the resource and gives its memory back. A resource without a handle changes nothing.
void discard(MemoryPool& pool, Buffer&& buffer);
void discard(MemoryPool& pool, DeviceImage&& image);
void discard(MemoryPool& pool, AccelerationStructure&& structure);

// A retired resource waits for the next recording, whose commands may still use it, and then for its frame.
class Retired {
public:
    explicit Retired(MemoryPool& pool) : pool_(pool) {}

    void add(Buffer&& buffer);
    void add(DeviceImage&& image);
    void add(AccelerationStructure&& structure);
    void add(UniqueDescriptorPool&& descriptors);
    void add(UniqueImageView&& view);
    // Assigns the resources that were added since the last call to this frame.
    void close(std::uint64_t frame);
    // Frees the resources of frames up to `frame`.
    void complete(std::uint64_t frame);
    std::uint64_t bytes() const;
    std::uint32_t count() const;  // of buffers and images

private:
    struct Lot {
        std::uint64_t frame = 0;
        std::vector<AccelerationStructure> structures;
        std::vector<Buffer> buffers;
        std::vector<DeviceImage> images;
        std::vector<UniqueDescriptorPool> descriptors;
        std::vector<UniqueImageView> views;

        bool isEmpty() const;
        std::uint64_t bytes() const;
    };
    MemoryPool& pool_;
    Lot open_;
    std::deque<Lot> closed_;  // by ascending frame
};

}  // namespace glint
