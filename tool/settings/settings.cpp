#include "settings/settings.h"

#include "base/image_limits.h"

#include <charconv>

namespace glint::compiler {

namespace {

// Parses all of `text`, which may begin with a plus sign.
template <typename Number>
bool parseNumber(std::string_view text, Number& value) {
    const char* const begin = text.data() + (text.starts_with('+') ? 1 : 0);
    const char* const end = text.data() + text.size();
    const auto parsed = std::from_chars(begin, end, value);
    return parsed.ec == std::errc() && parsed.ptr == end;
}

}  // namespace

Settings::Settings() {
    compile.effects = {true, 0};
    renderer.width = 960;
    renderer.height = 540;
}

materials::FeatureMask baseLobes() {
    const materials::MaterialModel& model = materials::builtinMaterialModel();
    materials::FeatureMask mask = model.bases;
    for (const materials::Feature& feature : model.features) {
        mask |= feature.isOfBase ? feature.mask() : 0;
    }
    return mask;
}

bool parseReal(std::string_view text, double min, double max, double& value) {
    return parseNumber(text, value) && value >= min && value <= max;
}

bool parseWhole(std::string_view text, std::int64_t min, std::int64_t max, std::int64_t& value) {
    return parseNumber(text, value) && value >= min && value <= max;
}

bool parseSize(std::string_view text, std::uint32_t& width, std::uint32_t& height) {
    const std::size_t cross = text.find('x');
    return cross != std::string_view::npos && parseNumber(text.substr(0, cross), width) &&
           parseNumber(text.substr(cross + 1), height) && width >= 1 && width <= base::kMaxImageSize &&
           height >= 1 && height <= base::kMaxImageSize &&
           std::int64_t{width} * height <= base::kMaxImagePixels;
}

std::optional<MergeChoice> parseMerge(std::string_view text) {
    const std::size_t colon = text.find(':');
    const std::optional<MergePolicy> policy = valueNamed<MergePolicy>(text.substr(0, colon));
    if (colon == std::string_view::npos) {
        return policy ? std::optional(MergeChoice{*policy, {}}) : std::nullopt;
    }
    const std::string_view file = text.substr(colon + 1);
    return policy && takesHits(*policy) && !file.empty() ? std::optional(MergeChoice{*policy, file})
                                                         : std::nullopt;
}

}  // namespace glint::compiler
