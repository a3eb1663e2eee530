// A file that holds one input after the other. It is written in place: to make a new file for each input
// would take longer than most readers need.
#pragma once

#include "fuzz/fuzz_target.h"

#include <cstdint>
#include <fcntl.h>
#include <filesystem>
#include <span>
#include <unistd.h>
#include <utility>

namespace glint::fuzz {

class ScratchFile {
public:
    // The folder must be there.
    explicit ScratchFile(std::filesystem::path path) : path_(std::move(path)) {
        constexpr int kMode = 0600;
        file_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kMode);
        require(file_ >= 0, "the temporary folder can be written");
    }
    ScratchFile(const ScratchFile&) = delete;
    ScratchFile& operator=(const ScratchFile&) = delete;
    ~ScratchFile() {
        close(file_);
    }

    // Makes `bytes` the contents of the file; returns its path.
    const std::filesystem::path& hold(std::span<const std::uint8_t> bytes) {
        const auto size = static_cast<ssize_t>(bytes.size());
        require(pwrite(file_, bytes.data(), bytes.size(), 0) == size && ftruncate(file_, size) == 0,
                "the temporary file can be written");
        return path_;
    }

private:
    std::filesystem::path path_;
    int file_ = -1;
};

}  // namespace glint::fuzz
