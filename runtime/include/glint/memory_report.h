// What is in device memory, by name.
#pragma once

#include <cstdint>
#include <string>

namespace glint {

// Where a resource lives.
enum class MemoryUse : std::uint32_t {
    Device,    // read and written by the device
    Upload,    // written by the host, coherent
    Readback,  // read by the host, coherent, cached where there is such memory
};

// A buffer or image, or several that are alike.
struct MemoryItem {
    std::string name;
    MemoryUse use = MemoryUse::Device;
    bool isImage = false;
    std::uint32_t count = 1;
    std::uint64_t bytes = 0;  // of all of them
};

}  // namespace glint
