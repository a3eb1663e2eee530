// JSON that Glint writes, and that it reads again member by member.
#pragma once

#include <glint/result.h>

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

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

// Reads a file member by member and reports the place of the first member that is wrong. It keeps the first
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
    std::string text(const Json& object, const std::string& pointer, const char* name);
    bool flag(const Json& object, const std::string& pointer, const char* name);
    std::uint64_t count(const Json& object, const std::string& pointer, const char* name, std::uint64_t most);
    double number(const Json& object, const std::string& pointer, const char* name, double least,
                  double most);
    std::vector<std::string> texts(const Json& object, const std::string& pointer, const char* name);

    // Calls use(element, its pointer) for each element until one fails.
    template <typename Use>
    void each(const Json& object, const std::string& pointer, const char* name, const Use& use) {
        const Json* list = member(object, pointer, name);
        if (list != nullptr && !list->is_array()) {
            fail(pointer + "/" + name, "is no list");
        }
        for (std::size_t i = 0; ok() && i < list->size(); ++i) {
            use((*list)[i], pointer + "/" + name + "/" + std::to_string(i));
        }
    }

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
