// Mutates the instructions of a SPIR-V module, because bytes that shift by one are no module any more.
#include "fuzz/fuzz_target.h"

#include <algorithm>
#include <cstring>
#include <random>
#include <vector>

namespace {

using Words = std::vector<std::uint32_t>;

constexpr std::size_t kHeaderWords = 5;
constexpr std::size_t kBoundWord = 3;
constexpr std::uint32_t kMagic = 0x07230203;

Words toWords(const std::uint8_t* data, std::size_t size) {
    Words words(size / sizeof(std::uint32_t));
    if (!words.empty()) {
        std::memcpy(words.data(), data, words.size() * sizeof(std::uint32_t));
    }
    return words;
}

// Returns where instructions begin, as far as their lengths allow, and the end as the last element.
std::vector<std::size_t> findStarts(const Words& words) {
    std::vector<std::size_t> starts;
    for (std::size_t at = kHeaderWords; at < words.size();) {
        starts.push_back(at);
        at += std::max<std::size_t>(words[at] >> 16U, 1);
    }
    starts.push_back(words.size());
    return starts;
}

using Random = std::minstd_rand;

void mutateOperand(Random& random, Words& words, std::size_t first, std::size_t end) {
    if (end - first < 2) {
        return;
    }
    std::uint32_t& operand = words[first + 1 + random() % (end - first - 1)];
    switch (random() % 4) {
        case 0:
            operand ^= 1U << random() % 32;
            break;
        case 1:
            operand = static_cast<std::uint32_t>(random() % 8);
            break;
        default:
            // The operand becomes another identifier of the module.
            operand = static_cast<std::uint32_t>(random() % std::max<std::uint32_t>(words[kBoundWord], 2));
    }
}

void mutateInstruction(Random& random, Words& words) {
    const std::vector<std::size_t> starts = findStarts(words);
    if (starts.size() < 2) {
        return;
    }
    const std::size_t chosen = random() % (starts.size() - 1);
    const std::size_t first = starts[chosen];
    const std::size_t end = std::min(starts[chosen + 1], words.size());
    const auto at = [&](std::size_t offset) { return words.begin() + static_cast<std::ptrdiff_t>(offset); };
    switch (random() % 8) {
        case 0: {
            const Words copy(at(first), at(end));
            words.insert(at(starts[random() % starts.size()]), copy.begin(), copy.end());
            break;
        }
        case 1:
            words.erase(at(first), at(end));
            break;
        case 2:
            if (chosen + 2 < starts.size()) {
                std::rotate(at(first), at(end), at(starts[chosen + 2]));
            }
            break;
        case 3:
            words[first] = (words[first] & 0xFFFF0000U) | static_cast<std::uint32_t>(random() % 512);
            break;
        default:
            mutateOperand(random, words, first, end);
    }
}

}  // namespace

std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t maxSize,
                                    unsigned int seed) {
    Random random(seed);
    Words words = toWords(data, size);
    if (seed % 8 == 0 || words.size() < kHeaderWords) {
        return LLVMFuzzerMutate(data, size, maxSize);
    }
    words[0] = kMagic;
    for (std::size_t count = 1 + random() % 4; count > 0; --count) {
        mutateInstruction(random, words);
    }
    words.resize(std::min(words.size(), maxSize / sizeof(std::uint32_t)));
    std::memcpy(data, words.data(), words.size() * sizeof(std::uint32_t));
    return words.size() * sizeof(std::uint32_t);
}
