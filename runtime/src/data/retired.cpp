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

RetiredLot& RetiredLot::operator=(RetiredLot&& other) noexcept {
    free();
    pool_ = other.pool_;
    owner_ = std::move(other.owner_);
    structures_ = std::move(other.structures_);
    buffers_ = std::move(other.buffers_);
    images_ = std::move(other.images_);
    descriptors_ = std::move(other.descriptors_);
    views_ = std::move(other.views_);
    return *this;
}

RetiredLot::~RetiredLot() {
    free();
}

void RetiredLot::free() {
    views_.clear();
    descriptors_.clear();
    for (AccelerationStructure& structure : structures_) {
        discard(*pool_, std::move(structure));
    }
    for (Buffer& buffer : buffers_) {
        discard(*pool_, std::move(buffer));
    }
    for (DeviceImage& image : images_) {
        discard(*pool_, std::move(image));
    }
    structures_.clear();
    buffers_.clear();
    images_.clear();
}

void RetiredLot::add(Buffer&& buffer) {
    if (buffer.handle.get() != VK_NULL_HANDLE) {
        buffers_.push_back(std::move(buffer));
    }
}

void RetiredLot::add(DeviceImage&& image) {
    if (image.handle.get() != VK_NULL_HANDLE) {
        images_.push_back(std::move(image));
    }
}

void RetiredLot::add(AccelerationStructure&& structure) {
    if (structure.handle.get() != VK_NULL_HANDLE) {
        structures_.push_back(std::move(structure));
    }
}

void RetiredLot::add(UniqueDescriptorPool&& descriptors) {
    if (descriptors.get() != VK_NULL_HANDLE) {
        descriptors_.push_back(std::move(descriptors));
    }
}

void RetiredLot::add(UniqueImageView&& view) {
    if (view.get() != VK_NULL_HANDLE) {
        views_.push_back(std::move(view));
    }
}

bool RetiredLot::isEmpty() const {
    return structures_.empty() && buffers_.empty() && images_.empty() && descriptors_.empty() &&
           views_.empty();
}

std::uint64_t RetiredLot::bytes() const {
    std::uint64_t sum = 0;
    for (const AccelerationStructure& structure : structures_) {
        sum += structure.buffer.bytes;
    }
    for (const Buffer& buffer : buffers_) {
        sum += buffer.bytes;
    }
    for (const DeviceImage& image : images_) {
        sum += image.bytes;
    }
    return sum;
}

std::uint32_t RetiredLot::count() const {
    return static_cast<std::uint32_t>(structures_.size() + buffers_.size() + images_.size());
}

void Retired::close(std::uint64_t frame) {
    if (!open_.isEmpty()) {
        closed_.emplace_back(frame, take());
    }
}

RetiredLot Retired::take() {
    return std::exchange(open_, RetiredLot(pool_));
}

void Retired::complete(std::uint64_t frame) {
    while (!closed_.empty() && closed_.front().first <= frame) {
        closed_.pop_front();
    }
}

std::uint64_t Retired::bytes() const {
    std::uint64_t sum = open_.bytes();
    for (const auto& [frame, lot] : closed_) {
        sum += lot.bytes();
    }
    return sum;
}

std::uint32_t Retired::count() const {
    std::uint32_t sum = open_.count();
    for (const auto& [frame, lot] : closed_) {
        sum += lot.count();
    }
    return sum;
}

}  // namespace glint
