#include "data/retired.h"

#include <utility>

namespace glint {
namespace {

// The assignment destroys the handles, before the memory is given back.
template <typename Resource>
void destroy(MemoryPool& pool, Resource& resource) {
    if (resource.handle.get() != VK_NULL_HANDLE) {
        const Allocation memory = resource.memory;
        resource = {};
        pool.release(memory);
    }
}

}  // namespace

void discard(MemoryPool& pool, Buffer&& buffer) {
    destroy(pool, buffer);
}

void discard(MemoryPool& pool, DeviceImage&& image) {
    image.view = {};
    destroy(pool, image);
}

void discard(MemoryPool& pool, AccelerationStructure&& structure) {
    structure.handle = {};
    destroy(pool, structure.buffer);
}

bool Retired::Lot::isEmpty() const {
    return structures.empty() && buffers.empty() && images.empty() && descriptors.empty() && views.empty();
}

std::uint64_t Retired::Lot::bytes() const {
    std::uint64_t sum = 0;
    for (const AccelerationStructure& structure : structures) {
        sum += structure.buffer.bytes;
    }
    for (const Buffer& buffer : buffers) {
        sum += buffer.bytes;
    }
    for (const DeviceImage& image : images) {
        sum += image.bytes;
    }
    return sum;
}

void Retired::add(Buffer&& buffer) {
    if (buffer.handle.get() != VK_NULL_HANDLE) {
        open_.buffers.push_back(std::move(buffer));
    }
}

void Retired::add(DeviceImage&& image) {
    if (image.handle.get() != VK_NULL_HANDLE) {
        open_.images.push_back(std::move(image));
    }
}

void Retired::add(AccelerationStructure&& structure) {
    if (structure.handle.get() != VK_NULL_HANDLE) {
        open_.structures.push_back(std::move(structure));
    }
}

void Retired::add(UniqueDescriptorPool&& descriptors) {
    if (descriptors.get() != VK_NULL_HANDLE) {
        open_.descriptors.push_back(std::move(descriptors));
    }
}

void Retired::add(UniqueImageView&& view) {
    if (view.get() != VK_NULL_HANDLE) {
        open_.views.push_back(std::move(view));
    }
}

void Retired::close(std::uint64_t frame) {
    if (!open_.isEmpty()) {
        open_.frame = frame;
        closed_.push_back(std::exchange(open_, {}));
    }
}

void Retired::complete(std::uint64_t frame) {
    while (!closed_.empty() && closed_.front().frame <= frame) {
        Lot& lot = closed_.front();
        lot.views.clear();
        for (AccelerationStructure& structure : lot.structures) {
            discard(pool_, std::move(structure));
        }
        for (Buffer& buffer : lot.buffers) {
            discard(pool_, std::move(buffer));
        }
        for (DeviceImage& image : lot.images) {
            discard(pool_, std::move(image));
        }
        closed_.pop_front();
    }
}

std::uint32_t Retired::count() const {
    const auto of = [](const Lot& lot) {
        return static_cast<std::uint32_t>(lot.structures.size() + lot.buffers.size() + lot.images.size());
    };
    std::uint32_t sum = of(open_);
    for (const Lot& lot : closed_) {
        sum += of(lot);
    }
    return sum;
}

std::uint64_t Retired::bytes() const {
    std::uint64_t sum = open_.bytes();
    for (const Lot& lot : closed_) {
        sum += lot.bytes();
    }
    return sum;
}

}  // namespace glint
