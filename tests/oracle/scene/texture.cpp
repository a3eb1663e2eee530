#include "oracle/scene/texture.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <string_view>

namespace glint::oracle {
namespace {

// IEC 61966-2-1.
double decodeSrgb(double value) {
    return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

int wrapped(std::int64_t texel, int size, gltf::Wrap wrap) {
    const auto modulo = [](std::int64_t value, std::int64_t by) { return ((value % by) + by) % by; };
    switch (wrap) {
        case gltf::Wrap::ClampToEdge:
            return static_cast<int>(std::clamp<std::int64_t>(texel, 0, size - 1));
        case gltf::Wrap::MirroredRepeat: {
            const std::int64_t place = modulo(texel, 2LL * size);
            return static_cast<int>(place < size ? place : 2LL * size - 1 - place);
        }
        case gltf::Wrap::Repeat:
            break;
    }
    return static_cast<int>(modulo(texel, size));
}

class Texels {
public:
    // `srgb` is null if the texels are linear.
    Texels(const gltf::Image& image, const gltf::Sampler& sampler, const SrgbTable* srgb)
        : image_(image), sampler_(sampler), srgb_(srgb) {}

    glm::dvec4 sample(const Vec2& uv) const {
        const Vec2 place = uv * Vec2(image_.width, image_.height);
        if (sampler_.magnification == gltf::Filter::Nearest) {
            return at(std::floor(place.x), std::floor(place.y));
        }
        const Vec2 corner = glm::floor(place - 0.5);
        const Vec2 share = place - 0.5 - corner;
        return glm::mix(glm::mix(at(corner.x, corner.y), at(corner.x + 1.0, corner.y), share.x),
                        glm::mix(at(corner.x, corner.y + 1.0), at(corner.x + 1.0, corner.y + 1.0), share.x),
                        share.y);
    }

private:
    glm::dvec4 at(double x, double y) const {
        const int column = wrapped(static_cast<std::int64_t>(x), image_.width, sampler_.wrapU);
        const int row = wrapped(static_cast<std::int64_t>(y), image_.height, sampler_.wrapV);
        const std::size_t first =
            4 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(image_.width) +
                 static_cast<std::size_t>(column));
        glm::dvec4 texel;
        for (std::size_t channel = 0; channel < 4; ++channel) {
            texel[static_cast<int>(channel)] = value(first + channel, srgb_ != nullptr && channel < 3);
        }
        return texel;
    }
    double value(std::size_t index, bool encoded) const {
        if (image_.format == gltf::PixelFormat::Rgba16) {
            std::uint16_t bits = 0;
            std::memcpy(&bits, image_.pixels.data() + 2 * index, sizeof bits);
            return encoded ? decodeSrgb(bits / 65535.0) : bits / 65535.0;
        }
        const std::uint8_t bits = image_.pixels[index];
        return encoded ? (*srgb_)[bits] : bits / 255.0;
    }

    const gltf::Image& image_;
    const gltf::Sampler& sampler_;
    const SrgbTable* srgb_;
};

}  // namespace

bool isSrgb(const materials::Material& material, std::string_view slot) {
    constexpr std::string_view kColors[] = {"baseColorTexture", "emissiveTexture", "sheenColorTexture",
                                            "specularColorTexture", "diffuseTransmissionColorTexture"};
    return std::ranges::find(kColors, slot) != std::end(kColors) ||
           (slot == "metallicRoughnessTexture" && material.gives("KHR_materials_pbrSpecularGlossiness"));
}

std::optional<Vec2> textureCoordinates(const materials::TextureInfo& info, const SurfacePoint& point) {
    if (info.texture < 0 || info.texCoord > 1) {
        return std::nullopt;
    }
    const std::optional<Vec2>& given = point.texCoords[static_cast<std::size_t>(info.texCoord)];
    if (!given) {
        return std::nullopt;
    }
    return transformed(*given, info.transform) + Vec2(info.transform.offset[0], info.transform.offset[1]);
}

Vec2 transformed(const Vec2& direction, const materials::TextureTransform& transform) {
    const double cosine = std::cos(static_cast<double>(transform.rotation));
    const double sine = std::sin(static_cast<double>(transform.rotation));
    const Vec2 scaled = direction * Vec2(transform.scale[0], transform.scale[1]);
    return {cosine * scaled.x + sine * scaled.y, cosine * scaled.y - sine * scaled.x};
}

SrgbTable exactSrgb() {
    SrgbTable table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
        table[i] = decodeSrgb(static_cast<double>(i) / 255.0);
    }
    return table;
}

std::optional<glm::dvec4> Textures::sample(const materials::Material& material, std::string_view slot,
                                           const SurfacePoint& point) const {
    const materials::TextureInfo& info = material.texture(slot);
    const std::optional<Vec2> uv = textureCoordinates(info, point);
    if (!uv) {
        return std::nullopt;
    }
    const gltf::Texture& texture = scene_.textures[static_cast<std::size_t>(info.texture)];
    return Texels(scene_.images[static_cast<std::size_t>(texture.image)],
                  scene_.samplers[static_cast<std::size_t>(texture.sampler)],
                  isSrgb(material, slot) ? &srgb_ : nullptr)
        .sample(*uv);
}

}  // namespace glint::oracle
