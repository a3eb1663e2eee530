// JSON that Glint writes, and that it reads again member by member.
#pragma once

#include <glint/result.h>

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace glint::base {

// Keys keep the order in which they are added.
using Json = nlohmann::ordered_json;

// Text that is not UTF-8 is replaced, so that the output is always valid JSON.
std::string toText(const Json& json);
// Returns the value, or null if there is none.
template <typename T>
Json orNull(const std::optional<T>& value) {
    return value ? Json(*value) : Json(nullptr);
}
// Returns the text, or null if it is empty.
Json textOrNull(const std::string& text);

// Reads a file value by value and reports the place of the first member that is wrong. It keeps the first
// error. Everything read after it is an empty value.
class JsonReader {
public:
    // `id` and `hint` are those of its errors.
    JsonReader(const std::filesystem::path& path, std::string id, std::string hint)
        : path_(path.string()), id_(std::move(id)), hint_(std::move(hint)) {}

    // Reads the whole file, of at most `mostBytes`. Errors "file-open", "file-read" and that of the reader.
    Result<Json> read(std::uint64_t mostBytes);

    bool ok() const {
        return error_.message.empty();
    }
    const Diagnostic& error() const {
        return error_;
    }
    // `pointer` is the place in the file; if it is empty, the error is about the whole file.
    void fail(const std::string& pointer, const std::string& message);

    // Returns null, and sets an error, if `object` lacks the member.
    const Json* member(const Json& object, const std::string& pointer, const char* name);
    // Return an empty value, and set an error, if `value` is something else. `place` is its pointer.
    // `names` are the texts that are allowed; empty: all of them.
    std::string text(const Json& value, const std::string& place,
                     std::span<const std::string_view> names = {});
    bool flag(const Json& value, const std::string& place);
    std::uint64_t count(const Json& value, const std::string& place, std::uint64_t most);
    double number(const Json& value, const std::string& place, std::optional<double> least,
                  std::optional<double> most);

    // Calls use(element, its pointer) for each element of a list until one fails.
    void each(const Json& list, const std::string& place,
              const std::function<void(const Json& element, const std::string& place)>& use);
    // Calls use(name, value, its pointer) for each member of an object until one fails.
    void eachMember(
        const Json& object, const std::string& place,
        const std::function<void(const std::string& name, const Json& value, const std::string& place)>& use);

private:
    std::string path_;
    std::string id_;
    std::string hint_;
    Diagnostic error_;
};

// The files that Glint reads and writes need fewer than a dozen levels, and `extras` of glTF seldom need
// more.
inline constexpr int kMaxJsonDepth = 128;

// Returns whether arrays and objects are nested more than kMaxJsonDepth levels deep. The text need not be
// JSON.
bool nestsTooDeep(std::span<const std::uint8_t> json);

}  // namespace glint::base
