// A report of the device memory in use, by name.
#pragma once

#include <cstdint>
#include <string>

namespace glint {

// The side that reads and writes a resource's memory.
enum class MemoryUse : std::uint32_t {
    Device,    // read and written by the device
    Upload,    // written by the host, coherent
    Shared,    // written by the host, coherent, and near the device if it has such memory
    Readback,  // read by the host, coherent, cached if the device has such memory
};

// A buffer or an image, or several of the same kind.
struct MemoryItem {
    std::string name;
    MemoryUse use = MemoryUse::Device;
    bool isImage = false;
    std::uint32_t count = 1;
    std::uint64_t bytes = 0;  // of all `count` resources together
};

}  // namespace glint
