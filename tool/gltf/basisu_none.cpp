// A build without libktx.
#include "gltf/basisu.h"
#include "gltf/codecs.h"

namespace glint::gltf {

namespace {

bool refuse(ByteView /*bytes*/, Image& /*image*/, std::string& problem) {
    problem = "this Glint was built without libktx";
    return false;
}

}  // namespace

const Codec kBasisu{"KTX2", refuse, refuse};

bool hasBasisu() {
    return false;
}

}  // namespace glint::gltf
