// The generated scene, read back as a reader of glTF sees it.
#pragma once

#include <nlohmann/json.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace gallery::test {

using Json = nlohmann::json;

// A folder below the build's, for this process only; removed with the object.
class TemporaryFolder {
public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const {
        return path_;
    }

private:
    std::filesystem::path path_;
};

std::string readAll(const std::filesystem::path& path);

struct Document {
    std::filesystem::path folder;
    Json json;
    std::string binary;

    // The components of an accessor, normalised integers as floats.
    std::vector<float> values(const Json& accessor) const;
    std::vector<std::uint32_t> indices(const Json& accessor) const;
    const Json& accessor(const Json& index) const {
        return json["accessors"].at(index.get<std::size_t>());
    }
};

// Bytes of a component, and components of an element.
std::size_t componentBytes(const Json& accessor);
std::size_t componentCount(const Json& accessor);

// The scene that the build generated, read once.
const Document& document();

}  // namespace gallery::test
