#include "gltf/document/object_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace glint::gltf {

namespace {

std::array<float, 2> pairAt(const Json& object, std::string_view name, std::array<float, 2> fallback) {
    const Json* member = find(object, name);
    return member == nullptr ? fallback
                             : std::array{static_cast<float>((*member)[0].get<double>()),
                                          static_cast<float>((*member)[1].get<double>())};
}

}  // namespace

std::string ObjectReader::pointerTo(std::string_view member) const {
    return fmt::format("{}/{}", pointer_, member);
}

void ObjectReader::warn(std::string_view member, std::string message, std::string hint) const {
    document_.warn("material-range", pointerTo(member), std::move(message), std::move(hint));
}

Status ObjectReader::texture(std::string_view member, TextureTable& textures,
                             materials::TextureInfo& info) const {
    const Json* json = find(object_, member);
    if (json == nullptr) {
        return okStatus();
    }
    const Json* texCoord = find(*json, "texCoord");
    materials::TextureInfo read;
    if (const Json* transform = findExtension(*json, "KHR_texture_transform")) {
        read.hasTransform = true;
        read.transform.offset = pairAt(*transform, "offset", read.transform.offset);
        read.transform.scale = pairAt(*transform, "scale", read.transform.scale);
        if (const Json* rotation = find(*transform, "rotation")) {
            read.transform.rotation = static_cast<float>(rotation->get<double>());
        }
        if (const Json* override = find(*transform, "texCoord")) {
            texCoord = override;
        }
    }
    read.texCoord = texCoord == nullptr ? 0 : texCoord->get<int>();
    if (read.texCoord > 1) {
        document_.warn("texture-uv-set", pointerTo(member),
                       fmt::format("uses UV set {}; Glint reads sets 0 and 1, and leaves the texture out",
                                   read.texCoord),
                       "move the coordinates to TEXCOORD_0 or TEXCOORD_1");
        info.texCoord = read.texCoord;  // planning says why there is no texture
        return okStatus();
    }
    GLINT_TRY(const auto texture, textures.use((*json)["index"].get<int>()));
    if (texture >= 0) {
        read.texture = texture;
        info = read;
    }
    return okStatus();
}

}  // namespace glint::gltf
