// Reads the files of a package and refuses files outside the package's folder.
#include "package/package_state.h"

#include <xxhash.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <system_error>

namespace glint {
namespace {

constexpr std::uint32_t kSpirvMagic = 0x07230203;
constexpr std::size_t kSpirvHeaderBytes = 20;
// Returns whether a name is a relative path of plain components, so that the name does not lead out of the
// folder.
bool staysInside(const std::filesystem::path& name) {
    if (name.empty() || name.is_absolute() || name.has_root_path()) {
        return false;
    }
    return std::ranges::all_of(
        name, [](const std::filesystem::path& part) { return !part.empty() && part != ".." && part != "."; });
}

// Returns whether symbolic links keep the file inside the folder too. `file` must exist.
bool resolvesInside(const std::filesystem::path& folder, const std::filesystem::path& file) {
    std::error_code error;
    const std::filesystem::path root = std::filesystem::canonical(folder, error);
    if (error) {
        return false;
    }
    const std::filesystem::path target = std::filesystem::canonical(file, error);
    if (error) {
        return false;
    }
    return std::ranges::mismatch(root, target).in1 == root.end();
}

Result<std::vector<std::uint32_t>> readModule(const PackageFiles& files, const std::string& name,
                                              const package::ModuleEntry& entry) {
    const std::string where = files.where(name);
    GLINT_TRY(auto bytes, files.read(name, "package-module-missing", entry.bytes));
    if (bytes.size() != entry.bytes) {
        return makeError("package-module-altered", where,
                         "the module has " + std::to_string(bytes.size()) + " bytes, the package says " +
                             std::to_string(entry.bytes),
                         kRecompile);
    }
    if (XXH3_64bits(bytes.data(), bytes.size()) != entry.hash) {
        return makeError("package-module-altered", where,
                         "the module's contents differ from the package's hash", kRecompile);
    }
    std::vector<std::uint32_t> words(bytes.size() / sizeof(std::uint32_t));
    const bool holdsHeader = bytes.size() % sizeof(std::uint32_t) == 0 && bytes.size() >= kSpirvHeaderBytes;
    if (holdsHeader) {
        std::memcpy(words.data(), bytes.data(), bytes.size());
    }
    if (!holdsHeader || words[0] != kSpirvMagic) {
        return makeError("package-module-altered", where, "the module is not SPIR-V", kRecompile);
    }
    return words;
}

// Reads up to one byte more than allowed. That byte tells the caller that the file is longer, without reading
// all of it.
Result<std::vector<std::uint8_t>> readWhole(const std::filesystem::path& path, const char* missingId,
                                            std::uint64_t maxBytes) {
    const std::string where = path.string();
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) {
        return makeError(missingId, where, "there is no such file",
                         "give the folder that `glint compile` wrote, or compile the package again");
    }
    const std::uint64_t size = std::filesystem::file_size(path, error);
    std::ifstream stream(path, std::ios::binary);
    if (error || !stream) {
        return makeError("package-read", where, "the file cannot be opened", "check its permissions");
    }
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(std::min(size, maxBytes + 1)));
    stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (static_cast<std::size_t>(stream.gcount()) != bytes.size()) {
        return makeError("package-read", where, "the file cannot be read to its end", "check the disk");
    }
    return bytes;
}

}  // namespace

FolderFiles::FolderFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}

std::string FolderFiles::where(const std::string& name) const {
    return (folder_ / name).string();
}

Result<std::vector<std::uint8_t>> FolderFiles::read(const std::string& name, const char* missingId,
                                                    std::uint64_t maxBytes) const {
    if (!staysInside(name) || name.find('\\') != std::string::npos || name.find('\0') != std::string::npos) {
        return makeError("package-file-name", where(package::kTablesFile),
                         "the module file name \"" + name + "\" does not stay in the package's folder",
                         kRecompile);
    }
    Result<std::vector<std::uint8_t>> bytes = readWhole(folder_ / name, missingId, maxBytes);
    if (bytes && !resolvesInside(folder_, folder_ / name)) {
        return makeError("package-file-name", where(name),
                         "the file is a link that leaves the package's folder", kRecompile);
    }
    return bytes;
}

// If two files have the same name, the first one counts.
MemoryFiles::MemoryFiles(std::span<const package::EmbeddedFile> files) {
    for (const package::EmbeddedFile& file : files) {
        files_.emplace(file.name, file.bytes);
    }
}

std::string MemoryFiles::where(const std::string& name) const {
    return "embedded " + name;
}

Result<std::vector<std::uint8_t>> MemoryFiles::read(const std::string& name, const char* missingId,
                                                    std::uint64_t maxBytes) const {
    const auto file = files_.find(name);
    if (file == files_.end()) {
        return makeError(missingId, where(name), "there is no such file in memory",
                         "pass all files that `glint compile --embed` made");
    }
    const std::span<const std::uint8_t> bytes = file->second;
    const auto kept =
        bytes.first(static_cast<std::size_t>(std::min<std::uint64_t>(bytes.size(), maxBytes + 1)));
    return std::vector<std::uint8_t>(kept.begin(), kept.end());
}

Status readModules(Package::State& state, const PackageFiles& files) {
    for (const package::ModuleEntry& entry : state.modules) {
        const std::string name(state.strings.data() + entry.file.offset, entry.file.length);
        // Entries that share a file have the same size and hash, which checkTables() has ensured.
        if (state.spirv.contains(name)) {
            continue;
        }
        GLINT_TRY(auto words, readModule(files, name, entry));
        const XXH128_hash_t hash = XXH3_128bits(words.data(), words.size() * sizeof(std::uint32_t));
        const auto kept = state.spirv.emplace(name, std::move(words)).first;
        state.hashes[kept->second.data()] = {hash.low64, hash.high64};
    }
    return okStatus();
}

}  // namespace glint
