#include "gltf/codecs/codecs.h"

#include <string_view>

namespace glint::gltf {

namespace {

std::string_view textOf(ByteView bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

bool isWebp(std::string_view text) {
    return text.size() >= 12 && text.starts_with("RIFF") && text.substr(8).starts_with("WEBP");
}

}  // namespace

const Codec* findCodec(ByteView bytes) {
    const std::string_view text = textOf(bytes);
    if (text.starts_with("\x89PNG")) {
        return &kPng;
    }
    if (text.starts_with("\xFF\xD8")) {
        return &kJpeg;
    }
    if (isWebp(text)) {
        return &kWebp;
    }
    if (text.starts_with("DDS ")) {
        return &kDds;
    }
    return text.starts_with("\xABKTX 20\xBB") ? &kBasisu : nullptr;
}

const char* foreignFormat(ByteView bytes) {
    const std::string_view text = textOf(bytes);
    if (text.starts_with("\xABKTX")) {
        return "KTX 1";
    }
    return text.size() >= 12 && text.substr(4).starts_with("ftypavif") ? "AVIF" : "";
}

}  // namespace glint::gltf
