// Fuzzes a .glb file.
#include "fuzz/fuzz_target.h"
#include "fuzz/import_bytes.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    glint::fuzz::importBytes({data, size}, "scene.glb");
    return 0;
}
