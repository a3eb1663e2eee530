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
    kinds_ = std::move(other.kinds_);
    return *this;
}

RetiredLot::~RetiredLot() {
    free();
}

void RetiredLot::free() {
    const auto freeAll = [&](auto& resources) {
        for (auto& resource : resources) {
            if constexpr (requires { discard(*pool_, std::move(resource)); }) {
                discard(*pool_, std::move(resource));
            }
        }
        resources.clear();
    };
    std::apply([&](auto&... resources) { (freeAll(resources), ...); }, kinds_);
}

bool RetiredLot::isEmpty() const {
    return std::apply([](const auto&... resources) { return (resources.empty() && ...); }, kinds_);
}

std::uint64_t RetiredLot::bytes() const {
    std::uint64_t sum = 0;
    for (const AccelerationStructure& structure : all<AccelerationStructure>()) {
        sum += structure.buffer.bytes;
    }
    for (const Buffer& buffer : all<Buffer>()) {
        sum += buffer.bytes;
    }
    for (const DeviceImage& image : all<DeviceImage>()) {
        sum += image.bytes;
    }
    return sum;
}

std::uint32_t RetiredLot::count() const {
    return static_cast<std::uint32_t>(all<AccelerationStructure>().size() + all<Buffer>().size() +
                                      all<DeviceImage>().size());
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
