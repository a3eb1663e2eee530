#include <glint/package_watch.h>

#include <array>
#include <charconv>
#include <fstream>
#include <system_error>
#include <utility>

namespace glint {
namespace package {

std::filesystem::path stampFile(const std::filesystem::path& folder) {
    // "room.glint/" names the same folder as "room.glint".
    std::filesystem::path file = folder.has_filename() ? folder : folder.parent_path();
    file += kStampSuffix;
    return file;
}

std::optional<std::uint64_t> readStamp(const std::filesystem::path& file) {
    std::array<char, 64> text{};
    std::ifstream stream(file, std::ios::binary);
    stream.read(text.data(), text.size());
    const char* const end = text.data() + stream.gcount();
    std::uint64_t counter = 0;
    const auto [rest, error] = std::from_chars(text.data(), end, counter);
    if (error != std::errc() || rest == end || *rest != ' ') {
        return std::nullopt;
    }
    return counter;
}

}  // namespace package

PackageWatch::PackageWatch(const std::filesystem::path& folder)
    : folder_(folder), stamp_(package::stampFile(folder)), counter_(package::readStamp(stamp_).value_or(0)) {}

Result<std::shared_ptr<const Package>> PackageWatch::poll() {
    const std::optional<std::uint64_t> now = package::readStamp(stamp_);
    if (!now || *now == counter_) {
        return std::shared_ptr<const Package>();
    }
    Result<Package> package = Package::load(folder_);
    if (!package && ++failures_ < kTries) {
        return std::shared_ptr<const Package>();
    }
    failures_ = 0;
    counter_ = *now;
    if (!package) {
        return package.error();
    }
    return std::make_shared<const Package>(std::move(*package));
}

}  // namespace glint
