// Mutates one of the two chunks of a .glb file, and then makes the container fit again. A blind change would
// contradict the lengths in the container, and nothing behind them would be reached.
#include "fuzz/fuzz_target.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <span>
#include <vector>

namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint32_t kMagic = 0x46546C67;
constexpr std::uint32_t kJson = 0x4E4F534A;
constexpr std::uint32_t kBinary = 0x004E4942;
constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kChunkBytes = 8;

struct Glb {
    Bytes json;
    Bytes binary;
};

std::uint32_t readWord(std::span<const std::uint8_t> bytes, std::size_t at) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + at, sizeof word);
    return word;
}

void appendWord(Bytes& bytes, std::size_t word) {
    for (unsigned shift = 0; shift < 32; shift += 8) {
        bytes.push_back(static_cast<std::uint8_t>(word >> shift));
    }
}

std::optional<Glb> split(std::span<const std::uint8_t> bytes) {
    if (bytes.size() < kHeaderBytes || readWord(bytes, 0) != kMagic) {
        return std::nullopt;
    }
    Glb glb;
    for (auto rest = bytes.subspan(kHeaderBytes); rest.size() >= kChunkBytes;) {
        const std::uint32_t length = readWord(rest, 0);
        const std::uint32_t type = readWord(rest, 4);
        rest = rest.subspan(kChunkBytes);
        const auto payload = rest.first(std::min<std::size_t>(length, rest.size()));
        Bytes& chunk = type == kJson ? glb.json : glb.binary;
        chunk.assign(payload.begin(), payload.end());
        rest = rest.subspan(payload.size());
    }
    return glb;
}

void appendChunk(Bytes& bytes, std::uint32_t type, Bytes payload, std::uint8_t padding) {
    payload.resize((payload.size() + 3) / 4 * 4, padding);
    appendWord(bytes, payload.size());
    appendWord(bytes, type);
    bytes.insert(bytes.end(), payload.begin(), payload.end());
}

Bytes join(const Glb& glb) {
    Bytes bytes;
    for (const std::size_t word : {std::size_t{kMagic}, std::size_t{2}, std::size_t{0}}) {
        appendWord(bytes, word);
    }
    appendChunk(bytes, kJson, glb.json, ' ');
    appendChunk(bytes, kBinary, glb.binary, 0);
    const auto size = static_cast<std::uint32_t>(bytes.size());
    std::memcpy(bytes.data() + 8, &size, sizeof size);
    return bytes;
}

}  // namespace

std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t maxSize,
                                    unsigned int seed) {
    // One mutation in eight changes the container itself.
    std::optional<Glb> glb = seed % 8 == 0 ? std::nullopt : split({data, size});
    if (!glb) {
        return LLVMFuzzerMutate(data, size, maxSize);
    }
    Bytes& chunk = seed % 3 == 0 ? glb->binary : glb->json;
    const std::size_t old = chunk.size();
    constexpr std::size_t kGrowth = 64;
    chunk.resize(old + kGrowth);
    chunk.resize(LLVMFuzzerMutate(chunk.data(), old, chunk.size()));
    const Bytes joined = join(*glb);
    if (joined.size() > maxSize) {
        return LLVMFuzzerMutate(data, size, maxSize);
    }
    std::ranges::copy(joined, data);
    return joined.size();
}
