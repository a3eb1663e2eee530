#include "cache/action.h"

#include "base/files.h"
#include "cache/store.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <link.h>
#include <string_view>
#include <system_error>

namespace glint::compiler {

namespace fs = std::filesystem;

namespace {

// Returns the build ID among the notes of a segment, or an empty text. Layout: elf(5), "Notes (Nhdr)".
std::string_view findBuildId(std::string_view notes, std::size_t alignment) {
    const auto aligned = [&](std::size_t size) { return (size + alignment - 1) / alignment * alignment; };
    while (notes.size() >= sizeof(ElfW(Nhdr))) {
        ElfW(Nhdr) header;
        std::memcpy(&header, notes.data(), sizeof header);
        const std::size_t name = sizeof header;
        const std::size_t content = aligned(name + header.n_namesz);
        const std::size_t next = aligned(content + header.n_descsz);
        if (next > notes.size()) {
            break;
        }
        if (header.n_type == NT_GNU_BUILD_ID &&
            notes.substr(name, header.n_namesz) == std::string_view("GNU\0", 4)) {
            return notes.substr(content, header.n_descsz);
        }
        notes.remove_prefix(next);
    }
    return {};
}

std::string describeFile(const char* name) {
    const fs::path path = *name == '\0' ? fs::path("/proc/self/exe") : fs::path(name);
    std::error_code error;
    const std::uintmax_t size = fs::file_size(path, error);
    const auto time = fs::last_write_time(path, error);
    return fmt::format("{} {} {}", path.string(), size, time.time_since_epoch().count());
}

int addObject(dl_phdr_info* object, std::size_t, void* result) {
    std::string_view id;
    for (int i = 0; i < object->dlpi_phnum && id.empty(); ++i) {
        const ElfW(Phdr)& segment = object->dlpi_phdr[i];
        if (segment.p_type == PT_NOTE) {
            // NOLINTNEXTLINE(performance-no-int-to-ptr): the loader gives an address as a number.
            const auto* const notes = reinterpret_cast<const char*>(object->dlpi_addr + segment.p_vaddr);
            constexpr std::size_t kUsual = 4;
            id = findBuildId({notes, segment.p_memsz}, segment.p_align == 8 ? 8 : kUsual);
        }
    }
    std::string& text = *static_cast<std::string*>(result);
    for (const char byte : id) {
        text += fmt::format("{:02x}", static_cast<unsigned char>(byte));
    }
    text += (id.empty() ? describeFile(object->dlpi_name) : std::string()) + "\n";
    return 0;
}

}  // namespace

std::string programIdentity() {
    std::string text;
    dl_iterate_phdr(addObject, &text);
    return text;
}

namespace {

bool isCurrent(const FileState& file) {
    std::error_code error;
    if (fs::file_size(file.path, error) != file.bytes || error ||
        (!file.real.empty() && realPath(file.path) != file.real)) {
        return false;
    }
    const std::optional<FileState> now = stateOf(file.path);
    return now && now->bytes == file.bytes && now->hash == file.hash;
}

void pack(Packer& packer, const std::vector<FileState>& files) {
    packer.add(files.size());
    for (const FileState& file : files) {
        packer.add(std::string_view(file.path))
            .add(file.bytes)
            .add(file.hash)
            .add(std::string_view(file.real));
    }
}

// Texts begin with their length, which is a number. An unpacked record takes several times as much memory.
constexpr std::size_t kNumberBytes = sizeof(std::uint64_t);
constexpr std::size_t kFileBytes = 4 * kNumberBytes;
constexpr std::size_t kDiagnosticBytes = 5 * kNumberBytes;

std::string textOf(Unpacker& unpacker) {
    return std::string(unpacker.text().value_or(""));
}

std::vector<FileState> unpackFiles(Unpacker& unpacker) {
    std::vector<FileState> files(unpacker.count(kFileBytes).value_or(0));
    for (FileState& file : files) {
        file.path = textOf(unpacker);
        file.bytes = unpacker.number().value_or(0);
        file.hash = unpacker.number().value_or(0);
        file.real = textOf(unpacker);
    }
    return files;
}

}  // namespace

std::optional<FileState> stateOf(const fs::path& path) {
    const Result<base::FileDigest> digest = base::digestFile(path);
    if (!digest) {
        return std::nullopt;
    }
    return FileState{path.string(), digest->bytes, digest->hash, {}};
}

std::string realPath(const fs::path& path) {
    std::error_code error;
    const fs::path real = fs::canonical(path, error);
    return error ? std::string() : real.string();
}

bool isCurrent(const ActionRecord& record) {
    const auto current = [](const FileState& file) { return isCurrent(file); };
    return std::ranges::all_of(record.inputs, current) && std::ranges::all_of(record.outputs, current);
}

std::string pack(const ActionRecord& record) {
    Packer packer;
    pack(packer, record.inputs);
    pack(packer, record.outputs);
    packer.add(record.diagnostics.size());
    for (const Diagnostic& diagnostic : record.diagnostics) {
        packer.add(static_cast<std::uint64_t>(diagnostic.severity));
        for (const std::string* const text :
             {&diagnostic.id, &diagnostic.where, &diagnostic.message, &diagnostic.hint}) {
            packer.add(std::string_view(*text));
        }
    }
    return packer.add(std::string_view(record.summary)).take();
}

std::optional<ActionRecord> unpackAction(std::string_view bytes) {
    Unpacker unpacker(bytes);
    ActionRecord record;
    record.inputs = unpackFiles(unpacker);
    record.outputs = unpackFiles(unpacker);
    record.diagnostics.resize(unpacker.count(kDiagnosticBytes).value_or(0));
    for (Diagnostic& diagnostic : record.diagnostics) {
        const std::uint64_t severity = unpacker.number().value_or(0);
        diagnostic.severity = severity == 0 ? Severity::Note : Severity::Warning;
        for (std::string* const text :
             {&diagnostic.id, &diagnostic.where, &diagnostic.message, &diagnostic.hint}) {
            *text = textOf(unpacker);
        }
    }
    record.summary = textOf(unpacker);
    return unpacker.atEnd() ? std::optional(std::move(record)) : std::nullopt;
}

}  // namespace glint::compiler
