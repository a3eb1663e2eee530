#include "base/json.h"

#include "base/files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace glint::base {

std::string toText(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json textOrNull(const std::string& text) {
    return text.empty() ? Json(nullptr) : Json(text);
}

Result<Json> JsonReader::read(std::uint64_t mostBytes) {
    GLINT_TRY(const auto bytes, readFile(path_, mostBytes));
    if (nestsTooDeep(bytes)) {
        fail("", "nests too deep");
        return error_;
    }
    try {
        return Json::parse(bytes.begin(), bytes.end());
    } catch (const Json::parse_error& error) {
        fail("", fmt::format("is not valid JSON: byte {} is wrong", error.byte));
    } catch (const Json::exception&) {
        // The syntax is right, but a double can't hold the number.
        fail("", "holds a number that is too large");
    }
    return error_;
}

void JsonReader::fail(const std::string& pointer, const std::string& message) {
    if (ok()) {
        error_ = makeError(id_, pointer.empty() ? path_ : path_ + "#" + pointer, message, hint_);
    }
}

const Json* JsonReader::member(const Json& object, const std::string& pointer, const char* name) {
    const auto found = object.is_object() ? object.find(name) : object.end();
    if (found == object.end()) {
        fail(pointer, fmt::format("has no member \"{}\"", name));
        return nullptr;
    }
    return &*found;
}

std::string JsonReader::text(const Json& value, const std::string& place,
                             std::span<const std::string_view> names) {
    const std::string text = value.is_string() ? value.get<std::string>() : std::string();
    if (!value.is_string()) {
        fail(place, "is no string");
    } else if (!names.empty() && std::ranges::find(names, text) == names.end()) {
        fail(place, names.size() == 2 ? fmt::format("is neither \"{}\" nor \"{}\"", names[0], names[1])
                                      : fmt::format("is none of {}", fmt::join(names, ", ")));
    }
    return ok() ? text : std::string();
}

bool JsonReader::flag(const Json& value, const std::string& place) {
    if (!value.is_boolean()) {
        fail(place, "is neither true nor false");
    }
    return ok() && value.get<bool>();
}

std::uint64_t JsonReader::count(const Json& value, const std::string& place, std::uint64_t most) {
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() > most) {
        fail(place, fmt::format("is no whole number from 0 to {}", most));
    }
    return ok() ? value.get<std::uint64_t>() : 0;
}

double JsonReader::number(const Json& value, const std::string& place, std::optional<double> least,
                          std::optional<double> most) {
    const double number = value.is_number() ? value.get<double>() : std::nan("");
    if (!(number >= least.value_or(number)) || !(number <= most.value_or(number))) {
        fail(place, fmt::format("is no number{}{}", least ? fmt::format(" from {}", *least) : "",
                                most ? fmt::format(" to {}", *most) : ""));
    }
    return ok() ? number : 0.0;
}

void JsonReader::each(const Json& list, const std::string& place,
                      const std::function<void(const Json& element, const std::string& place)>& use) {
    if (!list.is_array()) {
        fail(place, "is no list");
    }
    for (std::size_t i = 0; ok() && i < list.size(); ++i) {
        use(list[i], place + "/" + std::to_string(i));
    }
}

void JsonReader::eachMember(
    const Json& object, const std::string& place,
    const std::function<void(const std::string& name, const Json& value, const std::string& place)>& use) {
    if (!object.is_object()) {
        fail(place, "is no JSON object");
        return;
    }
    for (const auto& [name, value] : object.items()) {
        if (ok()) {
            use(name, value, fmt::format("{}/{}", place, name));
        }
    }
}

bool nestsTooDeep(std::span<const std::uint8_t> json) {
    int depth = 0;
    bool inString = false;
    for (std::size_t i = 0; i < json.size(); ++i) {
        const char c = static_cast<char>(json[i]);
        if (inString) {
            i += c == '\\' ? 1 : 0;
            inString = c != '"';
            continue;
        }
        inString = c == '"';
        depth += c == '{' || c == '[' ? 1 : 0;
        depth -= c == '}' || c == ']' ? 1 : 0;
        if (depth > kMaxJsonDepth) {
            return true;
        }
    }
    return false;
}

}  // namespace glint::base
