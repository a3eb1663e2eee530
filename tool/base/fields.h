// The JSON of a type, described once: its writer, its reader and its schema follow from a list of its fields.
// A type has such a list as a function, which is found by its argument:
//
//     base::Fields fieldsOf(const Size*) {
//         return {field<&Size::width>("width", "Width in pixels.", {.most = 4096}),
//                 output("pixels", "Number of pixels.", [](const Size& size) { return size.count(); })};
//     }
//
// A field is a number, a text, a flag, a value with names (glint/result.h), Json, another described type, or
// an optional, a list, a map or list of pairs by text or a variant of these.
#pragma once

#include "base/fields_fwd.h"
#include "base/json.h"

#include <glint/result.h>

#include <concepts>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace glint::base {

// Facts about a field's value that its type does not have. For lists and maps they are about the elements.
struct FieldTraits {
    std::optional<double> least{};  // whole numbers are at least 0 without it
    std::optional<double> most{};
    bool orNull = false;                    // an empty text, or a number that is not finite, is null
    bool optional = false;                  // the member is left out where it is null, and may be missing
    std::vector<std::string_view> names{};  // the texts that are allowed; empty: all of them
    std::size_t leastElements = 0;          // of a list
    std::size_t mostElements = 0;           // of a list; 0: any number
    const char* pattern = nullptr;          // of a text; only the schema has it
};

using FieldWriter = Json (*)(const void* object);
using FieldReader = void (*)(void* object, JsonReader& reader, const Json& value, const std::string& place,
                             const FieldTraits& traits);
using FieldSchema = Json (*)(const FieldTraits& traits);

struct Field {
    const char* name;  // empty: the members of its value stand among those of the object
    const char* what;  // a sentence
    FieldTraits traits{};
    FieldWriter write = nullptr;
    FieldReader read = nullptr;  // null where the value follows from others
    FieldSchema schema = nullptr;
    std::vector<Field> members{};  // an object of fields of the same type
    Json constant{};               // a value that never changes
};

template <typename T>
concept Described = requires(const T* none) {
    { fieldsOf(none) } -> std::same_as<Fields>;
};

template <Described T>
const Fields& fields() {
    static const Fields list = fieldsOf(static_cast<const T*>(nullptr));
    return list;
}

// These do not depend on types, so that they are compiled once.
Json writeFields(const Fields& fields, const void* object);
void readFields(const Fields& fields, void* object, JsonReader& reader, const Json& json,
                const std::string& place);
// Fails at the first member of an object that is none of the fields.
void refuseOthers(const Fields& fields, JsonReader& reader, const Json& json, const std::string& place);
Json schemaOfFields(const Fields& fields);
Json schemaOfNumber(bool isWhole, const FieldTraits& traits);
Json schemaOfText(const FieldTraits& traits);
Json schemaOfList(Json elements, const FieldTraits& traits);
Json schemaOrNull(Json schema);
Json schemaOfAny(std::vector<Json> schemas);

// Returns the names of all values of an enumeration.
template <HasNames V>
std::vector<std::string_view> wordsFor() {
    std::vector<std::string_view> words;
    for (const Named<V>& one : namesOf(V{})) {
        words.push_back(one.name);
    }
    return words;
}

namespace detail {

template <typename T>
inline constexpr bool kIsVariant = false;
template <typename... Parts>
inline constexpr bool kIsVariant<std::variant<Parts...>> = true;
template <typename T>
concept Text = std::convertible_to<const T&, std::string_view>;
template <typename T>
concept List = !Text<T> && requires(const T& list) {
    list.begin() != list.end();
};
template <typename T>
concept Map = List<T> && requires {
    requires Text<typename T::value_type::first_type>;
};
template <typename T>
concept Nullable = !Text<T> && requires(const T& value) {
    *value;
    static_cast<bool>(value);
};

template <typename V>
Json write(const V& value) {
    if constexpr (Described<V>) {
        return writeFields(fields<V>(), &value);
    } else if constexpr (std::same_as<V, Json>) {
        return value;
    } else if constexpr (kIsVariant<V>) {
        return std::visit([](const auto& one) { return write(one); }, value);
    } else if constexpr (HasNames<V>) {
        return Json(std::string(nameOf(value)));
    } else if constexpr (Text<V>) {
        return Json(std::string(std::string_view(value)));
    } else if constexpr (Nullable<V>) {
        return value ? write(*value) : Json(nullptr);
    } else if constexpr (Map<V>) {
        Json object = Json::object();
        for (const auto& [name, element] : value) {
            object[std::string(name)] = write(element);
        }
        return object;
    } else if constexpr (List<V>) {
        Json list = Json::array();
        for (const auto& element : value) {
            list.push_back(write(element));
        }
        return list;
    } else {
        return Json(value);
    }
}

template <typename V>
void read(V& value, JsonReader& reader, const Json& json, const std::string& place,
          const FieldTraits& traits) {
    if constexpr (Described<V>) {
        readFields(fields<V>(), &value, reader, json, place);
    } else if constexpr (std::same_as<V, Json>) {
        value = json;
    } else if constexpr (std::same_as<V, std::string>) {
        value = reader.text(json, place, traits.names);
    } else if constexpr (std::same_as<V, bool>) {
        value = reader.flag(json, place);
    } else if constexpr (std::integral<V>) {
        constexpr V kMost = std::numeric_limits<V>::max();
        value = static_cast<V>(reader.count(
            json, place,
            traits.most ? static_cast<std::uint64_t>(*traits.most) : static_cast<std::uint64_t>(kMost)));
    } else if constexpr (std::floating_point<V>) {
        value = static_cast<V>(reader.number(json, place, traits.least, traits.most));
    } else if constexpr (Nullable<V>) {
        if (!json.is_null()) {
            read(value.emplace(), reader, json, place, traits);
        }
    } else if constexpr (Map<V>) {
        reader.eachMember(
            json, place, [&](const std::string& name, const Json& one, const std::string& there) {
                using Element = typename V::value_type;
                read(value.insert(value.end(), Element(name, {}))->second, reader, one, there, traits);
            });
    } else {
        reader.each(json, place, [&](const Json& one, const std::string& there) {
            if (traits.mostElements > 0 && value.size() == traits.mostElements) {
                reader.fail(place, "has more than " + std::to_string(traits.mostElements) + " elements");
            }
            read(value.emplace_back(), reader, one, there, traits);
        });
        if (value.size() < traits.leastElements) {
            reader.fail(place, "is empty");
        }
    }
}

template <typename V>
Json schema(const FieldTraits& traits) {
    if constexpr (Described<V>) {
        return schemaOfFields(fields<V>());
    } else if constexpr (std::same_as<V, Json>) {
        return Json::object();
    } else if constexpr (kIsVariant<V>) {
        return []<typename... Parts>(const std::variant<Parts...>*) {
            return schemaOfAny({schema<Parts>({})...});
        }(static_cast<const V*>(nullptr));
    } else if constexpr (HasNames<V>) {
        return schemaOfText({.names = wordsFor<V>()});
    } else if constexpr (Text<V>) {
        return schemaOfText(traits);
    } else if constexpr (std::same_as<V, bool>) {
        return {{"type", "boolean"}};
    } else if constexpr (std::is_arithmetic_v<V>) {
        return schemaOfNumber(std::integral<V>, traits);
    } else if constexpr (Nullable<V>) {
        return schemaOrNull(schema<std::remove_cvref_t<decltype(*std::declval<V&>())>>(traits));
    } else if constexpr (Map<V>) {
        return {{"type", "object"},
                {"additionalProperties", schema<typename V::value_type::second_type>(traits)}};
    } else {
        return schemaOfList(schema<std::remove_cvref_t<decltype(*std::declval<const V&>().begin())>>(traits),
                            traits);
    }
}

template <typename Object, typename Value>
Object objectOf(Value Object::*member);
template <typename Object, typename Value>
Object objectOf(Value (*function)(const Object&));
template <typename Lambda, typename Object, typename Value>
Object objectOf(Value (Lambda::*function)(const Object&) const, int);

template <auto First, auto... Rest>
auto objectOfFirst() -> decltype(objectOf(First));
template <auto... Path>
using ObjectOf = decltype(objectOfFirst<Path...>());
template <typename Function>
using ArgumentOf = decltype(objectOf(&Function::operator(), 0));

template <auto First, auto... Rest>
decltype(auto) get(auto& object) {
    if constexpr (sizeof...(Rest) == 0) {
        return std::invoke(First, object);
    } else {
        return get<Rest...>(std::invoke(First, object));
    }
}
template <auto... Path>
using ValueOf = std::remove_cvref_t<decltype(get<Path...>(std::declval<const ObjectOf<Path...>&>()))>;

}  // namespace detail

// A field that is only written: a member, a function of the object, or a member of a member, as in
// output<&Frame::motion, &Motion::refits>("refits", "...").
template <auto... Path>
Field output(const char* name, const char* what, FieldTraits traits = {}) {
    using Object = detail::ObjectOf<Path...>;
    return {name,
            what,
            std::move(traits),
            [](const void* object) {
                return detail::write(detail::get<Path...>(*static_cast<const Object*>(object)));
            },
            nullptr,
            detail::schema<detail::ValueOf<Path...>>,
            {},
            {}};
}

// The same of a value that get(object) makes.
template <typename Get>
Field output(const char* name, const char* what, Get, FieldTraits traits = {}) {
    using Object = detail::ArgumentOf<Get>;
    using Value = std::remove_cvref_t<std::invoke_result_t<Get, const Object&>>;
    return {name,
            what,
            std::move(traits),
            [](const void* object) { return detail::write(Get{}(*static_cast<const Object*>(object))); },
            nullptr,
            detail::schema<Value>,
            {},
            {}};
}

// A field that is written and read: a member, or a member of a member.
template <auto... Path>
Field field(const char* name, const char* what, FieldTraits traits = {}) {
    using Object = detail::ObjectOf<Path...>;
    Field field = output<Path...>(name, what, std::move(traits));
    field.read = [](void* object, JsonReader& reader, const Json& json, const std::string& place,
                    const FieldTraits& facts) {
        detail::read(detail::get<Path...>(*static_cast<Object*>(object)), reader, json, place, facts);
    };
    return field;
}

// The same of a value that get(object) makes, and that set(object, value), or set(object, value, reader,
// place), takes. Nothing is set after an error.
template <typename Get, typename Set>
Field field(const char* name, const char* what, Get get, Set, FieldTraits traits = {}) {
    using Object = detail::ArgumentOf<Get>;
    using Value = std::remove_cvref_t<std::invoke_result_t<Get, const Object&>>;
    Field field = output(name, what, get, std::move(traits));
    field.read = [](void* object, JsonReader& reader, const Json& json, const std::string& place,
                    const FieldTraits& facts) {
        Value value{};
        detail::read(value, reader, json, place, facts);
        if (!reader.ok()) {
            return;
        }
        if constexpr (std::is_invocable_v<Set, Object&, Value, JsonReader&, const std::string&>) {
            Set{}(*static_cast<Object*>(object), std::move(value), reader, place);
        } else {
            Set{}(*static_cast<Object*>(object), std::move(value));
        }
    };
    return field;
}

// An object whose members are fields of the same type.
Field group(const char* name, const char* what, Fields members);

// A value that is always the same. Another one is an error.
Field constant(const char* name, const char* what, Json value);

// Writes any value that a field may be.
template <typename V>
Json jsonOf(const V& value) {
    return detail::write(value);
}

// Returns what was read before the first error.
template <Described T>
T readAs(JsonReader& reader, const Json& json, const std::string& place = {}) {
    T object{};
    readFields(fields<T>(), &object, reader, json, place);
    return object;
}

template <Described T>
Result<T> readFileAs(JsonReader reader, std::uint64_t mostBytes) {
    GLINT_TRY(const auto json, reader.read(mostBytes));
    T object = readAs<T>(reader, json);
    return reader.ok() ? Result<T>(std::move(object)) : Result<T>(reader.error());
}

template <Described T>
Json schemaOf() {
    return schemaOfFields(fields<T>());
}

}  // namespace glint::base
