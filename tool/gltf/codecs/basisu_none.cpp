// Replaces basisu.cpp in a build without the transcoder of Basis Universal.
#include "gltf/codecs/basisu.h"
#include "gltf/codecs/codecs.h"
#include "gltf/codecs/ktx2.h"

namespace glint::gltf {

namespace {

bool refuse(ByteView /*bytes*/, Image& /*image*/, std::string& problem) {
    problem = "this Glint was built without the transcoder of Basis Universal";
    return false;
}

}  // namespace

const Codec kBasisu{"KTX2", readKtx2Header, refuse};

bool hasBasisu() {
    return false;
}

}  // namespace glint::gltf
