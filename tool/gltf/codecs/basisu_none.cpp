// Replaces basisu.cpp in a build without the sources of Basis Universal.
#include "gltf/codecs/codecs.h"

namespace glint::gltf {

static Diagnostic missing() {
    return imageFault("this Glint was built without the transcoder of Basis Universal");
}

bool hasBasisu() {
    return false;
}

Status decodeBasis(ByteView /*bytes*/, Image& /*image*/) {
    return missing();
}

Result<base::Bytes> transcodeBasis(const BlockFile& /*file*/, ByteView /*bytes*/, TexelFormat /*format*/) {
    return missing();
}

void unpackBc7(const std::uint8_t* /*block*/, BlockTexels& /*texels*/) {}

void unpackAstc(const std::uint8_t* /*block*/, std::uint32_t /*width*/, std::uint32_t /*height*/,
                bool /*srgb*/, std::uint8_t* /*texels*/) {}

void packBlock(TexelFormat /*format*/, const BlockTexels& /*texels*/, const std::array<int, 2>& /*channels*/,
               std::uint8_t* /*block*/) {}

bool unpackZstandard(ByteView /*from*/, std::span<std::uint8_t> /*to*/) {
    return false;
}

}  // namespace glint::gltf
