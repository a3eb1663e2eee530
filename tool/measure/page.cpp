#include "measure/page.h"

#include <kainjow/mustache.hpp>

#include <algorithm>
#include <cstdint>
#include <string_view>

namespace glint::measure {

namespace {

using Json = nlohmann::ordered_json;

// RFC 4648, section 4.
std::string toBase64(const base::Bytes& bytes) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t j = 0; j < 3; ++j) {
            group = group << 8U | (j < count ? bytes[i + j] : 0U);
        }
        for (std::size_t j = 0; j < 4; ++j) {
            text += j <= count ? kDigits[group >> (18U - 6U * j) & 63U] : '=';
        }
    }
    return text;
}

// Returns JSON that can stand inside a <script>: nothing in it can end that element or start a comment in it.
// In JSON these characters occur only in strings, where they may be escaped.
std::string toScriptData(const Json& json) {
    std::string text;
    for (const char c : json.dump(-1, ' ', true, Json::error_handler_t::replace)) {
        switch (c) {
            case '<':
                text += "\\u003c";
                break;
            case '>':
                text += "\\u003e";
                break;
            case '&':
                text += "\\u0026";
                break;
            default:
                text += c;
        }
    }
    return text;
}

}  // namespace

std::string makePage(const Json& report, std::span<const PageImage> images) {
    std::string html;
    std::string css;
    std::string script;
    for (const base::BuiltinFile& file : pageFiles()) {
        std::string& part = file.name.ends_with(".js") ? script : file.name.ends_with(".css") ? css : html;
        part += file.text;
    }
    Json uris = Json::object();
    for (const PageImage& image : images) {
        uris[image.name] = "data:image/png;base64," + toBase64(image.png);
    }

    using kainjow::mustache::data;
    data parts;
    parts.set("css", css);
    parts.set("script", script);
    parts.set("report", toScriptData(report));
    parts.set("images", toScriptData(uris));
    kainjow::mustache::mustache page(html);
    return page.render(parts);
}

}  // namespace glint::measure
