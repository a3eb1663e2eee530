#include "base/json.h"

#include "base/files.h"

#include <fmt/format.h>

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

std::string JsonReader::text(const Json& object, const std::string& pointer, const char* name) {
    const Json* value = member(object, pointer, name);
    if (value != nullptr && !value->is_string()) {
        fail(pointer + "/" + name, "is no string");
    }
    return ok() ? value->get<std::string>() : std::string();
}

bool JsonReader::flag(const Json& object, const std::string& pointer, const char* name) {
    const Json* value = member(object, pointer, name);
    if (value != nullptr && !value->is_boolean()) {
        fail(pointer + "/" + name, "is neither true nor false");
    }
    return ok() && value->get<bool>();
}

std::uint64_t JsonReader::count(const Json& object, const std::string& pointer, const char* name,
                                std::uint64_t most) {
    const Json* value = member(object, pointer, name);
    if (value != nullptr && (!value->is_number_unsigned() || value->get<std::uint64_t>() > most)) {
        fail(pointer + "/" + name, fmt::format("is no whole number from 0 to {}", most));
    }
    return ok() ? value->get<std::uint64_t>() : 0;
}

double JsonReader::number(const Json& object, const std::string& pointer, const char* name, double least,
                          double most) {
    const Json* value = member(object, pointer, name);
    if (value != nullptr &&
        (!value->is_number() || value->get<double>() < least || value->get<double>() > most)) {
        fail(pointer + "/" + name, fmt::format("is no number from {} to {}", least, most));
    }
    return ok() ? value->get<double>() : 0.0;
}

std::vector<std::string> JsonReader::texts(const Json& object, const std::string& pointer, const char* name) {
    std::vector<std::string> list;
    each(object, pointer, name, [&](const Json& element, const std::string& place) {
        if (!element.is_string()) {
            fail(place, "is no string");
            return;
        }
        list.push_back(element.get<std::string>());
    });
    return list;
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
