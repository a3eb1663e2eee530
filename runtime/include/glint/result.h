// Errors as values, and the names of enumerators, for all headers. This one needs the standard library only.
#pragma once

#include <array>
#include <cassert>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace glint {

enum class Severity { Note, Warning, Error };

// The kinds of errors that programs treat in a way of their own. Compare Diagnostic::kind; nothing else tells
// them apart.
enum class ErrorKind : std::uint8_t {
    Other,
    DeviceLost,       // destroy everything that was made with the device, and the device, and make them anew
    OutOfHostMemory,  // nothing has changed; free memory and try again
    OutOfDeviceMemory,  // the same, after every heap that fits was tried
    SurfaceLost,        // make the window's surface and swapchain anew
};

// One message to the user. It names the fault, its place and a remedy.
struct Diagnostic {
    Severity severity = Severity::Error;
    std::string id;       // stable kebab-case name of the kind of message, for instance "accessor-range"
    std::string where;    // file, file#/json/pointer or file:line; empty when there is no place
    std::string message;  // one sentence, no final full stop
    std::string hint;     // advice for the user; may be empty
    ErrorKind kind = ErrorKind::Other;
    std::int32_t code = 0;  // the VkResult of the call that failed; 0 if there is none
};

// Formats as "scene.gltf#/materials/3: error: message; hint [id]".
inline std::string toString(const Diagnostic& diagnostic) {
    static constexpr const char* kNames[] = {"note", "warning", "error"};
    std::string text;
    if (!diagnostic.where.empty()) {
        text += diagnostic.where + ": ";
    }
    text += std::string(kNames[static_cast<int>(diagnostic.severity)]) + ": " + diagnostic.message;
    if (!diagnostic.hint.empty()) {
        text += "; " + diagnostic.hint;
    }
    if (!diagnostic.id.empty()) {
        text += " [" + diagnostic.id + "]";
    }
    return text;
}

// A value, or the error that prevented it.
template <typename T>
class [[nodiscard]] Result {
public:
    Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
    Result(Diagnostic error) : state_(std::in_place_index<1>, std::move(error)) {}

    bool ok() const {
        return state_.index() == 0;
    }
    explicit operator bool() const {
        return ok();
    }
    // Each accessor requires the matching state.
    T& value() {
        assert(ok());
        return std::get<0>(state_);
    }
    const T& value() const {
        assert(ok());
        return std::get<0>(state_);
    }
    const Diagnostic& error() const {
        assert(!ok());
        return std::get<1>(state_);
    }
    T* operator->() {
        return &value();
    }
    const T* operator->() const {
        return &value();
    }
    T& operator*() & {
        return value();
    }
    const T& operator*() const& {
        return value();
    }
    T&& operator*() && {
        return std::move(value());
    }

private:
    std::variant<T, Diagnostic> state_;
};

// The result of work that returns no value but may fail.
using Status = Result<std::monostate>;

inline Status okStatus() {
    return Status(std::monostate{});
}

inline Diagnostic makeError(std::string id, std::string where, std::string message, std::string hint = {}) {
    return {.severity = Severity::Error,
            .id = std::move(id),
            .where = std::move(where),
            .message = std::move(message),
            .hint = std::move(hint)};
}

inline Diagnostic makeWarning(std::string id, std::string where, std::string message, std::string hint = {}) {
    return {.severity = Severity::Warning,
            .id = std::move(id),
            .where = std::move(where),
            .message = std::move(message),
            .hint = std::move(hint)};
}

}  // namespace glint

#define GLINT_JOIN_NAMES_(first, second) first##second
#define GLINT_JOIN_NAMES(first, second) GLINT_JOIN_NAMES_(first, second)

#define GLINT_TRY_AS_(result, declaration, ...) \
    auto result = __VA_ARGS__;                  \
    if (!result) {                              \
        return result.error();                  \
    }                                           \
    declaration = *std::move(result)

#define GLINT_TRY_DO_AS_(result, ...)                              \
    do {                                                           \
        if (const ::glint::Status result = __VA_ARGS__; !result) { \
            return result.error();                                 \
        }                                                          \
    } while (false)

// Declares or assigns a variable with the value of a `Result`, or returns the error from the function:
// `GLINT_TRY(const auto bytes, base::readFile(path));`. It is several statements, so an `if` needs braces.
#define GLINT_TRY(variable, ...) \
    GLINT_TRY_AS_(GLINT_JOIN_NAMES(resultOfLine, __LINE__), variable, __VA_ARGS__)

// Does work that gives a `Status`, and returns its error from the function:
// `GLINT_TRY_DO(base::writeFile(path, bytes));`. It takes no `Result` with a value, because that would end at
// once, and some values, such as locks, must live on.
#define GLINT_TRY_DO(...) GLINT_TRY_DO_AS_(GLINT_JOIN_NAMES(resultOfLine, __LINE__), __VA_ARGS__)

namespace glint {

// The names of enumerators, as people write them on the command line and in files. An enumeration declares
// them once, beside itself, as an array of Named and a function namesOf() that the templates here find by its
// argument.

template <typename Value>
struct Named {
    Value value{};
    std::string_view name;
    std::string_view what = {};  // a sentence without a full stop, for help and documents; may be empty
};

template <typename Value>
concept HasNames = requires(Value value) {
    { namesOf(value) } -> std::convertible_to<std::span<const Named<Value>>>;
};

// Returns "unknown" for a value that is not exactly one of the named ones.
template <HasNames Value>
constexpr std::string_view nameOf(Value value) {
    for (const Named<Value>& named : namesOf(value)) {
        if (named.value == value) {
            return named.name;
        }
    }
    return "unknown";
}

template <HasNames Value>
constexpr std::optional<Value> valueNamed(std::string_view name) {
    for (const Named<Value>& named : namesOf(Value{})) {
        if (named.name == name) {
            return named.value;
        }
    }
    return std::nullopt;
}

template <typename Value, std::size_t N>
constexpr std::array<Value, N> valuesOf(const Named<Value> (&names)[N]) {
    std::array<Value, N> values{};
    for (std::size_t i = 0; i < N; ++i) {
        values[i] = names[i].value;
    }
    return values;
}

}  // namespace glint
