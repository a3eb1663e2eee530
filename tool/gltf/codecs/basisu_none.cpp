// Replaces basisu.cpp in a build without the sources of Basis Universal.
#include "gltf/codecs/basisu.h"

namespace glint::gltf {

namespace {

constexpr const char* kMissing = "this Glint was built without the transcoder of Basis Universal";

}  // namespace

bool hasBasisu() {
    return false;
}

bool decodeBasis(ByteView /*bytes*/, Image& /*image*/, std::string& problem) {
    problem = kMissing;
    return false;
}

std::optional<std::vector<std::uint8_t>> transcodeBasis(const BlockFile& /*file*/, ByteView /*bytes*/,
                                                        TexelFormat /*format*/, std::string& problem) {
    problem = kMissing;
    return std::nullopt;
}

bool unpackBc7(const std::uint8_t* /*block*/, BlockTexels& /*texels*/) {
    return false;
}

bool unpackAstc(const std::uint8_t* /*block*/, std::uint32_t /*width*/, std::uint32_t /*height*/,
                bool /*srgb*/, std::uint8_t* /*texels*/) {
    return false;
}

bool packBlock(TexelFormat /*format*/, const BlockTexels& /*texels*/, const std::array<int, 2>& /*channels*/,
               std::uint8_t* /*block*/) {
    return false;
}

bool unpackZstandard(ByteView /*from*/, std::span<std::uint8_t> /*to*/) {
    return false;
}

}  // namespace glint::gltf
