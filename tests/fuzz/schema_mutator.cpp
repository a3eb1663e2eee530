#include "fuzz/schema_mutator.h"

#include "base/json.h"
#include "fuzz/fuzz_target.h"

#include <algorithm>
#include <map>
#include <random>
#include <regex>
#include <string>
#include <utility>
#include <vector>

namespace {

using glint::base::Json;

// A value of the input, and its schema.
struct Slot {
    Json* value;
    const Json* schema;
};

class Mutator {
public:
    Mutator(unsigned int seed, Json& document)
        : random_(seed), document_(document), words_(glint::fuzz::inputSchema().words) {
        visit(document, glint::fuzz::inputSchema().schema);
    }

    // A new document of few members reaches what the members of others would hide.
    void mutate() {
        if (oneIn(8)) {
            share_ = std::size_t{2} << below(4);
            document_ = makeObject(glint::fuzz::inputSchema().schema, 0);
            return;
        }
        const Slot slot = slots_[oneIn(4) ? 0 : below(slots_.size())];
        if (slot.value->is_object() && slot.schema->contains("properties")) {
            mutateObject(*slot.value, *slot.schema);
        } else if (slot.value->is_array() && slot.schema->contains("items") && !oneIn(4)) {
            mutateList(*slot.value, (*slot.schema)["items"]);
        } else if (oneIn(4)) {
            *slot.value = Json(*slots_[below(slots_.size())].value);
        } else {
            *slot.value = make(*slot.schema, 0);
        }
    }

private:
    std::size_t below(std::size_t count) {
        return random_() % std::max<std::size_t>(count, 1);
    }
    bool oneIn(std::size_t count) {
        return below(count) == 0;
    }

    static bool fits(const Json& value, const Json& schema) {
        const Json type = schema.value("type", Json());
        const auto is = [&](std::string_view name) { return type == name || type.is_null(); };
        return value.is_object()   ? is("object") && !schema.contains("enum")
               : value.is_array()  ? is("array") && !schema.contains("enum")
               : value.is_string() ? is("string")
                                   : !is("object") && !is("array");
    }

    void visit(Json& value, const Json& schema) {
        for (const char* const alternatives : {"oneOf", "anyOf"}) {
            if (schema.contains(alternatives)) {
                const Json& all = schema[alternatives];
                const auto found =
                    std::ranges::find_if(all, [&](const Json& one) { return fits(value, one); });
                visit(value, found == all.end() ? all.front() : *found);
                return;
            }
        }
        slots_.push_back({&value, &schema});
        if (value.is_string()) {
            words_.push_back(value.get<std::string>());
        }
        const bool named = schema.contains("properties");
        const Json* const others =
            schema.contains("additionalProperties") && schema["additionalProperties"].is_object()
                ? &schema["additionalProperties"]
                : nullptr;
        for (auto& [name, member] : (value.is_object() ? value : none_).items()) {
            if (named && schema["properties"].contains(name)) {
                visit(member, schema["properties"][name]);
            } else if (others != nullptr) {
                words_.push_back(name);
                visit(member, *others);
            }
        }
        for (Json& element : value.is_array() && schema.contains("items") ? value : none_) {
            visit(element, schema["items"]);
        }
    }

    void mutateObject(Json& object, const Json& schema) {
        const Json& members = schema["properties"];
        if (oneIn(4) && !object.empty()) {
            object.erase(std::next(object.begin(), static_cast<std::ptrdiff_t>(below(object.size()))));
            return;
        }
        if (oneIn(32)) {
            // A member that stands elsewhere.
            const Slot& other = slots_[below(slots_.size())];
            if (other.schema->contains("properties")) {
                addMember(object, (*other.schema)["properties"]);
            }
            return;
        }
        addMember(object, members);
    }

    void addMember(Json& object, const Json& members) {
        const auto chosen = std::next(members.begin(), static_cast<std::ptrdiff_t>(below(members.size())));
        object[chosen.key()] = make(chosen.value(), 0);
    }

    void mutateList(Json& list, const Json& elements) {
        const auto place = static_cast<std::ptrdiff_t>(below(list.size()));
        if (list.empty() || oneIn(2)) {
            list.push_back(make(elements, 0));
        } else if (oneIn(2)) {
            list.push_back(Json(list[static_cast<std::size_t>(place)]));
        } else {
            list.erase(std::next(list.begin(), place));
        }
    }

    Json make(const Json& schema, int depth) {
        for (const char* const alternatives : {"oneOf", "anyOf", "enum"}) {
            if (schema.contains(alternatives)) {
                const Json& chosen = schema[alternatives][below(schema[alternatives].size())];
                return chosen.is_object() ? make(chosen, depth) : chosen;
            }
        }
        if (schema.contains("const")) {
            return schema["const"];
        }
        const Json types = schema.value("type", Json("string"));
        const std::string type = types.is_array() ? types[below(types.size())] : types;
        if (type == "object") {
            return makeObject(schema, depth);
        }
        if (type == "array") {
            Json list = Json::array();
            const std::size_t least = schema.value("minItems", std::size_t{0});
            const std::size_t most = schema.value("maxItems", least + 3);
            for (std::size_t left = least + below(most - least + 1); left > 0; --left) {
                list.push_back(make(schema["items"], depth + 1));
            }
            return list;
        }
        if (type == "boolean") {
            return oneIn(2);
        }
        if (type == "number" || type == "integer") {
            constexpr double kNumbers[] = {0.0, 1.0, 2.0, 0.5, -1.0, 1e6, 1e-30, 1e39, 3.0, 64.0};
            return kNumbers[below(std::size(kNumbers))];
        }
        return type == "null" || words_.empty() ? Json() : Json(word(schema.value("pattern", "")));
    }

    // A word, which mostly fits the pattern.
    const std::string& word(const std::string& pattern) {
        static std::map<std::string, std::regex> patterns;
        const auto [known, isNew] = patterns.try_emplace(pattern, pattern);
        std::size_t place = below(words_.size());
        for (std::size_t tries = 0; tries < 16 && !std::regex_search(words_[place], known->second); ++tries) {
            place = below(words_.size());
        }
        return words_[place];
    }

    Json makeObject(const Json& schema, int depth) {
        Json object = Json::object();
        constexpr int kDeepest = 4;
        const Json needed = schema.value("required", Json::array());
        const Json members = schema.value("properties", Json::object());
        for (const auto& [name, member] : members.items()) {
            if (std::ranges::find(needed, Json(name)) != needed.end() ||
                (depth < kDeepest && oneIn(share_))) {
                object[name] = make(member, depth + 1);
            }
        }
        if (members.empty() && schema.value("additionalProperties", Json()).is_object() && !words_.empty()) {
            object[words_[below(words_.size())]] = make(schema["additionalProperties"], depth + 1);
        }
        return object;
    }

    std::minstd_rand random_;
    Json& document_;
    Json none_ = Json::array();
    std::size_t share_ = 4;  // one optional member in so many is made
    std::vector<std::string> words_;
    std::vector<Slot> slots_;
};

}  // namespace

std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t maxSize,
                                    unsigned int seed) {
    Json document = Json::parse(data, data + size, nullptr, false);
    if (seed % 8 == 0 || document.is_discarded()) {
        return LLVMFuzzerMutate(data, size, maxSize);
    }
    for (unsigned int count = 0; count <= seed / 8 % 3; ++count) {
        Mutator(seed + count, document).mutate();
    }
    const std::string text = document.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (text.size() > maxSize) {
        return LLVMFuzzerMutate(data, size, maxSize);
    }
    std::ranges::copy(text, data);
    return text.size();
}
