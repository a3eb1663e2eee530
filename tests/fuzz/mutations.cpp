#include "fuzz/mutations.h"

#include "gltf/import.h"

#include <gtest/gtest.h>

#include <array>
#include <iterator>
#include <vector>

namespace glint::test {

namespace {

// Returns numbers at the limits of the importer's arithmetic.
std::string hostileNumber(Random& random) {
    constexpr std::array kNumbers{"-1",
                                  "0",
                                  "1",
                                  "3",
                                  "255",
                                  "65535",
                                  "2147483647",
                                  "2147483648",
                                  "4294967295",
                                  "1e38",
                                  "1e39",
                                  "-0.0",
                                  "0.5",
                                  "9007199254740991",
                                  "5121",
                                  "5126",
                                  "1e-45",
                                  "18446744073709551615",
                                  "99999999999999999999"};
    return kNumbers[below(random, kNumbers.size())];
}

void replaceNumber(Random& random, std::string& text) {
    const std::size_t first = text.find_first_of("0123456789", below(random, text.size()));
    if (first == std::string::npos) {
        return;
    }
    const std::size_t last = text.find_first_not_of("0123456789.eE+-", first);
    text.replace(first, (last == std::string::npos ? text.size() : last) - first, hostileNumber(random));
}

void repeatPiece(Random& random, std::string& text) {
    const std::string piece = text.substr(below(random, text.size()), 1 + below(random, 40));
    text.insert(below(random, text.size()), piece);
}

// Collects every value of a document, to choose from.
void collect(Json& value, std::vector<Json*>& values) {
    values.push_back(&value);
    if (value.is_structured()) {
        for (Json& element : value) {
            collect(element, values);
        }
    }
}

// Replaces one value of the document by a hostile number, by another of its values, or by nothing.
void mutateValue(Random& random, Json& root) {
    std::vector<Json*> values;
    collect(root, values);
    Json& target = *values[below(random, values.size())];
    const Json other = *values[below(random, values.size())];
    switch (below(random, 6)) {
        case 0:
            target = other;
            break;
        case 1:
            if (target.is_structured() && !target.empty()) {
                target.erase(
                    std::next(target.begin(), static_cast<std::ptrdiff_t>(below(random, target.size()))));
            }
            break;
        case 2:
            if (target.is_array() && !target.empty()) {
                target.push_back(target[below(random, target.size())]);
            }
            break;
        default:
            if (target.is_number()) {
                target = Json::parse(hostileNumber(random), nullptr, false);
            }
    }
}

}  // namespace

std::size_t below(Random& random, std::size_t limit) {
    return limit == 0 ? 0 : random() % limit;
}

void flipBytes(Random& random, std::string& text) {
    for (std::size_t count = 1 + below(random, 4); count > 0 && !text.empty(); --count) {
        char& byte = text[below(random, text.size())];
        byte = static_cast<char>(byte ^ static_cast<char>(1U << below(random, 8)));
    }
}

std::string mutate(Random& random, std::string text) {
    for (std::size_t rounds = 1 + below(random, 3); rounds > 0; --rounds) {
        switch (below(random, 5)) {
            case 0:
                text.resize(below(random, text.size()));
                break;
            case 1:
                flipBytes(random, text);
                break;
            case 2:
                repeatPiece(random, text);
                break;
            default:
                replaceNumber(random, text);
        }
    }
    return text;
}

std::string mutateContents(Random& random, const GltfBuilder& builder) {
    GltfBuilder copy = builder;
    copy.root["buffers"] = copy.buffers(false);
    for (std::size_t rounds = below(random, 4); rounds > 0; --rounds) {
        mutateValue(random, copy.root);
    }
    std::string binary(copy.buffer.begin(), copy.buffer.end());
    if (below(random, 2) == 0) {
        flipBytes(random, binary);
    }
    const std::string body = chunk(0x4E4F534A, copy.root.dump(), ' ') + chunk(0x004E4942, binary, '\0');
    return "glTF" + word(2) + word(static_cast<std::uint32_t>(body.size() + 12)) + body;
}

void importMutation(const std::filesystem::path& path, const std::string& bytes, Tally& tally) {
    ASSERT_TRUE(base::writeFile(path, bytes).ok());
    const gltf::ImportOptions options{
        .decodeImages = true, .maxVertices = 1U << 16, .maxFileBytes = 1U << 24};
    const Result<gltf::Scene> scene = importScene(path, options);
    if (scene) {
        ++tally.imported;
        EXPECT_EQ(scene->path, path.string());
        return;
    }
    ++tally.refused;
    tally.ids.insert(scene.error().id);
    EXPECT_TRUE(scene.error().where.starts_with(path.string())) << toString(scene.error());
    EXPECT_FALSE(scene.error().id.empty());
    EXPECT_FALSE(scene.error().message.empty());
}

}  // namespace glint::test
