// Fuzzes a .gltf file: JSON, with buffers and images as data URIs.
#include "fuzz/fuzz_target.h"
#include "fuzz/import_bytes.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    glint::fuzz::importBytes({data, size}, "scene.gltf");
    return 0;
}
