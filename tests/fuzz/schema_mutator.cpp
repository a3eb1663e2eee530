#include "fuzz/schema_mutator.h"

#include "base/json.h"
#include "fuzz/fuzz_target.h"

#include <algorithm>
#include <map>
#include <random>
#include <regex>
#include <string>
#include <unordered_map>
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
    Mutator(unsigned int seed, Json& document) : random_(seed), document_(document) {
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

    // Returns a member of a schema without a copy, which would be that of all below it.
    static const Json& memberOf(const Json& schema, const char* name) {
        static const Json kNone;
        const auto found = schema.find(name);
        return found == schema.end() ? kNone : *found;
    }

    static bool fits(const Json& value, const Json& schema) {
        const Json& type = memberOf(schema, "type");
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
        const Json& named = memberOf(schema, "properties");
        const Json& others = memberOf(schema, "additionalProperties");
        for (auto& [name, member] : (value.is_object() ? value : none_).items()) {
            if (const auto known = named.find(name); known != named.end()) {
                visit(member, *known);
            } else if (others.is_object()) {
                words_.push_back(name);
                visit(member, others);
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
        const Json& types = memberOf(schema, "type");
        const Json& chosen = types.is_array() ? types[below(types.size())] : types;
        const std::string type = chosen.is_string() ? chosen : Json("string");
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
        return type == "null" ? Json() : Json(word(schema.value("pattern", "")));
    }

    // A word of the schema or of the document; empty if there is none.
    std::string anyWord() {
        const std::vector<std::string>& usual = glint::fuzz::inputSchema().words;
        const std::size_t place = below(usual.size() + words_.size());
        return place < usual.size()                   ? usual[place]
               : place - usual.size() < words_.size() ? words_[place - usual.size()]
                                                      : std::string();
    }

    // A word, which mostly fits the pattern.
    std::string word(const std::string& pattern) {
        std::string word = anyWord();
        for (std::size_t tries = 0; tries < 16 && !fitsPattern(word, pattern); ++tries) {
            word = anyWord();
        }
        return word;
    }

    // Remembers words, because to match one takes longer than to read many an input.
    static bool fitsPattern(const std::string& word, const std::string& pattern) {
        struct Pattern {
            std::regex regex;
            std::unordered_map<std::string, bool> fits{};
        };
        static std::map<std::string, Pattern> patterns;
        if (pattern.empty()) {
            return true;
        }
        auto known = patterns.find(pattern);
        if (known == patterns.end()) {
            known = patterns.emplace(pattern, Pattern{std::regex(pattern)}).first;
        }
        constexpr std::size_t kMostWords = 4096;
        std::unordered_map<std::string, bool>& fits = known->second.fits;
        if (fits.size() >= kMostWords) {
            fits.clear();
        }
        const auto [found, isNew] = fits.try_emplace(word, false);
        if (isNew) {
            found->second = std::regex_search(word, known->second.regex);
        }
        return found->second;
    }

    Json makeObject(const Json& schema, int depth) {
        Json object = Json::object();
        constexpr int kDeepest = 4;
        const Json& needed = memberOf(schema, "required");
        const Json& members = memberOf(schema, "properties");
        const auto isNeeded = [&needed](const std::string& name) {
            return std::any_of(needed.begin(), needed.end(), [&](const Json& one) { return one == name; });
        };
        for (const auto& [name, member] : members.items()) {
            if (isNeeded(name) || (depth < kDeepest && oneIn(share_))) {
                object[name] = make(member, depth + 1);
            }
        }
        if (const Json& others = memberOf(schema, "additionalProperties");
            members.empty() && others.is_object()) {
            object[anyWord()] = make(others, depth + 1);
        }
        return object;
    }

    std::minstd_rand random_;
    Json& document_;
    Json none_ = Json::array();
    std::size_t share_ = 4;           // one optional member in so many is made
    std::vector<std::string> words_;  // of the document
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
