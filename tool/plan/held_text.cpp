#include "plan/held_text.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

namespace glint::compiler {

namespace {

// Texels of the finest level need no word about their level.
std::string placeText(const materials::TexelPlace& place) {
    return place.level == 0 ? fmt::format("({}, {})", place.x, place.y)
                            : fmt::format("({}, {}) of level {}", place.x, place.y, place.level);
}

std::string channelText(const std::string& name, const materials::TextureContent& content,
                        std::size_t channel) {
    const materials::ValueInterval held = content.of[channel];
    if (held.isExact() || !std::isnan(content.constant[channel])) {
        const double number = held.isExact() ? held.low : content.constant[channel];
        return fmt::format("{}.{} is {:.3g}{}", name, "rgba"[channel], number,
                           content.image.empty() ? "" : " in " + content.image);
    }
    std::string text = fmt::format("{}.{} is {:.3g} to {:.3g}", name, "rgba"[channel], held.low, held.high);
    const materials::TexelPlace& least = content.leastAt[channel];
    const materials::TexelPlace& greatest = content.greatestAt[channel];
    if (least.level >= 0 && greatest.level >= 0) {
        text +=
            fmt::format(", at texels {} and {} of {}", placeText(least), placeText(greatest), content.image);
    }
    return text;
}

bool isKnown(const materials::TextureContent& content, std::size_t channel) {
    return content.of[channel] != materials::kUnitInterval || !content.image.empty();
}

}  // namespace

std::string heldText(const materials::Material& material, const materials::PrimitiveInputs& primitive,
                     int texture, std::uint32_t channels) {
    const std::string& name = material.model().textures[static_cast<std::size_t>(texture)].name;
    const materials::TextureContent& content = contentOf(material, primitive, texture);
    std::string text;
    for (std::size_t i = 0; i < 4; ++i) {
        if ((channels >> i & 1U) != 0 && isKnown(content, i)) {
            text += (text.empty() ? "" : "; ") + channelText(name, content, i);
        }
    }
    return text;
}

std::string whatTexturesHold(const materials::Material& material, const materials::PrimitiveInputs& primitive,
                             const materials::Expression& when, HeldBy which) {
    const materials::MaterialModel& model = material.model();
    const auto isRead = [&](int texture) {
        return material.textures[static_cast<std::size_t>(texture)].isFolded ||
               (which == HeldBy::All && isReadable(material, primitive, texture));
    };
    std::map<int, std::uint32_t> channels;  // by texture
    for (const int symbol : when.symbols()) {
        const int texel = symbol - model.symbolOfTexel(0);
        if (texel >= 0 && texel < static_cast<int>(model.textures.size())) {
            channels[texel] |= isRead(texel) ? material.readsOf(texel).channels : 0;
            continue;
        }
        if (symbol < 0 || symbol >= static_cast<int>(model.parameters.size())) {
            continue;
        }
        const materials::Parameter& parameter = model.parameters[static_cast<std::size_t>(symbol)];
        if (parameter.scaledBy < 0 || !isRead(parameter.scaledBy)) {
            continue;
        }
        for (int i = 0; i < parameter.channels; ++i) {
            const int channel = parameter.scaledByChannels[static_cast<std::size_t>(i)];
            channels[parameter.scaledBy] |= channel >= 0 ? 1U << static_cast<unsigned>(channel) : 0U;
        }
    }
    std::string text;
    for (const auto& [texture, read] : channels) {
        const std::string held = heldText(material, primitive, texture, read);
        text += (text.empty() || held.empty() ? "" : "; ") + held;
    }
    return text;
}

}  // namespace glint::compiler
